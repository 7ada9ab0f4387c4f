// Tracking through a scene, for the unbiased integrators.
#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/march/tracking.h"

namespace brume {

/// The tentative collisions of a ray. Opens no scope: they live in the caller's.
template <int C>
TentativeCollisions<C> track(const Ray& ray, Decision flight, int bounce, int index, SampleContext& context) {
  const Scene& scene = context.scene;
  return {scene.media,   scene.majorants,         ray, scene.render.time, {context.sampler, flight, bounce, index},
          context.arena, context.statistics.march};
}

template <int C>
Spectrum<C> tracked_transmittance(const Ray& ray, Decision flight, int bounce, int index, SampleContext& context) {
  const Scene& scene = context.scene;
  return ratio_tracking<C>(scene.media, scene.majorants, ray, scene.render.time,
                           {context.sampler, flight, bounce, index}, context.arena, context.statistics.march);
}

/// An estimate of the transmittance of the camera ray up to a distance.
template <int C> Color transmittance_to(const Ray& ray, float t, SampleContext& context) {
  return to_color(tracked_transmittance<C>({ray.origin, ray.direction, {ray.span.begin, t}}, Decision::CameraFlight, 0,
                                           0, context));
}

/// For light_at_point(): transmittance towards a light by ratio tracking.
template <int C> auto shadow_by_tracking(int bounce, SampleContext& context) {
  return [bounce, &context](const Light&, const Ray& shadow, int index) {
    return to_color(tracked_transmittance<C>(shadow, Decision::ShadowFlight, bounce, index, context));
  };
}

/// Transmittance of the camera ray by one run of ratio tracking: right on average, but not its logarithm, so the
/// optical depth is that of this one run.
template <int C> void diagnose_by_tracking(const Ray& ray, SampleContext& context) {
  RayDiagnostics& out = *context.diagnostics;
  out.transmittance = transmittance_to<C>(ray, ray.span.end, context);
  for (int c = 0; c < 3; ++c) out.optical_depth[c] = -std::log(out.transmittance[c]);
}

}  // namespace brume
