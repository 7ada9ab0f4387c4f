// "Nothing inside a pixel sample calls new": counted by replacing the global operator new of the test program.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "renderer/engine/pass.h"
#include "tests/support/scenes.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BRUME_COUNTS_ALLOCATIONS 0  // the sanitizers replace operator new themselves
#else
#define BRUME_COUNTS_ALLOCATIONS 1

namespace {

std::atomic<bool> g_counting = false;
std::atomic<long> g_allocations = 0;

void* counted(std::size_t size, std::size_t alignment) {
  if (g_counting) ++g_allocations;
  void* p = alignment == 0 ? std::malloc(size > 0 ? size : 1)
                           : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (!p) throw std::bad_alloc();
  return p;
}

}  // namespace

void* operator new(std::size_t size) { return counted(size, 0); }
void* operator new[](std::size_t size) { return counted(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

#endif

namespace brume {
namespace {

/// A bit of everything: chromatic, overlapping, marched and homogeneous media, all lights, bounces.
std::shared_ptr<const Scene> rich_scene(const char* bounces) {
  Node scene = empty_scene();
  set(scene, "render.bounces", bounces);
  set(scene, "render.step_size", "0.02");
  set(scene, "render.light_samples", "2");
  for (const char* shader : {"homogeneous", "gaussian", "cloud", "slabs"}) {
    Node& v = add_volume(scene, shader);
    set(v, "phase.type", "henyey_greenstein");
    set(v, "albedo", "0.9,0.8,0.7");
    set(v, "density_scale", "2");
    set(v, "emission_scale", "0.1");
  }
  for (const char* light : {"point", "quad", "directional", "environment"}) add_light(scene, light);
  return committed(scene);
}

TEST(PixelSample, AllocatesNothingOnceTheArenaHasGrown) {
#if BRUME_COUNTS_ALLOCATIONS
  const auto scene = rich_scene("8");
  const auto integrator = make_integrator(*scene);
  Arena arena;
  RayStatistics statistics;
  const auto sample = [&](std::uint32_t pixel) {
    const Sampler sampler(SamplerKind::Sobol, 1, pixel, 0);
    SampleContext context{*scene, sampler, arena, statistics};
    const float x = static_cast<float>(pixel % 16) / 16, y = static_cast<float>(pixel / 16) / 16;
    return integrator->radiance(scene->camera.ray(x, y, 1), context);
  };
  for (std::uint32_t p = 0; p < 256; ++p) static_cast<void>(sample(p));  // warm-up: the arena takes its blocks
  const std::uint64_t lookups = statistics.march.lookups;
  g_allocations = 0;
  g_counting = true;
  for (std::uint32_t p = 0; p < 256; ++p) static_cast<void>(sample(p));
  g_counting = false;
  EXPECT_EQ(g_allocations, 0);
  EXPECT_EQ(statistics.march.lookups, 2 * lookups);
  EXPECT_GT(lookups, 100000u) << "the rays hardly meet a medium";

  g_counting = true;
  auto* const one = new int(0);  // the counter counts at all
  g_counting = false;
  delete one;
  EXPECT_EQ(g_allocations, 1);
#else
  GTEST_SKIP() << "sanitizers count allocations in their own way";
#endif
}

TEST(PixelSample, AWholePassAllocatesNoMoreThanItsBookkeeping) {
#if BRUME_COUNTS_ALLOCATIONS
  const auto scene = rich_scene("2");
  const auto integrator = make_integrator(*scene);
  WorkerPool pool(2);
  Film film(64, 64);
  for (std::uint32_t pass = 0; pass < 3; ++pass) render_pass(*scene, *integrator, pass, film, pool, {});
  // Both arenas must have seen the deepest ray; the same pass again is not a new one for them.
  g_allocations = 0;
  g_counting = true;
  render_pass(*scene, *integrator, 2, film, pool, {});
  g_counting = false;
  // The closure of the loop, and now and then a block of an arena whose thread had not met such a ray: not 4096
  // samples.
  EXPECT_LE(g_allocations, 8);
#else
  GTEST_SKIP() << "sanitizers count allocations in their own way";
#endif
}

TEST(PixelSample, MemoryDoesNotGrowWithTheNumberOfBounces) {
  const auto high_water = [](const char* bounces, std::uint64_t& rays) {
    const auto scene = rich_scene(bounces);
    const auto integrator = make_integrator(*scene);
    Arena arena;
    RayStatistics statistics;
    for (std::uint32_t p = 0; p < 400; ++p) {
      const Sampler sampler(SamplerKind::Independent, 1, p, 0);
      SampleContext context{*scene, sampler, arena, statistics};
      static_cast<void>(integrator->radiance(
          scene->camera.ray(static_cast<float>(p % 20) / 20, static_cast<float>(p / 20) / 20, 1), context));
      EXPECT_EQ(arena.used_bytes(), 0u);
    }
    rays = statistics.rays;
    return arena.high_water_bytes();
  };
  std::uint64_t few = 0, many = 0;
  const std::size_t shallow = high_water("1", few), deep = high_water("100", many);
  EXPECT_GT(many, 2 * few) << "the deep paths are not deep";
  // A scattered ray may cross more of the scene than any camera ray: the diagonal against the depth, for some media. A
  // record per bounce would be a factor of dozens.
  EXPECT_LT(deep, 2 * shallow);
}

}  // namespace
}  // namespace brume
