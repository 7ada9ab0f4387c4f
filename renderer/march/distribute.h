// Second step of the decoupled march: from coefficients to a distribution of distances.
#pragma once

#include "renderer/march/march_record.h"

namespace brume {

/// Fills the record's second block in O(n). With T_i the transmittance up to segment i,
///   P_i = sum over channels c of weight_c * sigma_s_c,i * (integral over the segment of T_c(t) dt)
///       = sum over channels c of weight_c * sigma_s_c,i / sigma_t_c,i * T_c,i (1 - exp(-sigma_t_c,i delta_i)),
/// the light that segment i scatters towards the camera for unit in-scattering. For equal thin segments this is the
/// talk's P_i = sigma_s,i prod_{j<i} exp(-sigma_t,j delta_j) times delta; integrating over the segment makes it exact
/// for any length. Kulla 2011; Kulla & Fajardo 2012, section 4. Where the albedo is the same everywhere, P_i is
/// proportional to what the transmittance falls by, and the running sum is at once
///   CDF_i = sum over channels c of weight_c * albedo_c * (1 - T_c,i).
/// @param throughput  of the path so far: the channels are averaged by it, so that a channel that has died out, or
///   one that cannot scatter, never decides alone where the others are sampled
template <int C> void distribute(MarchRecord<C>& record, Color throughput, Arena& arena);

/// P_i of all segments, where cdf[i + 1] - cdf[i] is not precise enough: [n], the record's own or in the arena scope
/// that is open.  @param record  distributed
template <int C> const float* scattered_by_segment(const MarchRecord<C>& record, Arena& arena);

/// The part of P_i of one channel.
template <int C> float scattered_in(const MarchRecord<C>& record, int segment, int channel);

/// Radiance that the medium itself sends towards the start of the record: the sum of emission_i times the integral of
/// the transmittance over segment i.
template <int C> Color emitted_radiance(const MarchRecord<C>& record);

/// Transmittance of the whole record; 1 when it is empty.
template <int C> Spectrum<C> transmittance(const MarchRecord<C>& record);

}  // namespace brume
