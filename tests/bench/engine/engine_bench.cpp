// How long the user waits: from an edit to the first picture of it.
#include <benchmark/benchmark.h>

#include <thread>

#include "renderer/engine/engine.h"
#include "renderer/integrators/registry.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

std::shared_ptr<const Scene> smoke(SceneCache& cache, std::uint64_t generation, int bounces) {
  Node description = shipped_scene("smoke");
  static_cast<void>(description.child("render").set("bounces", std::int64_t{bounces}).ok());
  return *commit(description, cache, {.generation = generation});
}

/// Edit to first coarse picture while the engine works on full passes of 1280x720: giving up the pass under way, the
/// coarse pass, and handing the picture over. Goal: 33 ms (and 50 ms for giving up alone).
void edit_to_first_picture(benchmark::State& state) {
  SceneCache cache;
  std::uint64_t generation = 0;
  Engine engine;
  const auto shown = [&](int divisor) {
    const auto p = engine.picture();
    return p && p->generation == generation && p->divisor <= divisor;
  };
  const auto wait = [&](int divisor) {
    while (!shown(divisor)) std::this_thread::sleep_for(std::chrono::microseconds(100));
  };
  auto scene = smoke(cache, ++generation, static_cast<int>(state.range(0)));
  engine.submit({{scene, 1280, 720}});
  for (auto _ : state) {
    state.PauseTiming();
    wait(1);
    scene = smoke(cache, ++generation, static_cast<int>(state.range(0)));
    state.ResumeTiming();
    engine.submit({{scene, 1280, 720}});
    wait(state.range(1) == 0 ? 64 : 1);
  }
}
BENCHMARK(edit_to_first_picture)
    ->ArgNames({"bounces", "full"})
    ->Args({0, 0})
    ->Args({1, 0})
    ->Args({2, 0})
    ->Args({0, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(15);

}  // namespace
}  // namespace brume
