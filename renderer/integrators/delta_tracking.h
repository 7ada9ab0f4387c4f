#pragma once

#include "renderer/integrators/integrator.h"

namespace brume {

/// Unbiased rejection: free flights through a fictitious medium of constant extinction, whose collisions are real with
/// the probability sigma_t / majorant. At every real collision the lights are sampled, with transmittance by ratio
/// tracking. Chromatic media are traced one channel at a time, drawn per sample: unbiased, but coloured noise.
/// Raab, Seibert & Keller 2006, "Unbiased Global Illumination with Participating Media". No bias; what it costs is
/// variance, for it knows nothing of the lights, and time, where the majorant is far above the medium.
class DeltaTrackingIntegrator final : public Integrator {
 public:
  Color radiance(const Ray& camera_ray, SampleContext& context) const override;
};

}  // namespace brume
