// Phase function at one point of a ray: of one medium, or of several mixed by what each scatters there.
#pragma once

#include "renderer/core/spectrum.h"
#include "renderer/march/march_record.h"
#include "renderer/scene/scene.h"

namespace brume {

/// A Scatterer.
template <int C> class PhaseMixture {
 public:
  /// @param direction  of travel of the ray at the point, unit
  /// @param densities  of the media at the point; empty where the scene has only one. Must outlive the mixture.
  PhaseMixture(const Scene& scene, Vec3 direction, std::span<const float> densities)
      : scene_(scene), direction_(direction), densities_(densities) {}

  /// At a segment of a record; the densities lie in the arena.
  PhaseMixture(const Scene& scene, Vec3 direction, const MarchRecord<C>& record, int segment, Arena& arena);

  /// sum_m sigma_s,m p_m / sum_m sigma_s,m per channel, 1/sr.
  Spectrum<C> value(Vec3 wi) const;

  /// With which sample() draws a direction, per sr; value() itself for a single medium.
  float pdf_w(Vec3 wi) const;

  /// value() over pdf_w(), the weight of a sample: 1 for a single medium, whatever the direction.
  Spectrum<C> weight(Vec3 wi) const;

  /// Draws a medium by what it scatters, summed over the channels, then a direction by its phase function.
  Vec3 sample(float u_lobe, Vec2 u) const;

  float peak() const { return scene_.phase_peak; }

 private:
  /// What medium m scatters here in channel c, and in all of them.
  float share(std::size_t m, int c) const { return scene_.media[m].sigma_s[c] * densities_[m]; }
  float share(std::size_t m) const;
  bool single() const { return densities_.empty(); }

  const Scene& scene_;
  Vec3 direction_;
  std::span<const float> densities_;
};

}  // namespace brume
