// From a camera ray to its radiance.
#pragma once

#include <vector>

#include "renderer/core/arena.h"
#include "renderer/march/march_record.h"
#include "renderer/sampling/sampler.h"
#include "renderer/scene/scene.h"

namespace brume {

/// What rendering has cost so far; one per thread, added up afterwards.
struct RayStatistics {
  std::uint64_t rays = 0;  ///< camera and scattered rays
  std::uint64_t shadow_rays = 0;
  std::uint64_t non_finite = 0;  ///< samples dropped because they were NaN or infinite
  MarchCounts march;

  RayStatistics& operator+=(const RayStatistics& other);
};

/// What has drawn the distance of a light sample.
enum class DistanceTechnique { Density, Equiangular, Product, Other };

/// A light sample on a camera ray.
struct LightSampleNote {
  Vec3 position;
  DistanceTechnique technique;
  float carried;  ///< luminance that it adds to the sample if nothing is in its shadow ray's way, W/(sr m^2)
};

/// What one camera ray met, for probes and the medium's diagnosis.
struct RayDiagnostics {
  Color optical_depth;  ///< of the camera ray, per channel
  Color transmittance{1};
  int segments = 0;
  std::vector<LightSampleNote> light_samples = {};
};

/// Everything that computing one sample may touch.
struct SampleContext {
  const Scene& scene;
  const Sampler& sampler;
  Arena& arena;
  RayStatistics& statistics;
  RayDiagnostics* diagnostics = nullptr;  ///< absent: nothing is written
  bool preview = false;                   ///< a picture soon matters more than a good one

  /// Of each light at a vertex of a path.
  int light_samples() const { return preview ? 1 : scene.light_samples; }

  void note(int bounce, Vec3 position, DistanceTechnique technique, Color carried) const {
    if (diagnostics && bounce == 0) diagnostics->light_samples.push_back({position, technique, luminance(carried)});
  }
};

/// An integrator has no state: the scene holds the settings. Any thread.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Radiance arriving at the ray's origin, W/(sr m^2). May be not finite: the caller drops and counts it.
  virtual Color radiance(const Ray& camera_ray, SampleContext& context) const = 0;

  /// Processor time of all threads that it took to prepare it for its scene, seconds; part of what a picture costs.
  virtual double preparation_seconds() const { return 0; }
};

}  // namespace brume
