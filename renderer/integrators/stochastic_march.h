#pragma once

#include "renderer/integrators/integrator.h"

namespace brume {

/// Marches until the transmittance falls below a random number: that is a scattering distance drawn in proportion to
/// sigma_t T, without a record of the ray. Lafortune & Willems 1996, "Rendering Participating Media with Bidirectional
/// Path Tracing"; Pauly, Kollig & Keller 2000, "Metropolis Light Transport for Participating Media". With several light
/// samples their random numbers are sorted and one march serves them all; it stops at the last one.
/// Biased by what the medium varies inside a step; exact where it is homogeneous.
class StochasticMarchIntegrator final : public Integrator {
 public:
  Color radiance(const Ray& camera_ray, SampleContext& context) const override;
};

}  // namespace brume
