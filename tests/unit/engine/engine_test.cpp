#include "renderer/engine/engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "renderer/engine/pass.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

using namespace std::chrono_literals;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kSlow = 20;  // times longer may anything take
#else
constexpr int kSlow = 1;
#endif

constexpr int kWidth = 45, kHeight = 37;  // no multiples of a tile, so that there are parts of tiles

/// A marched medium in two colours of light; `brightness` tells the pictures of edits apart.
Node description_of(double brightness = 1, const char* bounces = "1") {
  Node scene = empty_scene();
  set(scene, "render.bounces", bounces);
  set(scene, "camera.position", "0,-4,0.5");
  Node& v = add_volume(scene, "gaussian");
  set(v, "albedo", "0.9,0.7,0.5");
  set(v, "density_scale", "4");
  set(v, "phase.type", "henyey_greenstein");
  set(v, "phase.g", "0.4");
  set(add_light(scene, "point"), "intensity", format_value(Numbers{brightness, brightness, 2 * brightness}));
  set(add_light(scene, "environment"), "radiance", "0.1,0.2,0.3");
  return scene;
}

std::shared_ptr<const Scene> scene_of(std::uint64_t generation, double brightness = 1, const char* bounces = "1") {
  return committed(description_of(brightness, bounces), generation);
}

Image batch(const Scene& scene, int samples, int threads, int width = kWidth, int height = kHeight) {
  WorkerPool pool(threads);
  Film film(width, height);
  render_batch(scene, samples, film, pool);
  return film.mean_image();
}

/// Waits until the condition holds; false when it takes unreasonably long.
template <class Condition> bool eventually(const Condition& condition) {
  const auto give_up = std::chrono::steady_clock::now() + kSlow * 60s;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

bool finished(const Engine& engine, std::size_t job, std::uint64_t generation) {
  const auto picture = engine.picture(job);
  return picture && picture->finished && picture->generation == generation;
}

// ---- Passes ---------------------------------------------------------------------------------------------------------

// O13 of the catalogue; tests/render/oracles_test.cpp does it for every integrator.
TEST(RenderBatch, GivesTheSameBitsAtAnyNumberOfThreads) {
  for (const char* sampler : {"sobol", "independent"}) {
    Node scene = empty_scene();
    set(scene, "render.sampler", sampler);
    set(scene, "render.bounces", "3");
    set(scene, "camera.position", "0,-4,0.5");
    set(add_volume(scene, "gaussian"), "density_scale", "4");
    set(add_volume(scene, "homogeneous"), "albedo", "0.5,0.9,0.7");
    for (const char* light : {"point", "quad", "directional", "environment"}) add_light(scene, light);
    const auto s = committed(scene);
    const Image one = batch(*s, 4, 1);
    EXPECT_GT(mean(one.at(20, 20)), 0);
    EXPECT_TRUE(one == batch(*s, 4, 2)) << sampler;
    EXPECT_TRUE(one == batch(*s, 4, 7)) << sampler;
  }
}

TEST(RenderBatch, SamplesDoNotDependOnHowTheyAreDividedIntoRuns) {
  const auto scene = scene_of(1);
  const auto integrator = make_integrator(*scene);
  WorkerPool pool(2);
  Film film(kWidth, kHeight);
  for (std::uint32_t pass = 0; pass < 5; ++pass) EXPECT_TRUE(render_pass(*scene, *integrator, pass, film, pool, {}));
  EXPECT_TRUE(film.mean_image() == batch(*scene, 5, 3));
}

TEST(RenderBatch, ReportsWhatItHasDoneAndStopsWhenTold) {
  WorkerPool pool(2);
  Film film(kWidth, kHeight);
  int calls = 0;
  const auto statistics = render_batch(*scene_of(1), 10, film, pool, [&](const BatchProgress& p) {
    EXPECT_EQ(p.statistics.samples_per_pixel, ++calls);
    EXPECT_EQ(p.film.sample_count(3, 3), static_cast<std::uint32_t>(calls));
    return calls < 4;
  });
  EXPECT_EQ(statistics.samples_per_pixel, 4);
  EXPECT_EQ(statistics.threads, 2);
  EXPECT_GE(statistics.rays.rays, 4u * kWidth * kHeight);
  EXPECT_GT(statistics.rays.march.lookups, 0u);
  EXPECT_GT(statistics.pool_high_water_bytes, 0u);
  EXPECT_GT(statistics.cpu_seconds, 0);
}

TEST(RenderPass, ACancelledPassSaysSoAndStopsWithinARowOfEveryThread) {
  const auto scene = scene_of(1);
  const auto integrator = make_integrator(*scene);
  WorkerPool pool(2);
  Film film(256, 256);
  std::atomic<int> asked = 0;
  EXPECT_FALSE(render_pass(*scene, *integrator, 0, film, pool, [&] { return ++asked > 6; }));
  int pixels = 0;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) pixels += static_cast<int>(film.sample_count(x, y));
  EXPECT_GT(pixels, 0);
  EXPECT_LE(pixels, 6 * 32);  // six rows of a tile were allowed
  EXPECT_TRUE(render_pass(*scene, *integrator, 0, film, pool, [] { return false; }));
}

TEST(RenderPreview, IsTheSameViewWithFewerPixels) {
  const auto scene = scene_of(1);
  const auto integrator = make_integrator(*scene);
  WorkerPool pool(2);
  Image coarse;
  ASSERT_TRUE(render_preview(*scene, *integrator, 64, 48, 4, coarse, pool, {}));
  EXPECT_EQ(coarse.width, 16);
  EXPECT_EQ(coarse.height, 12);
  ASSERT_TRUE(render_preview(*scene, *integrator, kWidth, kHeight, 8, coarse, pool, {}));
  EXPECT_EQ(coarse.width, 6);  // rounded up
  EXPECT_EQ(coarse.height, 5);
  // Brightness of the whole picture: one sample per coarse pixel against the mean of many.
  RunningMean few, many;
  ASSERT_TRUE(render_preview(*scene, *integrator, 128, 128, 2, coarse, pool, {}));
  for (const Color& c : coarse.pixels) few.add(double(mean(c)));
  for (const Color& c : batch(*scene, 8, 2, 64, 64).pixels) many.add(double(mean(c)));
  EXPECT_NEAR(few.mean(), many.mean(), 6 * few.standard_error());
}

// ---- Engine ---------------------------------------------------------------------------------------------------------

TEST(Engine, GivesTheSameBitsAsTheBatchRenderer) {
  const auto scene = scene_of(3);
  for (const int threads : {1, 3}) {
    Engine engine({.threads = threads});
    engine.submit({{scene, kWidth, kHeight, 6}});
    ASSERT_TRUE(eventually([&] { return finished(engine, 0, 3); }));
    const auto picture = engine.picture();
    EXPECT_EQ(picture->divisor, 1);
    EXPECT_EQ(picture->statistics.samples_per_pixel, 6);
    EXPECT_EQ(picture->width, kWidth);
    EXPECT_EQ(picture->height, kHeight);
    EXPECT_TRUE(picture->image == batch(*scene, 6, 2)) << threads << " threads";
  }
}

TEST(RenderPass, InSlicesThatEndAnywhereIsTheSamePass) {
  constexpr int kSide = 300;  // a hundred tiles
  const auto scene = scene_of(1, 1, "0");
  const auto integrator = make_integrator(*scene);
  WorkerPool pool(7);
  Film film(kSide, kSide);
  int slices = 0;
  for (std::uint32_t sample = 0; sample < 3; ++sample)
    for (int tile = 0; tile < tile_count(kSide, kSide); ++slices) {
      std::atomic<int> asked = 0;
      const auto end = render_pass(*scene, *integrator, sample, film, pool, {}, {tile, tile + 40},
                                   [&] { return ++asked > slices % 13; });
      ASSERT_TRUE(end);
      ASSERT_GE(*end, tile);
      ASSERT_LE(*end, tile + 40);
      tile = *end;
    }
  EXPECT_GT(slices, 20);
  EXPECT_TRUE(film.mean_image() == batch(*scene, 3, 2, kSide, kSide));
}

TEST(Engine, HasNoPictureBeforeTheFirstAndNoneOfJobsThatDoNotExist) {
  Engine engine({.threads = 1});
  EXPECT_EQ(engine.picture(), nullptr);
  engine.submit({{scene_of(1), kWidth, kHeight, 1}});
  ASSERT_TRUE(eventually([&] { return finished(engine, 0, 1); }));
  EXPECT_EQ(engine.picture(1), nullptr);
}

TEST(Engine, SeveralJobsAreAllFinishedAndEachIsItsOwn) {
  const std::shared_ptr<const Scene> scenes[] = {scene_of(5, 1), scene_of(5, 3, "0"), scene_of(5, 0.2, "2")};
  const int samples[] = {3, 5, 1}, widths[] = {40, 17, 64}, heights[] = {20, 33, 64};
  Engine engine({.threads = 2});
  std::vector<Job> jobs;
  for (int i = 0; i < 3; ++i) jobs.push_back({scenes[i], widths[i], heights[i], samples[i]});
  engine.submit(jobs);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(eventually([&] { return finished(engine, i, 5); })) << i;
    const auto picture = engine.picture(i);
    EXPECT_EQ(picture->statistics.samples_per_pixel, samples[i]);
    EXPECT_TRUE(picture->image == batch(*scenes[i], samples[i], 2, widths[i], heights[i])) << i;
  }
}

/// Work instead of time, so that a test depends on no machine: one unit for each ray, ten for each look-up or segment.
double counted_work(const Worker& worker) {
  const RayStatistics& s = worker.statistics;
  return 1e-8 * double(s.rays + s.shadow_rays + 10 * (s.march.lookups + s.march.segments));
}

TEST(Engine, EqualTimeIsEqualWithinATenth) {
  std::vector<Job> jobs;
  for (const char* bounces : {"0", "2", "9"}) jobs.push_back({scene_of(7, 1, bounces), 160, 120});
  Engine engine({.threads = 2, .on_picture = {}, .clock = counted_work});
  engine.submit(jobs);
  const auto seconds = [&](std::size_t i) {
    const auto p = engine.picture(i);
    return p ? p->statistics.cpu_seconds : 0;
  };
  ASSERT_TRUE(eventually([&] { return seconds(0) > 2 && seconds(1) > 2 && seconds(2) > 2; }));
  engine.pause(true);
  std::this_thread::sleep_for(kSlow * 50ms);
  // Published is what whole passes took; the dearest pass of the three takes less than a tenth of all.
  const double most = std::max({seconds(0), seconds(1), seconds(2)}),
               least = std::min({seconds(0), seconds(1), seconds(2)});
  EXPECT_LT(most, 1.1 * least) << seconds(0) << " " << seconds(1) << " " << seconds(2);
  EXPECT_GT(engine.picture(0)->statistics.samples_per_pixel, 2 * engine.picture(2)->statistics.samples_per_pixel)
      << "the cheap one has more samples for its time";
}

TEST(Engine, EqualSamplesAreEqualWithinOne) {
  std::vector<Job> jobs;
  for (const char* bounces : {"0", "9"}) jobs.push_back({scene_of(7, 1, bounces), 160, 120});
  Engine engine({.threads = 2, .on_picture = {}, .clock = counted_work});
  engine.set_share(Share::EqualSamples);
  engine.submit(jobs);
  ASSERT_TRUE(eventually([&] {
    const auto p = engine.picture(1);
    return p && p->statistics.samples_per_pixel >= 20;
  }));
  engine.pause(true);
  std::this_thread::sleep_for(kSlow * 50ms);
  EXPECT_NEAR(engine.picture(0)->statistics.samples_per_pixel, engine.picture(1)->statistics.samples_per_pixel, 2);
}

TEST(Engine, WhatAnEditLeavesAsItWasKeepsItsSamplesInWhateverPlace) {
  const auto kept = scene_of(1), edited = scene_of(1, 3);
  Engine engine({.threads = 2});
  engine.submit({{kept, 64, 64, 9}, {edited, 64, 64, 9}});
  ASSERT_TRUE(eventually([&] { return finished(engine, 0, 1) && finished(engine, 1, 1); }));
  const auto before = engine.picture(0);
  const auto next = scene_of(2, 5);
  engine.submit({{next, 64, 64, 9}, {kept, 64, 64, 9}});
  ASSERT_TRUE(eventually([&] { return finished(engine, 0, 2); }));
  EXPECT_EQ(engine.picture(1), before);
  EXPECT_TRUE(engine.picture(0)->image == batch(*next, 9, 2, 64, 64));
  engine.submit({{next, 64, 64, 9}, {kept, 64, 64, 9}}, true);
  ASSERT_TRUE(eventually([&] { return finished(engine, 1, 1) && engine.picture(1) != before; })) << "a restart";
  EXPECT_TRUE(engine.picture(1)->image == before->image);
}

TEST(Engine, AStormOfEditsOfOneJobDoesNotHarmTheOther) {
  const auto kept = scene_of(1);
  Engine engine({.threads = 2});
  for (std::uint64_t g = 2; g < 60; ++g) {
    engine.submit({{kept, 100, 80, 40}, {scene_of(g, double(g % 5)), 100, 80, 40}});
    if (g % 4 == 0) std::this_thread::sleep_for(3ms);
    // Wanted away and wanted back at once, perhaps in the middle of a pass.
    if (g % 7 == 0) engine.submit({{scene_of(g), 100, 80, 40}});
  }
  ASSERT_TRUE(eventually([&] { return finished(engine, 0, 1) && finished(engine, 1, 59); }));
  EXPECT_TRUE(engine.picture(0)->image == batch(*kept, 40, 2, 100, 80));
}

TEST(Engine, APauseKeepsTheSamplesAndNothingIsRenderedInIt) {
  const auto scene = scene_of(2);
  Engine engine({.threads = 2});
  engine.submit({{scene, kWidth, kHeight, 200}});
  ASSERT_TRUE(eventually([&] {
    const auto p = engine.picture();
    return p && p->statistics.samples_per_pixel >= 3;
  }));
  engine.pause(true);
  EXPECT_TRUE(engine.paused());
  std::this_thread::sleep_for(kSlow * 50ms);  // the pass under way ends
  const auto before = engine.picture();
  std::this_thread::sleep_for(kSlow * 50ms);
  EXPECT_EQ(engine.picture(), before) << "a picture was published while paused";
  EXPECT_FALSE(before->finished);
  engine.pause(false);
  ASSERT_TRUE(eventually([&] { return finished(engine, 0, 2); }));
  EXPECT_GE(engine.picture()->statistics.samples_per_pixel, before->statistics.samples_per_pixel);
  EXPECT_TRUE(engine.picture()->image == batch(*scene, 200, 2));
}

// "Edits made meanwhile are still shown coarsely", and every edit's first picture is a coarse one.
TEST(Engine, AnEditWhilePausedIsShownCoarselyOnceAndNoFurther) {
  Engine engine({.threads = 2});
  engine.pause(true);
  for (std::uint64_t generation = 1; generation <= 5; ++generation) {
    engine.submit({{scene_of(generation, double(generation)), 200, 100, 50}});
    ASSERT_TRUE(eventually([&] {
      const auto p = engine.picture();
      return p && p->generation == generation;
    }));
    const auto first = engine.picture();
    EXPECT_GE(first->divisor, 2);
    EXPECT_EQ(first->image.width, (200 + first->divisor - 1) / first->divisor);
    EXPECT_EQ(first->width, 200);
    EXPECT_EQ(first->statistics.samples_per_pixel, 0);
    std::this_thread::sleep_for(kSlow * 20ms);
    EXPECT_EQ(engine.picture(), first) << "more than the coarse picture was rendered in a pause";
  }
}

// With many light samples the first pass is late; with few it is as soon there as a preview.
TEST(Engine, AFullPreviewComesFirstWherePassesDrawManyLightSamples) {
  for (const int light_samples : {2, 16}) {
    Node description = description_of();
    set(description, "render.light_samples", std::to_string(light_samples));
    const auto scene = committed(description);
    std::mutex mutex;
    std::vector<std::shared_ptr<const Picture>> seen;
    Engine* shown = nullptr;
    EngineOptions options{.threads = 2};
    options.on_picture = [&] {
      const std::lock_guard lock(mutex);
      if (shown) seen.push_back(shown->picture());
    };
    Engine engine(options);
    {
      const std::lock_guard lock(mutex);
      shown = &engine;
    }
    engine.submit({{scene, 200, 100, 2}});
    ASSERT_TRUE(eventually([&] { return finished(engine, 0, scene->generation); }));
    const std::lock_guard lock(mutex);
    int full_previews = 0;
    bool film_began = false;
    for (const auto& p : seen) {
      film_began |= !p->preview;
      if (!p->preview) continue;
      EXPECT_FALSE(film_began) << "a preview after a picture of the film";
      EXPECT_EQ(p->statistics.samples_per_pixel, 0);
      full_previews += p->divisor == 1 ? 1 : 0;
    }
    EXPECT_EQ(full_previews, light_samples == 16 ? 1 : 0);
    EXPECT_TRUE(engine.picture()->image == batch(*scene, 2, 2, 200, 100)) << "the preview is not in the film";
  }
}

// O14 of the catalogue.
TEST(Engine, AStormOfEditsEndsWithThePictureOfTheNewestAndNeverGoesBack) {
  constexpr std::uint64_t kEdits = 200;
  std::vector<std::shared_ptr<const Scene>> scenes;
  for (std::uint64_t g = 1; g <= kEdits; ++g) scenes.push_back(scene_of(g, 0.5 + double(g % 7)));
  Engine engine({.threads = 2});
  std::atomic<bool> stop = false;
  std::uint64_t newest_seen = 0, pictures = 0;
  bool went_back = false, mislabelled = false;
  std::thread watcher([&] {
    std::shared_ptr<const Picture> last;
    while (!stop) {
      const auto p = engine.picture();
      if (p && p != last) {
        ++pictures;
        went_back |= p->generation < newest_seen;
        newest_seen = std::max(newest_seen, p->generation);
        mislabelled |= p->image.width != (p->width + p->divisor - 1) / p->divisor;
        last = p;
      }
      std::this_thread::yield();
    }
  });
  for (std::uint64_t g = 1; g <= kEdits; ++g) {
    engine.submit({{scenes[g - 1], kWidth, kHeight, g < kEdits ? 1000 : 3}});
    if (g % 3 == 0) std::this_thread::sleep_for(1ms);
    if (g % 50 == 0) std::this_thread::sleep_for(30ms);  // long enough for a first look
  }
  ASSERT_TRUE(eventually([&] { return finished(engine, 0, kEdits); }));
  std::this_thread::sleep_for(kSlow * 20ms);
  stop = true;
  watcher.join();
  EXPECT_FALSE(went_back);
  EXPECT_FALSE(mislabelled);
  EXPECT_EQ(newest_seen, kEdits);
  EXPECT_GE(pictures, 4u) << "no pictures came while edits did";
  EXPECT_TRUE(engine.picture()->image == batch(*scenes.back(), 3, 2)) << "samples of other edits are in the picture";
}

TEST(Engine, ANewSizeOrNumberOfJobsReplacesTheOldOnes) {
  Engine engine({.threads = 2});
  engine.submit({{scene_of(1), 30, 20, 2}, {scene_of(1), 10, 10, 2}});
  ASSERT_TRUE(eventually([&] { return finished(engine, 0, 1) && finished(engine, 1, 1); }));
  engine.submit({{scene_of(2), 50, 60, 2}});
  ASSERT_TRUE(eventually([&] { return finished(engine, 0, 2); }));
  EXPECT_EQ(engine.picture()->image.width, 50);
  EXPECT_EQ(engine.picture(1), nullptr);
  engine.submit({});
  EXPECT_TRUE(eventually([&] { return engine.picture() == nullptr; }));
  engine.submit({{scene_of(3), 30, 20, 1}});
  EXPECT_TRUE(eventually([&] { return finished(engine, 0, 3); }));
}

TEST(Engine, ThePictureOfTheLastEditStaysUntilTheNextOneIsThere) {
  Engine engine({.threads = 2});
  engine.submit({{scene_of(1), 40, 30, 2}});
  ASSERT_TRUE(eventually([&] { return finished(engine, 0, 1); }));
  engine.submit({{scene_of(2), 40, 30, 2}});
  while (!finished(engine, 0, 2)) ASSERT_NE(engine.picture(), nullptr);  // never black in between
}

TEST(Engine, CanBeDestroyedInTheMiddleOfItsWork) {
  for (int i = 0; i < 20; ++i) {
    Engine engine({.threads = 2});
    engine.submit({{scene_of(1, 1, "5"), 300, 300, 1000}});
    if (i % 2) std::this_thread::sleep_for(std::chrono::milliseconds(i));
  }
  SUCCEED() << "it neither hung nor crashed";
}

TEST(Engine, ASceneWithoutAnythingIsRenderedToo) {
  Engine engine({.threads = 1});
  engine.submit({{committed(empty_scene(), 1), 8, 8, 2}});
  ASSERT_TRUE(eventually([&] { return finished(engine, 0, 1); }));
  EXPECT_EQ(engine.picture()->image.at(4, 4), Color(0));
  EXPECT_EQ(engine.picture()->statistics.rays.non_finite, 0u);
}

}  // namespace
}  // namespace brume
