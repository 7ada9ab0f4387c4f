// Tracking through a scene, for the unbiased integrators.
#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/march/tracking.h"
#include "renderer/sampling/light_numbers.h"

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

/// Adds up light samples, each times the transmittance of its shadow ray by ratio tracking.
template <int C> class TrackedShadows {
 public:
  TrackedShadows(int bounce, SampleContext& context) : bounce_(bounce), context_(context) {}

  void add(const Light&, const Ray& shadow, Color carried, const ShadowNumbers& numbers) {
    ++context_.statistics.shadow_rays;
    sum_ +=
        carried * to_color(tracked_transmittance<C>(shadow, Decision::ShadowFlight, bounce_, numbers.index, context_));
  }

  Color light() const { return sum_; }

 private:
  int bounce_;
  SampleContext& context_;
  Color sum_;
};

/// Transmittance of the camera ray by one run of ratio tracking: right on average, but not its logarithm, so the
/// optical depth is that of this one run.
template <int C> void diagnose_by_tracking(const Ray& ray, SampleContext& context) {
  RayDiagnostics& out = *context.diagnostics;
  out.transmittance = transmittance_to<C>(ray, ray.span.end, context);
  for (int c = 0; c < 3; ++c) out.optical_depth[c] = -std::log(out.transmittance[c]);
}

}  // namespace brume
