// What arrives along one ray, with its uncertainty.
#pragma once

#include <array>

#include "renderer/engine/worker_pool.h"
#include "renderer/scene/scene.h"

namespace brume {

/// Mean of independent estimates and its standard error, per channel.
struct Estimate {
  std::array<double, 3> mean = {};
  std::array<double, 3> standard_error = {};
};

struct RayEstimate {
  std::uint64_t samples = 0;              ///< an even number, those that were not finite included
  std::uint64_t non_finite = 0;           ///< samples; they are left out, and so are their partners
  Estimate radiance;                      ///< W/(sr m^2)
  Estimate transmittance, optical_depth;  ///< of the ray
  double segments = 0;                    ///< mean number recorded on the ray
  RayStatistics statistics;               ///< of all samples, with scattered and shadow rays
  double wall_seconds = 0, cpu_seconds = 0;
};

/// Estimates with `samples` samples, rounded up to an even number. Where two techniques alternate (MIS with an odd
/// number of light samples) only two successive samples together are unbiased, so the mean and the error are those of
/// pairs. The same bits at any number of threads.
/// @param scene  with the independent sampler, which the standard error needs; its seed is the estimate's
/// @param ray    scene space
RayEstimate estimate_ray(const Scene& scene, const Ray& ray, std::uint64_t samples, WorkerPool& pool);

}  // namespace brume
