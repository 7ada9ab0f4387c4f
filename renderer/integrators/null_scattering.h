#pragma once

#include "renderer/integrators/integrator.h"

namespace brume {

/// The unbiased reference. Collisions with the fictitious part of the medium are vertices of the path like the real
/// ones, so the pdf of every technique that could have made a path is known, and they combine by multiple importance
/// sampling: distances by tracking and about the lights, and the channels of chromatic media, of which one leads.
/// Miller, Georgiev & Jarosz 2019, "A null-scattering path integral formulation of light transport"; equi-angular
/// sampling after Kulla & Fajardo 2012.
class NullScatteringIntegrator final : public Integrator {
 public:
  Color radiance(const Ray& camera_ray, SampleContext& context) const override;
};

}  // namespace brume
