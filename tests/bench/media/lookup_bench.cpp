// ns and cycles per trilinear sample along 128-step rays through the smoke grid; compare with march_limit.md,
// section 1.
#include <benchmark/benchmark.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <random>
#include <vector>

#include "renderer/core/simd.h"
#include "renderer/experiments/limit_kernels.h"
#include "renderer/media/brick_lookup.h"
#include "renderer/media/vdb_file.h"

namespace brume {
namespace {

constexpr int kSteps = 128;

/// Positions origin + k * step, k in [0, kSteps), in index space.
struct Steps {
  Vec3 origin, step;
};

struct Scene {
  openvdb::FloatGrid::Ptr open;
  nanovdb::GridHandle<nanovdb::HostBuffer> nano;
  std::vector<std::pair<std::string, std::shared_ptr<const BrickGrid>>> bricks;  // of every layout, by name
  std::vector<Steps> camera;      // 16x16 pixel tiles of a view of the whole box
  std::vector<Steps> incoherent;  // random directions from random places in the box
  std::vector<Steps> empty;       // through the table, but only through empty bricks
};

const Scene& scene() {
  static const Scene the_scene = [] {
    const std::string path = std::string(BRUME_SOURCE_DIR) + "/scenes/vdb/smoke_plume_96_f050.vdb";
    Scene s;
    openvdb::initialize();
    openvdb::io::File file(path);
    file.open(false);
    s.open = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
    s.nano = nanovdb::openToNanoVDB(*s.open);
    for (const bool full : {true, false}) {
      const auto grid = load_grid(path, "density", {.full_precision = full}).value().grid;
      s.bricks.emplace_back(to_string(grid->values().layout()), grid);
    }

    const Bounds3 box = s.bricks.front().second->support();
    const Vec3 low(box.low), high(box.high), centre = (low + high) * 0.5f;
    const Vec3 eye = centre + normalize(Vec3(1, 0.7f, 0.35f)) * static_cast<float>(1.6 * box.diagonal());
    const Vec3 forward = normalize(centre - eye), right = normalize(cross(forward, Vec3(0, 0, 1))),
               up = cross(right, forward);
    for (int tile_y = 0; tile_y < 1024; tile_y += 48)
      for (int tile_x = 0; tile_x < 1024; tile_x += 48)
        for (int p = 0; p < 256; p += 2) {
          const float px = static_cast<float>(tile_x + p % 16) / 512 - 1,
                      py = static_cast<float>(tile_y + p / 16) / 512 - 1;
          const Vec3 way = normalize(forward + right * (px * 0.45f) + up * (py * 0.45f));
          float from = 0, to = std::numeric_limits<float>::infinity();
          for (int axis = 0; axis < 3; ++axis) {
            const float a = (low[axis] - eye[axis]) / way[axis], b = (high[axis] - eye[axis]) / way[axis];
            from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
          }
          const float step = (to - from) / kSteps;
          if (from < to) s.camera.push_back({eye + way * (from + 0.5f * step), way * step});
        }
    std::mt19937 rng(1);
    std::uniform_real_distribution<float> u(0, 1);
    for (int i = 0; i < 8192; ++i) {
      const Vec3 at = low + Vec3(u(rng) * (high.x - low.x), u(rng) * (high.y - low.y), u(rng) * (high.z - low.z));
      s.incoherent.push_back({at, normalize(Vec3(u(rng) - 0.5f, u(rng) - 0.5f, u(rng) - 0.5f)) * 0.5f});
    }
    for (int i = 0; i < 256; ++i)
      s.empty.push_back({high - Vec3(2 + u(rng), 2 + u(rng), 1 + u(rng)), {-0.001f, -0.001f, -0.001f}});
    return s;
  }();
  return the_scene;
}

/// Calls look_up(steps) -> a value to keep, for each ray; reports per sample. Computing the positions is included.
template <class F> void run(benchmark::State& state, const std::vector<Steps>& rays, const F& look_up) {
  // The fastest pass counts: other processes only ever add time.
  double best_ns = std::numeric_limits<double>::infinity(), best_cycles = best_ns;
  for (auto pass : state) {
    (void)pass;
    const double clock_before = cycles_per_nanosecond();
    const auto start = std::chrono::steady_clock::now();
    for (const Steps& ray : rays) benchmark::DoNotOptimize(look_up(ray));
    const double ns = std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() /
                      (static_cast<double>(rays.size()) * kSteps);
    best_ns = std::min(best_ns, ns);
    best_cycles = std::min(best_cycles, ns * std::max(clock_before, cycles_per_nanosecond()));
  }
  state.counters["ns/sample"] = best_ns;
  state.counters["cycles/sample"] = best_cycles;
}

void bricks(benchmark::State& state, const BrickGrid& grid, const std::string& level, const std::vector<Steps>& rays) {
  if (!force_simd_level(level).ok()) return state.SkipWithError("level not supported");
  alignas(64) float x[kSteps], y[kSteps], z[kSteps], density[kSteps];
  run(state, rays, [&](const Steps& ray) {
    for (int k = 0; k < kSteps; ++k) {
      const auto t = static_cast<float>(k);
      x[k] = ray.origin.x + t * ray.step.x, y[k] = ray.origin.y + t * ray.step.y, z[k] = ray.origin.z + t * ray.step.z;
    }
    lookup_trilinear(grid, Affine{}, {x, y, z, kSteps, 0}, 1, density);
    benchmark::ClobberMemory();
    return density[kSteps / 2];
  });
  (void)force_simd_level("auto");
}

void open_vdb(benchmark::State& state, const std::vector<Steps>& rays) {
  const auto accessor = scene().open->getConstAccessor();
  run(state, rays, [&](const Steps& ray) {
    float sum = 0;
    for (int k = 0; k < kSteps; ++k) {
      const Vec3 p = ray.origin + ray.step * static_cast<float>(k);
      sum += openvdb::tools::BoxSampler::sample(accessor, openvdb::Vec3R(p.x, p.y, p.z));
    }
    return sum;
  });
}

void nano_vdb(benchmark::State& state, const std::vector<Steps>& rays) {
  const auto accessor = scene().nano.grid<float>()->getAccessor();
  const auto sampler = nanovdb::createSampler<1>(accessor);
  run(state, rays, [&](const Steps& ray) {
    float sum = 0;
    for (int k = 0; k < kSteps; ++k) {
      const Vec3 p = ray.origin + ray.step * static_cast<float>(k);
      sum += sampler(nanovdb::Vec3f(p.x, p.y, p.z));
    }
    return sum;
  });
}

void load_smoke(benchmark::State& state) {
  const std::string path = std::string(BRUME_SOURCE_DIR) + "/scenes/vdb/smoke_plume_96_f050.vdb";
  for (auto pass : state) {
    (void)pass;
    benchmark::DoNotOptimize(load_grid(path, "density"));
  }
  state.SetLabel("file to bricks");
}

const bool registered = [] {
  using Rays = std::vector<Steps> Scene::*;
  const std::pair<const char*, Rays> sets[] = {
      {"camera", &Scene::camera}, {"incoherent", &Scene::incoherent}, {"empty", &Scene::empty}};
  for (const auto& [name, rays] : sets) {
    const Rays set = rays;
    const std::string suffix = std::string("/") + name;
    for (std::size_t layout = 0; layout < scene().bricks.size(); ++layout)
      for (const std::string& level : simd_levels())
        benchmark::RegisterBenchmark(
            ("Lookup/" + scene().bricks[layout].first + "_" + level + suffix).c_str(),
            [=](benchmark::State& s) { bricks(s, *scene().bricks[layout].second, level, scene().*set); });
    benchmark::RegisterBenchmark(("Lookup/nanovdb" + suffix).c_str(),
                                 [set](benchmark::State& s) { nano_vdb(s, scene().*set); });
    benchmark::RegisterBenchmark(("Lookup/openvdb" + suffix).c_str(),
                                 [set](benchmark::State& s) { open_vdb(s, scene().*set); });
  }
  benchmark::RegisterBenchmark("LoadGrid/smoke", load_smoke)->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
}  // namespace brume
