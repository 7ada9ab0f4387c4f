#include "renderer/march/distribute.h"

#include <algorithm>
#include <cmath>

namespace brume {

template <int C> void distribute(MarchRecord<C>& rec, Color throughput, Arena& arena) {
  rec.weight = channel_weights<C>(throughput);
  float* const cdf = alloc_edges(rec.n, arena);
  rec.cdf = cdf;
  for (std::size_t c = 0; c < C; ++c) {
    float* const tau = alloc_edges(rec.n, arena);
    float* const transmittance = alloc_edges(rec.n, arena);
    rec.tau[c] = tau, rec.transmittance[c] = transmittance;
    const float sigma_t = rec.sigma_t[c].scale, sigma_s = rec.sigma_s[c].scale;
    const float scatters = sigma_t > 0 ? rec.weight.v[c] * sigma_s / sigma_t : 0;
    if (!rec.has_one_albedo())
      attenuate(rec.segments(), rec.sigma_t[c], tau, transmittance);
    else if (c == 0)
      attenuate(rec.segments(), rec.sigma_t[c], scatters, tau, transmittance, cdf);
    else
      attenuate_and_add(rec.segments(), rec.sigma_t[c], scatters, tau, transmittance, cdf);
  }
  if (rec.has_one_albedo()) return;
  rec.p = scattered_by_segment(rec, arena);
  running_sum(rec.p, rec.n, cdf);
}

template <int C> const float* scattered_by_segment(const MarchRecord<C>& rec, Arena& arena) {
  if (rec.p) return rec.p;
  const auto n = static_cast<std::size_t>(rec.n);
  float* const p = arena.alloc_span<float>(n).data();
  std::fill_n(p, n, 0.0f);
  for (std::size_t c = 0; c < C; ++c)
    add_transmitted(rec.segments(), rec.sigma_t[c], rec.transmittance[c], rec.sigma_s[c], rec.weight.v[c], p);
  return p;
}

template <int C> float scattered_in(const MarchRecord<C>& rec, int segment, int channel) {
  const auto c = static_cast<std::size_t>(channel);
  const float x = rec.sigma_t[c][segment] * rec.segment(segment).length();
  const float mean = x > 0 ? -std::expm1(-x) / x : 1;  // of the transmittance, to the one at the begin
  return rec.weight[channel] * rec.sigma_s[c][segment] * rec.segment(segment).length() * rec.transmittance[c][segment] *
         mean;
}

template <int C> Color emitted_radiance(const MarchRecord<C>& rec) {
  Color sum;
  if (!rec.emission) return sum;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(C == 1 ? 0 : c);
    sum[c] = sum_transmitted(rec.segments(), rec.sigma_t[channel], rec.transmittance[channel], rec.emission[c]);
  }
  return sum;
}

template <int C> Spectrum<C> transmittance(const MarchRecord<C>& rec) {
  Spectrum<C> result;
  for (int c = 0; c < C; ++c) result[c] = rec.empty() ? 1.0f : rec.transmittance[static_cast<std::size_t>(c)][rec.n];
  return result;
}

template void distribute<1>(MarchRecord<1>&, Color, Arena&);
template void distribute<3>(MarchRecord<3>&, Color, Arena&);
template const float* scattered_by_segment<1>(const MarchRecord<1>&, Arena&);
template const float* scattered_by_segment<3>(const MarchRecord<3>&, Arena&);
template float scattered_in<1>(const MarchRecord<1>&, int, int);
template float scattered_in<3>(const MarchRecord<3>&, int, int);
template Color emitted_radiance<1>(const MarchRecord<1>&);
template Color emitted_radiance<3>(const MarchRecord<3>&);
template Spectrum<1> transmittance<1>(const MarchRecord<1>&);
template Spectrum<3> transmittance<3>(const MarchRecord<3>&);

}  // namespace brume
