// Time of the three steps of the march on one ray of the smoke that ships; "per_step" is that of one step.
#include <benchmark/benchmark.h>

#include "renderer/integrators/registry.h"
#include "renderer/march/density_sampling.h"
#include "renderer/march/distribute.h"
#include "renderer/march/product_sampling.h"
#include "renderer/march/shadow_march.h"
#include "renderer/phase/henyey_greenstein.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

/// The smoke, and a ray through the middle of its box with as many steps as asked for.
struct Setup {
  SceneCache cache;
  std::shared_ptr<const Scene> scene;
  Arena arena;
  MarchCounts counts;
  Ray ray;
  MarchSettings settings{1, 0.5f, 0};

  explicit Setup(const benchmark::State& state) {
    scene = *commit(shipped_scene("smoke"), cache, {});
    const Vec3d middle = scene->bounds.center(), size = scene->bounds.high - scene->bounds.low;
    ray = {Vec3(middle - Vec3d(0.5 * size.x, 0, 0)), {1, 0, 0}, {0, static_cast<float>(size.x)}};
    settings.step = static_cast<float>(size.x) / static_cast<float>(state.range(0));
  }
  MarchRecord<1> recorded() { return record<1>(scene->media, {}, ray, settings, arena, counts); }
  MarchRecord<1> distributed() {
    MarchRecord<1> rec = recorded();
    distribute(rec, Color(1), arena);
    return rec;
  }
};

void count(benchmark::State& state, const char* name, double each) {
  using benchmark::Counter;
  state.counters[name] = Counter(static_cast<double>(state.iterations()) * each, Counter::kIsRate | Counter::kInvert);
}

void Record(benchmark::State& state) {
  Setup s(state);
  int n = 0;
  for (auto _ : state) {
    const ArenaScope scope(s.arena);
    MarchRecord<1> rec = s.recorded();
    n = rec.n;
    benchmark::DoNotOptimize(rec);
  }
  count(state, "per_step", n);
}
BENCHMARK(Record)->ArgName("steps")->Arg(32)->Arg(128)->Arg(1024);

void Distribute(benchmark::State& state) {
  Setup s(state);
  const ArenaScope outside(s.arena);
  MarchRecord<1> rec = s.recorded();
  for (auto _ : state) {
    const ArenaScope scope(s.arena);
    distribute(rec, Color(1), s.arena);
    benchmark::DoNotOptimize(rec);
  }
  count(state, "per_step", rec.n);
}
BENCHMARK(Distribute)->ArgName("steps")->Arg(32)->Arg(128)->Arg(1024);

/// Kulla's claim: a distance costs O(log n).
void SampleDistance(benchmark::State& state) {
  Setup s(state);
  const ArenaScope scope(s.arena);
  const MarchRecord<1> rec = s.distributed();
  const DensitySampling<1> density(rec, PlaceInSegment::LookedUp);
  float u = 0.5f;
  for (auto _ : state) {
    u = u > 0.38f ? u - 0.381966f : u + 0.618034f;
    benchmark::DoNotOptimize(density.sample(u));
  }
}
BENCHMARK(SampleDistance)->ArgName("steps")->Arg(32)->Arg(128)->Arg(1024);

void ProductOfOneLight(benchmark::State& state) {
  Setup s(state);
  const ArenaScope outside(s.arena);
  const MarchRecord<1> rec = s.distributed();
  const HenyeyGreenstein phase(0.4);
  const float* const p = scattered_by_segment(rec, s.arena);
  const LightPivot pivot{.position = s.ray.at(0.5f * s.ray.span.end) + Vec3(0, 0.5f, 0.3f)};
  for (auto _ : state) {
    const ArenaScope scope(s.arena);
    const ProductSampling<1> product(rec, p, s.ray, pivot, rec.span(), &phase, s.arena);
    benchmark::DoNotOptimize(product.total());
  }
  count(state, "per_step", rec.n);
}
BENCHMARK(ProductOfOneLight)->ArgName("steps")->Arg(32)->Arg(128)->Arg(1024);

/// Sixteen shadow rays together.
void ShadowMarch(benchmark::State& state) {
  Setup s(state);
  constexpr int kRays = 16;
  ShadowRays rays(kRays, s.arena);
  for (int i = 0; i < kRays; ++i) {
    Ray ray = s.ray;
    ray.origin.z += 0.01f * static_cast<float>(i);
    rays.add(ray, static_cast<float>(i) / kRays);
  }
  Spectrum<1> transmittance[kRays];
  for (auto _ : state) {
    shadow_transmittances<1>(s.scene->media, rays, s.settings.step, 0, s.arena, s.counts, transmittance);
    benchmark::DoNotOptimize(transmittance);
  }
  count(state, "per_step", static_cast<double>(kRays * state.range(0)));
}
BENCHMARK(ShadowMarch)->ArgName("steps")->Arg(16)->Arg(64)->Arg(256);

}  // namespace
}  // namespace brume
