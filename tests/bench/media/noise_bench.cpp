// Time of the procedural cloud and its noise at every SIMD level. "per_octave" is the time of one octave at one point.
#include <benchmark/benchmark.h>

#include <array>
#include <random>
#include <string>

#include "renderer/core/simd.h"
#include "renderer/media/cloud_shader.h"

namespace brume {
namespace {

constexpr int kPoints = 128;  // as many as a ray has steps

struct Points {
  alignas(64) std::array<float, kPoints> x, y, z, out;
  PointBatch batch() const { return {x.data(), y.data(), z.data(), kPoints, 0}; }
};

/// Points of a box, in no order.
Points scattered_points(float reach) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> uniform(-reach, reach);
  Points p;
  for (std::size_t i = 0; i < kPoints; ++i) p.x[i] = uniform(rng), p.y[i] = uniform(rng), p.z[i] = uniform(rng);
  return p;
}

/// Points along a ray through the box, at height z.
Points ray_points(float z) {
  Points p;
  for (std::size_t i = 0; i < kPoints; ++i)
    p.x[i] = -1.5f + 3.0f * static_cast<float>(i) / kPoints, p.y[i] = 0.2f * p.x[i], p.z[i] = z;
  return p;
}

/// Argument 0 of every benchmark: an index into simd_levels().
void use_level(benchmark::State& state) {
  const std::string level = simd_levels()[static_cast<std::size_t>(state.range(0))];
  if (!force_simd_level(level).ok()) state.SkipWithError("level not supported");
  state.SetLabel(level);
}

void count(benchmark::State& state, const char* name, int evaluations) {
  using benchmark::Counter;
  const double total = static_cast<double>(state.iterations()) * evaluations;
  state.counters[name] = Counter(total, Counter::kIsRate | Counter::kInvert);
  static_cast<void>(force_simd_level("auto"));
}

void each_level(benchmark::internal::Benchmark* bench, std::initializer_list<int> second) {
  for (int level = 0; level < static_cast<int>(simd_levels().size()); ++level)
    for (const int argument : second) bench->Args({level, argument});
}

/// Argument 1: octaves.
void FbmNoise_128Points(benchmark::State& state) {
  use_level(state);
  const int octaves = static_cast<int>(state.range(1));
  Points points = scattered_points(20);
  const FbmNoise noise({}, {.octaves = octaves, .seed = 1});
  for (auto _ : state) {
    noise.evaluate(points.batch(), points.out.data());
    benchmark::ClobberMemory();
  }
  count(state, "per_octave", kPoints * octaves);
}
BENCHMARK(FbmNoise_128Points)->Apply([](auto* b) { each_level(b, {1, 6}); });

/// Argument 1: height of the ray in hundredths; 10 is through the middle, 55 grazes the top, 70 misses.
void Cloud_128Steps(benchmark::State& state) {
  use_level(state);
  Points points = ray_points(static_cast<float>(state.range(1)) / 100);
  const CloudShader cloud({}, {});
  for (auto _ : state) {
    cloud.density(points.batch(), points.out.data());
    benchmark::ClobberMemory();
  }
  count(state, "per_step", kPoints);
}
BENCHMARK(Cloud_128Steps)->Apply([](auto* b) { each_level(b, {10, 55, 70}); });

void FbmNoise_Make6Octaves(benchmark::State& state) {
  for (auto _ : state) {
    FbmNoise noise({}, {.seed = 1});
    benchmark::DoNotOptimize(noise);
  }
}
BENCHMARK(FbmNoise_Make6Octaves);

}  // namespace
}  // namespace brume
