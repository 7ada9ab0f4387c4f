#pragma once

#include "renderer/integrators/integrator.h"

namespace brume {

/// Decoupled ray-marching: record the medium along the ray once, distribute, estimate.
/// Kulla 2011, "Decoupled Ray-marching of Heterogeneous Participating Media"; Kulla & Fajardo 2012.
/// Bias: the quadrature of the march, which vanishes where segments are homogeneous and with the step size.
class DecoupledIntegrator final : public Integrator {
 public:
  Color radiance(const Ray& camera_ray, SampleContext& context) const override;
};

}  // namespace brume
