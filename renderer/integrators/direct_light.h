// Third step of the decoupled march: light samples on the record.
#pragma once

#include "renderer/integrators/integrator.h"

namespace brume {

/// Radiance scattered once along the recorded ray from the scene's lights towards its origin, for the throughput
/// `beta` at its start. Every light sample is one shadow ray: a point of the light is drawn first, then a distance by
/// density sampling, by equi-angular sampling about that very point, or by one of each weighted by MIS.
/// @param record  distributed, with scattered() > 0.  @param bounce  scattered rays so far
template <int C>
Color direct_light(const MarchRecord<C>& record, const Ray& ray, Color beta, int bounce, SampleContext& context);

/// Phase function at one point of a ray: of one medium, or of several mixed by what each scatters there.
template <int C> class PhaseMixture {
 public:
  PhaseMixture(const Scene& scene, const MarchRecord<C>& record, int segment)
      : scene_(scene), record_(record), segment_(segment) {}

  /// sum_m sigma_s,m p_m / sum_m sigma_s,m per channel, 1/sr.
  Spectrum<C> value(float cos_theta) const;

  struct Sample {
    Vec3 direction;
    Spectrum<C> weight;  ///< value / pdf; 1 for a single medium
  };
  /// Draws a medium by what it scatters, then a direction by its phase function; the pdf is that of the mixture.
  Sample sample(Vec3 direction, float u_lobe, Vec2 u) const;

 private:
  /// What medium m scatters here in channel c.
  float share(std::size_t m, int c) const;
  bool single() const { return record_.medium_density == nullptr; }

  const Scene& scene_;
  const MarchRecord<C>& record_;
  int segment_;
};

}  // namespace brume
