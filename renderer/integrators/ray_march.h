#pragma once

#include "renderer/integrators/deep_shadow_map.h"
#include "renderer/integrators/integrator.h"

namespace brume {

/// Traditional ray-marching: the lights are sampled at every step, each with a shadow march of its own, so n steps cost
/// O(n^2) look-ups. Perlin & Hoffert 1989, "Hypertexture".
/// Steps are placed with one random offset per ray, which makes single scattering unbiased where the medium is
/// homogeneous; elsewhere it is biased by what the medium varies inside a step, as decoupled marching is. Further
/// orders are no part of the method: asked for bounces, a path goes on from one step that is drawn by what the steps
/// scatter, which is Brume's own addition.
class RayMarchIntegrator : public Integrator {
 public:
  Color radiance(const Ray& camera_ray, SampleContext& context) const override;

 protected:
  /// Of a light whose transmittance is cached; null for one whose shadow rays are marched.
  virtual const DeepShadowMap* shadow_map(const Scene&, const Light&) const { return nullptr; }

 private:
  template <int C> class Shadows;
  template <int C> Color trace(Ray ray, SampleContext& context) const;
};

}  // namespace brume
