// One source, several instruction sets: the pictures are the same.
#include <gtest/gtest.h>

#include <algorithm>

#include "renderer/core/simd.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

/// Leaves the best level behind, whatever happens.
struct SimdLevels : testing::TestWithParam<const char*> {
  ~SimdLevels() override { EXPECT_TRUE(force_simd_level("auto")); }
};

Film picture_at(const std::string& level, const Scene& scene) {
  EXPECT_TRUE(force_simd_level(level));
  WorkerPool pool;
  Film film(scene.film.width / 8, scene.film.height / 8);
  render_batch(scene, 4, film, pool);
  return film;
}

bool agree(const Film& a, const Film& b, int x, int y) {
  for (int c = 0; c < 3; ++c) {
    const float p = a.mean(x, y)[c], q = b.mean(x, y)[c];
    if (std::abs(p - q) > 1e-3f * std::max(p, q)) return false;
  }
  return true;
}

TEST_P(SimdLevels, RenderTheSamePictures) {
  Node description = shipped_scene(GetParam());
  set(description, "render.russian_roulette", "false");
  const auto scene = committed(description);
  const std::vector<std::string> levels = simd_levels();
  const Film best = picture_at(levels[0], *scene);
  for (const std::string& level : levels) {
    const Film film = picture_at(level, *scene);
    int different = 0, lit = 0;
    for (int y = 0; y < film.height(); ++y)
      for (int x = 0; x < film.width(); ++x) {
        different += agree(best, film, x, y) ? 0 : 1;
        lit += luminance(best.mean(x, y)) > 0 ? 1 : 0;
      }
    EXPECT_GT(lit, film.width() * film.height() / 10) << "nothing to compare";
    EXPECT_LE(different, lit / 1000) << level << " against " << levels[0] << ", of " << lit << " pixels that are lit";
    if (level == levels[0]) EXPECT_EQ(different, 0) << "not even one level agrees with itself";
    RecordProperty(level, different);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SimdLevels, testing::Values("smoke", "fire", "cloud", "fog", "surfaces"),
                         [](const auto& chosen) { return std::string(chosen.param); });

}  // namespace
}  // namespace brume
