#include "app/session/truth.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "renderer/film/image_io.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

class TruthTest : public testing::Test {
 protected:
  std::optional<FoundTruth> find(const TruthKey& known, int width = 8) {
    return finder_.find(scene_, cache_, "", width, 6, ++generation_, known);
  }

  SceneCache cache_;
  TruthFinder finder_;
  std::uint64_t generation_ = 0;
  Node scene_ = empty_scene();
};

TEST_F(TruthTest, WhatIsKnownIsNotLookedForAgain) {
  const auto first = find({});
  ASSERT_TRUE(first);
  ASSERT_TRUE(first->key.scene);
  EXPECT_FALSE(find(first->key)) << "the same";
  set(scene_, "film.exposure", "2");
  set(scene_, "render.step_size", "0.1");
  EXPECT_FALSE(find(first->key)) << "the truth does not depend on these";
  EXPECT_TRUE(find({})) << "somebody who has forgotten it";
  EXPECT_TRUE(find(first->key, 9)) << "another size";
  set(scene_, "render.bounces", "3");
  const auto other = find(first->key);
  ASSERT_TRUE(other);
  EXPECT_NE(other->key.scene, first->key.scene);
}

TEST_F(TruthTest, AGivenPictureIsReadOnceAndOneThatDoesNotFitIsAProblem) {
  const std::string path = testing::TempDir() + "brume_truth_given.exr";
  ASSERT_TRUE(write_exr(path, Image(8, 6, Color(1))).ok());
  set(scene_, "compare.reference", path);
  const auto found = find({});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kept.image.width, 8);
  EXPECT_FALSE(found->key.scene) << "nothing is to be rendered";
  std::filesystem::remove(path);
  EXPECT_FALSE(find(found->key));
  const auto missing = find({});
  ASSERT_TRUE(missing);
  EXPECT_FALSE(missing->problem.empty());
  EXPECT_FALSE(find(missing->key)) << "nor is a problem told again with every edit";
}

TEST_F(TruthTest, IsDoneWhenItHasHadItsTimeAndKeepsWhatItHad) {
  Truth truth;
  truth.want(true);
  auto found = find({});
  found->kept = {Image(8, 6, Color(2)), 0.5, 10, 3.0};
  truth.take(*found);
  ASSERT_TRUE(truth.job());
  EXPECT_EQ(truth.job()->first_sample, 10u);
  ASSERT_TRUE(truth.reference());
  EXPECT_FALSE(truth.see(nullptr, 4));
  auto picture = std::make_shared<Picture>();
  picture->image = Image(8, 6, Color(6));
  picture->width = 8, picture->height = 6;
  picture->generation = found->key.scene->generation;
  picture->variance = 0.5;
  picture->statistics.samples_per_pixel = 30;
  picture->statistics.cpu_seconds = 0.5;
  EXPECT_TRUE(truth.see(picture, 4));
  EXPECT_EQ(truth.reference()->samples_per_pixel, 40);
  EXPECT_FLOAT_EQ(truth.reference()->image.at(0, 0).r, 5) << "a quarter of 2 and three of 6";
  EXPECT_FALSE(truth.see(picture, 4)) << "seen";
  picture = std::make_shared<Picture>(*picture);
  picture->statistics.cpu_seconds = 1.5;
  EXPECT_TRUE(truth.see(picture, 4));
  EXPECT_FALSE(truth.job()) << "3 and 1.5 seconds are more than 4";
}

}  // namespace
}  // namespace brume
