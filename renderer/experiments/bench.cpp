#include "renderer/experiments/bench.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

#include "renderer/core/simd.h"
#include "renderer/engine/engine.h"
#include "renderer/experiments/limit_kernels.h"
#include "renderer/experiments/thread_model.h"
#include "renderer/integrators/registry.h"
#include "renderer/march/distribute.h"
#include "renderer/march/step_loops.h"
#include "renderer/media/brick_lookup.h"
#include "renderer/media/fbm_noise.h"
#include "renderer/media/vdb_file.h"
#include "renderer/scene_io/scene_file.h"

namespace brume {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Least time of a call, in nanoseconds, over a fifth of a second.
template <class F> double least_nanoseconds(const F& f) {
  double least = std::numeric_limits<double>::infinity();
  const auto begin = Clock::now();
  for (int round = 0; round < 3 || seconds_since(begin) < 0.2; ++round) {
    const auto start = Clock::now();
    f();
    least = std::min(least, 1e9 * seconds_since(start));
  }
  return least;
}

constexpr int kSteps = 128;  // of a ray, as in the notes' measurements

/// Rays through a grid's bounding box, in index space: kSteps points each, all inside its table.
struct Row {
  Vec3 first, step;
};
std::vector<Row> rows_through(const BrickGrid& grid) {
  std::vector<Row> rows;
  const Bounds3 box = grid.support();
  const Vec3d margin(0.01), low = box.low + margin, high = box.high - margin, size = high - low;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      const double u = (x + 0.5) / 48, v = (y + 0.5) / 48;
      const Vec3d from = low + Vec3d(u * size.x, 0, v * size.z), to = low + Vec3d((1 - u) * size.x, size.y, v * size.z);
      const Vec3d step = (to - from) / double(kSteps);
      rows.push_back({Vec3(from + step * 0.5), Vec3(step)});
    }
  return rows;
}

class Bench {
 public:
  explicit Bench(const BenchOptions& options) : options_(options) {}

  Result<std::vector<BenchResult>> run() {
    auto description = read_scene_file(options_.scenes + "/smoke.json", scene_family());
    if (!description) return description.error();
    for (const auto& [key, value] : {std::pair("bounces", "0"), {"distance_sampling", "mis"}, {"light_samples", "2"}})
      if (auto set = set_by_path(*description, std::string("render.") + key, value); !set) return set.error();
    auto smoke = commit(*description, cache_, {});
    if (!smoke) return smoke.error();
    const auto grid = load_grid(description->list("volumes")[0].text("file"), "density", {.full_precision = false});
    if (!grid) return grid.error();

    measure_lookup(*grid->grid);
    measure_distribute();
    measure_noise();
    if (auto done = measure_camera_ray(*description); !done) return done.error();
    for (const char* name : {"smoke", "fire", "cloud", "fog", "surfaces"})
      if (auto done = measure_scene(name); !done) return done.error();
    if (auto done = measure_waiting(); !done) return done.error();
    if (wanted("smoke, 64 threads")) model_threads(**smoke);
    return std::move(results_);
  }

 private:
  bool wanted(const std::string& name) const {
    if (name.find(options_.only) == std::string::npos) return false;
    if (options_.progress) options_.progress(name);
    return true;
  }

  void measure_lookup(const BrickGrid& grid) {
    const std::vector<Row> rows = rows_through(grid);
    const double samples = static_cast<double>(rows.size()) * kSteps;
    alignas(64) float t[kSteps], x[kSteps], y[kSteps], z[kSteps], density[kSteps];
    const auto limit = [&] {
      for (const Row& row : rows) limit_lookup(grid, row.first, row.step, kSteps, density);
    };
    lookup_limit_ = least_nanoseconds(limit) / samples;
    if (!wanted("density look-up")) return;
    const double ours = least_nanoseconds([&] {
                          for (const Row& row : rows) {
                            write_steps({row.first, row.step}, {0, kSteps, 1, 0, kSteps}, t, x, y, z);
                            lookup_trilinear(grid, Affine{}, {x, y, z, kSteps, 0}, 1, density);
                          }
                        }) /
                        samples;
    results_.push_back({"density look-up", ours, "ns per sample", lookup_limit_, 1.3});
    report_cycles("density look-up, limit kernel", limit, samples, limit_cycles(simd_level()).lookup);
  }

  /// The whole of both steps but for the look-ups, on a medium that needs none. A fourfold ray tells apart what a ray
  /// costs and what a step costs.
  void measure_distribute() {
    constexpr int kLong = 4 * kSteps;
    constexpr float kDelta = 0.02f;
    alignas(64) float density[kLong], transmittance[kSteps + kWidestVector], cdf[kSteps + kWidestVector];
    for (int i = 0; i < kLong; ++i) density[i] = 0.5f + 0.4f * std::sin(static_cast<float>(i));
    constexpr int kRepeats = 200;
    const auto limit = [&] {
      for (int r = 0; r < kRepeats; ++r) {
        limit_distribute(density, kSteps, 2.0f, 1.8f, kDelta, transmittance, cdf);
        asm volatile("" : : "r"(cdf) : "memory");
      }
    };
    distribute_limit_ = least_nanoseconds(limit) / (kRepeats * kSteps);
    if (!wanted("record and distribute")) return;
    class Waves final : public Shader {
     public:
      explicit Waves(const float* values) : values_(values) {}
      ShaderTraits traits() const override { return {}; }
      void density(const PointBatch& points, float* out) const override { std::copy_n(values_, points.n, out); }
      float max_density(const Bounds3&) const override { return 1; }

     private:
      const float* values_;
    };
    Arena arena;
    MarchCounts counts;
    const auto ray_of = [&](int steps) {
      std::vector<Medium> media(1);
      media[0].shader = std::make_shared<Waves>(density);
      media[0].shape = std::make_shared<BoxShape>(Vec3d(-1, -1, 0), Vec3d(1, 1, static_cast<double>(kDelta) * steps));
      media[0].sigma_s = Color(1.8f), media[0].sigma_t = Color(2);
      return least_nanoseconds([&] {
               for (int r = 0; r < kRepeats; ++r) {
                 const ArenaScope scope(arena);
                 MarchRecord<1> rec = record<1>(media, {}, {{0, 0, -1}, {0, 0, 1}}, {kDelta, 0.5f, 0}, arena, counts);
                 distribute(rec, Color(1), arena);
                 asm volatile("" : : "r"(rec.cdf) : "memory");
               }
             }) /
             kRepeats;
    };
    const double ray = ray_of(kSteps), long_ray = ray_of(kLong), step = (long_ray - ray) / (kLong - kSteps);
    results_.push_back({"record and distribute", ray / kSteps, "ns per step", distribute_limit_, 1.3});
    results_.push_back({"record and distribute, each further step", step, "ns", distribute_limit_, 1.3});
    results_.push_back({"record and distribute, each ray", ray - step * kSteps, "ns"});
    report_cycles("record and distribute, limit kernel", limit, kRepeats * kSteps,
                  limit_cycles(simd_level()).distribute);
  }

  void measure_noise() {
    if (!wanted("fBm noise")) return;
    constexpr int kOctaves = 6;
    const FbmNoise noise({}, {.octaves = kOctaves, .seed = 1});
    alignas(64) float t[kSteps], x[kSteps], y[kSteps], z[kSteps], out[kSteps];
    write_steps({{0.1f, 0.2f, 0.3f}, {0.13f, 0.21f, 0.05f}}, {0, kSteps, 1, 0, kSteps}, t, x, y, z);
    constexpr int kRepeats = 100;
    const double ours = least_nanoseconds([&] {
                          for (int r = 0; r < kRepeats; ++r) noise.evaluate({x, y, z, kSteps, 0}, out);
                        }) /
                        (kRepeats * kSteps * kOctaves);
    BenchResult result{"fBm noise", ours, "ns per octave"};
    if (const double cycles = limit_cycles(simd_level()).noise_octave; cycles > 0)
      result.limit = cycles / cycles_per_nanosecond(), result.goal = 1.5;
    results_.push_back(result);
  }

  /// A limit kernel must be as fast as the notes say, or what it says of this machine means little. The clock, which
  /// changes all the time, is read beside every measurement.
  template <class F> void report_cycles(const std::string& name, const F& kernel, double items, double cycles) {
    double least = std::numeric_limits<double>::infinity();
    const auto begin = Clock::now();
    for (int round = 0; round < 3 || seconds_since(begin) < 0.2; ++round) {
      const double before = cycles_per_nanosecond();
      const auto start = Clock::now();
      kernel();
      const double nanoseconds = 1e9 * seconds_since(start);
      least = std::min(least, nanoseconds * std::max(before, cycles_per_nanosecond()));
    }
    BenchResult result{name, least / items, "cycles"};
    if (cycles > 0 && is_processor_of_limit_cycles()) result.limit = cycles, result.goal = 1.2;
    results_.push_back(result);
  }

  /// Nanoseconds that the counted work would take if nothing but limit kernels ran.
  double limit_of(const RayStatistics& s) const {
    constexpr double kLightSample = 30;  // its own work, scalar: the middle of what the notes measured
    return static_cast<double>(s.march.lookups) * lookup_limit_ +
           static_cast<double>(s.march.segments) * distribute_limit_ +
           static_cast<double>(s.shadow_rays) * kLightSample;
  }

  struct Pass {
    double nanoseconds = std::numeric_limits<double>::infinity();
    RayStatistics statistics;
  };
  static Pass best_pass(const Scene& scene, int width, int height, int threads, int passes) {
    WorkerPool pool(threads);
    Film film(width, height);
    Pass best;
    double before = 0;
    RayStatistics counted;
    render_batch(scene, passes, film, pool, [&](const BatchProgress& p) {
      best.nanoseconds = std::min(best.nanoseconds, 1e9 * (p.statistics.wall_seconds - before));
      before = p.statistics.wall_seconds;
      best.statistics = p.statistics.rays;
      return true;
    });
    for (std::uint64_t* n : {&best.statistics.rays, &best.statistics.shadow_rays, &best.statistics.march.lookups,
                             &best.statistics.march.segments})
      *n /= static_cast<std::uint64_t>(passes);
    return best;
  }

  /// 128 steps, two light samples of each of two lights with 64 steps, MIS: the ray of the notes.
  Result<void> measure_camera_ray(Node description) {
    if (!wanted("camera ray")) return {};
    // The smoke's camera comes near enough for all pixels to meet it.
    if (auto set = set_by_path(description, "camera.vfov_deg", "5"); !set) return set.error();
    auto scene = commit(description, cache_, {});
    if (!scene) return scene.error();
    double step = static_cast<double>((*scene)->step_size), shadow_step = step;
    Pass pass;
    for (const int passes : {1, 1, 8}) {
      for (const auto& [key, value] : {std::pair("step_size", step), {"shadow_step_size", shadow_step}})
        if (auto set = set_by_path(description, std::string("render.") + key, format_value(value)); !set)
          return set.error();
      scene = commit(description, cache_, {});
      if (!scene) return scene.error();
      pass = best_pass(**scene, 160, 120, 1, passes);
      const RayStatistics& counted = pass.statistics;
      step *= static_cast<double>(counted.march.segments) / (128 * static_cast<double>(counted.rays));
      shadow_step *= static_cast<double>(counted.march.lookups - counted.march.segments) /
                     (64 * static_cast<double>(counted.shadow_rays));
    }
    const double rays = static_cast<double>(pass.statistics.rays);
    const double microseconds = 1e-3 * pass.nanoseconds / rays;
    results_.push_back({"camera ray, with its light samples", microseconds, "us", {}, 1.5});
    results_.push_back({"camera ray, against its limit", microseconds, "us", 1e-3 * limit_of(pass.statistics) / rays});
    results_.push_back({"camera ray, steps", static_cast<double>(pass.statistics.march.segments) / rays, "per ray"});
    results_.push_back({"camera ray, shadow rays", static_cast<double>(pass.statistics.shadow_rays) / rays, "per ray"});
    results_.push_back({"camera ray, look-ups", static_cast<double>(pass.statistics.march.lookups) / rays, "per ray"});
    return {};
  }

  Result<void> measure_scene(const std::string& name) {
    if (!wanted(name)) return {};
    constexpr int kPasses = 8;
    const auto start = Clock::now();
    SceneCache fresh;
    const auto description = read_scene_file(options_.scenes + "/" + name + ".json", scene_family());
    if (!description) return description.error();
    const auto scene = commit(*description, fresh, {});
    if (!scene) return scene.error();
    results_.push_back({name + ", loading", 1e3 * seconds_since(start), "ms"});

    const int width = (*scene)->film.width / 2, height = (*scene)->film.height / 2;
    const Pass one = best_pass(**scene, width, height, 1, kPasses);
    const double pixels = static_cast<double>(width) * height, seconds = 1e-9 * one.nanoseconds;
    BenchResult pass{name + ", one sample per pixel", 1e6 * seconds / pixels, "us per pixel"};
    BenchResult rays{name + ", rays", 1e-6 * static_cast<double>(one.statistics.rays) / seconds, "million/s"};
    BenchResult segments{name + ", segments", 1e-6 * static_cast<double>(one.statistics.march.segments) / seconds,
                         "million/s"};
    // What a procedural look-up takes depends on the shader.
    const auto& media = (*scene)->media;
    if (std::all_of(media.begin(), media.end(),
                    [](const Medium& m) { return m.traits.constant || m.shader->memory_bytes() > 0; })) {
      const double slower = one.nanoseconds / limit_of(one.statistics);
      pass.limit = pass.value / slower, rays.limit = rays.value * slower, segments.limit = segments.value * slower;
    }
    results_.insert(results_.end(), {pass, rays, segments});
    results_.push_back({name + ", grids", 1e-6 * static_cast<double>((*scene)->grid_bytes()), "MB"});

    const Pass all = best_pass(**scene, width, height, 0, kPasses);
    const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    results_.push_back({name + ", all threads against one", one.nanoseconds / all.nanoseconds, "times as fast",
                        static_cast<double>(threads)});
    return {};
  }

  /// What the user waits for, at 1280x720, in the smoke with nothing changed but its bounces.
  Result<void> measure_waiting() {
    if (!wanted("first picture")) return {};
    auto smoke = read_scene_file(options_.scenes + "/smoke.json", scene_family());
    if (!smoke) return smoke.error();
    Node& description = *smoke;
    if (auto set = set_by_path(description, "render.bounces", "0"); !set) return set.error();
    std::uint64_t generation = 0;
    Engine engine;
    const auto wait_for = [&](int divisor) {
      const auto start = Clock::now();
      const auto shown = [&] {
        const auto p = engine.picture();
        return p && p->generation == generation && p->divisor <= divisor;
      };
      while (!shown()) std::this_thread::sleep_for(std::chrono::microseconds(100));
      return 1e3 * seconds_since(start);
    };
    const auto edit = [&]() -> Result<void> {
      auto scene = commit(description, cache_, {.generation = ++generation});
      if (!scene) return scene.error();
      engine.submit({{*scene, 1280, 720}});
      return {};
    };
    std::vector<double> coarse, full;
    for (int k = 0; k < 9; ++k) {
      if (auto done = edit(); !done) return done;
      coarse.push_back(wait_for(64));
      if (auto done = edit(); !done) return done;
      full.push_back(wait_for(1));
    }
    const auto median = [](std::vector<double> v) {
      std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
      return v[v.size() / 2];
    };
    results_.push_back({"first picture of an edit, 1280x720", median(coarse), "ms", {}, 33});
    results_.push_back({"full resolution of an edit, 1280x720", median(full), "ms", {}, 350});

    // A camera that a hand moves: an edit for each of the display's pictures, whatever the renderer does.
    Node orbiting = description;
    std::set<std::uint64_t> seen;
    const auto start = Clock::now();
    constexpr int kEdits = 60;
    const std::uint64_t before = generation;
    for (int k = 0; k < kEdits; ++k) {
      const double angle = 0.02 * k;
      const auto position = Numbers{4 * std::sin(angle), -4 * std::cos(angle), 2};
      if (auto set = set_by_path(orbiting, "camera.position", format_value(position)); !set) return set.error();
      auto scene = commit(orbiting, cache_, {.generation = ++generation});
      if (!scene) return scene.error();
      engine.submit({{*scene, 1280, 720}});
      while (seconds_since(start) < (k + 1) / 60.0) {
        if (const auto p = engine.picture(); p && p->generation > before) seen.insert(p->generation);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
    const double between = 1e3 * seconds_since(start) / static_cast<double>(seen.size());
    results_.push_back({"from picture to picture in an orbit, 1280x720", between, "ms", {}, 40});
    return {};
  }

  /// Tiles handed to 64 threads as the pool does it, by the times they take here; then what one thread does alone
  /// before the next pass begins. What the threads' caches and memory would have to share is not in it.
  void model_threads(const Scene& scene) {
    constexpr int kThreads = 64, kWidth = 1280, kHeight = 720;
    const std::vector<double> tiles = tile_seconds(scene, kWidth, kHeight);
    WorkerPool pool;
    const double start_and_end = 1e-9 * least_nanoseconds([&] { pool.run(kThreads, [](int, Worker&) {}); });
    Film film(kWidth, kHeight);
    render_batch(scene, 2, film, pool);
    // A picture after each pass: its rows are shared out too, but not the memory that they are written to.
    const double publishing = 1e-9 * least_nanoseconds([&] { static_cast<void>(view_of(film, pool)); });
    const double allocating = 1e-9 * least_nanoseconds([&] {
                                const Image image(kWidth, kHeight);
                                asm volatile("" : : "r"(image.pixels.data()) : "memory");
                              });
    const double rows = pool.threads() * (publishing - allocating);
    const double one = loop_seconds(tiles, 1) + rows + allocating;
    const double all = loop_seconds(tiles, kThreads) + rows / kThreads + allocating + 2 * start_and_end;
    results_.push_back({"smoke, 64 threads, model", one / all, "times as fast", kThreads});
    results_.push_back({"publishing a picture, 1280x720", 1e3 * publishing, "ms"});
  }

  const BenchOptions& options_;
  SceneCache cache_;
  std::vector<BenchResult> results_;
  double lookup_limit_ = 0, distribute_limit_ = 0;  // ns
};

}  // namespace

Result<std::vector<BenchResult>> run_bench(const BenchOptions& options) { return Bench(options).run(); }

}  // namespace brume
