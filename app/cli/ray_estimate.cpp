#include "app/cli/ray_estimate.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "renderer/core/check.h"
#include "renderer/integrators/registry.h"

namespace brume {
namespace {

/// Running mean and sum of squared deviations of colours. Welford 1962, "Note on a Method for Calculating Corrected
/// Sums of Squares and Products"; merged as in Chan, Golub & LeVeque 1979, "Updating Formulae and a Pairwise Algorithm
/// for Computing Sample Variances", eq. 2.1.
struct Moments {
  double count = 0;
  std::array<double, 3> mean = {}, m2 = {};

  void add(const std::array<double, 3>& value) {
    Moments one;
    one.count = 1;
    one.mean = value;
    merge(one);
  }

  void merge(const Moments& other) {
    if (other.count == 0) return;
    const double total = count + other.count;
    for (std::size_t c = 0; c < 3; ++c) {
      const double delta = other.mean[c] - mean[c];
      m2[c] += other.m2[c] + delta * delta * count * other.count / total;
      mean[c] += delta * other.count / total;
    }
    count = total;
  }

  Estimate estimate() const {
    Estimate e;
    e.mean = mean;
    if (count > 1)
      for (std::size_t c = 0; c < 3; ++c) e.standard_error[c] = std::sqrt(m2[c] / (count * (count - 1)));
    return e;
  }
};

std::array<double, 3> mean_of(Color a, Color b) {
  return {0.5 * (double{a.r} + double{b.r}), 0.5 * (double{a.g} + double{b.g}), 0.5 * (double{a.b} + double{b.b})};
}

/// What a run of pairs found.
struct Part {
  Moments radiance, transmittance, optical_depth;
  std::uint64_t non_finite = 0, segments = 0;

  void merge(const Part& other) {
    radiance.merge(other.radiance);
    transmittance.merge(other.transmittance);
    optical_depth.merge(other.optical_depth);
    non_finite += other.non_finite;
    segments += other.segments;
  }
};

void add_pair(const Scene& scene, const Integrator& integrator, const Ray& ray, std::uint32_t pair, Worker& worker,
              Part& part) {
  Color radiance[2];
  RayDiagnostics met[2];
  for (std::uint32_t k = 0; k < 2; ++k) {
    // Each pair has a pixel of its own: so the technique that comes first is random over the pairs.
    const Sampler sampler(scene.render.sampler, scene.render.seed, pair, k);
    SampleContext context{scene, sampler, worker.arena, worker.statistics, &met[k]};
    radiance[k] = integrator.radiance(ray, context);
    if (!is_finite(radiance[k])) ++part.non_finite;
    part.segments += static_cast<std::uint64_t>(met[k].segments);
  }
  if (is_finite(radiance[0]) && is_finite(radiance[1])) part.radiance.add(mean_of(radiance[0], radiance[1]));
  part.transmittance.add(mean_of(met[0].transmittance, met[1].transmittance));
  part.optical_depth.add(mean_of(met[0].optical_depth, met[1].optical_depth));
}

}  // namespace

RayEstimate estimate_ray(const Scene& scene, const Ray& ray, std::uint64_t samples, WorkerPool& pool) {
  BRUME_CHECK(scene.render.sampler == SamplerKind::Independent, ==, true);
  const auto start = std::chrono::steady_clock::now();
  const auto integrator = make_integrator(scene);

  // The parts depend on the number of samples alone, and are merged in order.
  constexpr std::uint64_t kMostParts = 4096, kLeastPairs = 128;
  const std::uint64_t pairs = (samples + 1) / 2;
  const std::uint64_t per_part = std::max(kLeastPairs, (pairs + kMostParts - 1) / kMostParts);
  std::vector<Part> parts((pairs + per_part - 1) / per_part);
  static_cast<void>(pool.take_totals());
  pool.run(static_cast<int>(parts.size()), [&](int p, Worker& worker) {
    const std::uint64_t first = static_cast<std::uint64_t>(p) * per_part, end = std::min(pairs, first + per_part);
    for (std::uint64_t pair = first; pair < end; ++pair)
      add_pair(scene, *integrator, ray, static_cast<std::uint32_t>(pair), worker, parts[static_cast<std::size_t>(p)]);
  });

  Part all;
  for (const Part& part : parts) all.merge(part);
  const WorkerPool::Totals totals = pool.take_totals();
  RayEstimate out;
  out.samples = 2 * pairs;
  out.non_finite = all.non_finite;
  out.radiance = all.radiance.estimate();
  out.transmittance = all.transmittance.estimate();
  out.optical_depth = all.optical_depth.estimate();
  out.segments = static_cast<double>(all.segments) / static_cast<double>(out.samples);
  out.statistics = totals.statistics;
  out.cpu_seconds = totals.cpu_seconds;
  out.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace brume
