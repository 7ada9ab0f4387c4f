#include "renderer/scene/compare.h"

#include <gtest/gtest.h>

#include "renderer/scene_io/scene_file.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

Result<Node> read(const std::string& json) { return read_scene_text(json, "test.json", "", scene_family()); }

Node with_variants(const std::vector<Settings>& variants) {
  Node scene = empty_scene();
  add_volume(scene, "homogeneous");
  for (const Settings& settings : variants) {
    Node& v = scene.child("compare")
                  .list("variants")
                  .emplace_back(*compare_family().tables.front()->find_slot("variants")->family->tables.front());
    EXPECT_TRUE(v.set("set", settings).ok());
  }
  return scene;
}

TEST(Compare, ASceneWithoutVariantsIsItsOwnOnlyOne) {
  const Node scene = empty_scene();
  const auto variants = variants_of(scene);
  ASSERT_TRUE(variants.ok());
  ASSERT_EQ(variants->size(), 1u);
  EXPECT_EQ(variants->front().name, "scene");
  EXPECT_EQ(variants->front().description, scene);
}

TEST(Compare, VariantsAreReadFromASceneFileAndAreTheSceneWithTheirSettings) {
  const auto scene = read(R"({"brume": 1, "render": {"bounces": 2},
    "compare": {"share": "equal_samples", "variants": [
      {"name": "as it is"},
      {"set": {"render.distance_sampling": "density", "render.step_size": 0.2}},
      {"name": "off", "enabled": false, "set": {"render.bounces": 7}},
      {"name": "tracked", "set": {"render.integrator": "delta_tracking", "render.russian_roulette": true}}]}})");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  const auto variants = variants_of(*scene);
  ASSERT_TRUE(variants.ok()) << variants.error().to_string();
  ASSERT_EQ(variants->size(), 3u);
  EXPECT_EQ((*variants)[0].name, "as it is");
  EXPECT_EQ((*variants)[1].name, "B");
  EXPECT_EQ((*variants)[2].name, "tracked");
  Node expected = *scene;
  expected.child("compare") = Node(*compare_family().tables.front());
  EXPECT_EQ((*variants)[0].description, expected);
  set(expected, "render.distance_sampling", "density");
  set(expected, "render.step_size", "0.2");
  EXPECT_EQ((*variants)[1].description, expected);
  EXPECT_EQ((*variants)[2].description.child("render").kind(), "delta_tracking");
  EXPECT_TRUE((*variants)[2].description.child("render").flag("russian_roulette"));
  EXPECT_EQ((*variants)[2].description.child("render").integer("bounces"), 2) << "kept from the scene";
}

TEST(Compare, WhatIsWrittenIsReadBackWithNumbersAsNumbers) {
  const Node scene = with_variants({{},
                                    {{"render.step_size", "0.25"},
                                     {"volumes.0.albedo", "[1, 0.5, 0]"},
                                     {"render.integrator", "ray_march"},
                                     {"render.russian_roulette", "true"}}});
  const auto text = write_scene_text(scene, "");
  ASSERT_TRUE(text.ok());
  EXPECT_NE(text->find("\"render.step_size\": 0.25"), std::string::npos) << *text;
  EXPECT_NE(text->find("\"render.russian_roulette\": true"), std::string::npos) << *text;
  const auto again = read(*text);
  ASSERT_TRUE(again.ok()) << again.error().to_string();
  EXPECT_EQ(*again, scene);
}

void expect_refused(const Settings& settings, const std::string& key, const std::string& words) {
  const auto variants = variants_of(with_variants({{}, settings}));
  ASSERT_FALSE(variants.ok()) << key;
  EXPECT_EQ(variants.error().source.key, key);
  EXPECT_NE(variants.error().message.find(words), std::string::npos) << variants.error().message;
  SceneCache cache;
  EXPECT_FALSE(commit(with_variants({{}, settings}), cache, {}).ok()) << "a render of the scene would not have told";
}

TEST(Compare, RefusesWhatCannotBeSetAndNamesTheSetting) {
  expect_refused({{"render.stp_size", "1"}}, "compare.variants.1.set.render.stp_size", "did you mean step_size");
  expect_refused({{"render.step_size", "-1"}}, "compare.variants.1.set.render.step_size", "greater than 0");
  expect_refused({{"lights.sun.angle", "1"}}, "compare.variants.1.set.lights.sun.angle", "unknown light");
  for (const char* common : {"camera.vfov_deg", "film.exposure", "render.seed", "compare.share"})
    expect_refused({{common, "1"}}, std::string("compare.variants.1.set.") + common, "in common");
}

TEST(Compare, FiveVariantsAreTooMany) {
  const auto variants = variants_of(with_variants({{}, {}, {}, {}, {}}));
  ASSERT_FALSE(variants.ok());
  EXPECT_NE(variants.error().message.find("at most 4"), std::string::npos);
}

TEST(Compare, ASettingIsChangedInItsPlaceAndTakenAway) {
  Node scene = with_variants({{{"render.bounces", "1"}, {"render.step_size", "0.1"}}});
  set_in_variant(scene, 0, "render.bounces", "3");
  set_in_variant(scene, 0, "render.light_samples", "2");
  const auto settings = [&] { return scene.child("compare").list("variants")[0].settings("set"); };
  EXPECT_EQ(settings(),
            (Settings{{"render.bounces", "3"}, {"render.step_size", "0.1"}, {"render.light_samples", "2"}}));
  unset_in_variant(scene, 0, "render.step_size");
  EXPECT_EQ(settings(), (Settings{{"render.bounces", "3"}, {"render.light_samples", "2"}}));
}

TEST(Compare, AVariantThatIsOffNeedNotBeRight) {
  Node scene = with_variants({{}, {{"render.nothing", "1"}}});
  EXPECT_FALSE(variants_of(scene).ok());
  set(scene, "compare.variants.1.enabled", "false");
  ASSERT_TRUE(variants_of(scene).ok());
  EXPECT_EQ(variants_of(scene)->size(), 1u);
}

TEST(Compare, SettingsFollowAnObjectThatIsRenamedAndLeaveOneThatIsReplaced) {
  Node scene = with_variants(
      {{{"volumes.0.albedo", "0.5"}, {"render.integrator", "delta_tracking"}, {"render.russian_roulette", "true"}}});
  set(scene, "volumes.0.name", "plume");
  rename_in_variants(scene, "volumes.0", "volumes.plume");
  const auto settings = [&] { return scene.child("compare").list("variants")[0].settings("set"); };
  EXPECT_EQ(settings()[0].path, "volumes.plume.albedo");
  set_in_variant(scene, 0, "render.step_size", "0.1");
  EXPECT_FALSE(variants_of(scene).ok()) << "delta tracking takes no steps";
  drop_refused_settings(scene, 0);
  EXPECT_EQ(settings().size(), 3u);
  EXPECT_TRUE(variants_of(scene).ok());
}

// As the file of a volume itself: relative to the scene's folder on disk, absolute in memory.
TEST(Compare, FilesThatSettingsNameBelongToTheScenesFolder) {
  const auto scene = read_scene_text(
      R"({"brume": 1, "volumes": [{"shader": "homogeneous"}], "compare": {"variants": [
          {"set": {"volumes.0.shader": "vdb", "volumes.0.file": "grids/a.vdb", "volumes.0.name": "smoke"}},
          {"set": {"render.bounces": 2}}]}})",
      "test.json", "/home/scenes", scene_family());
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  const auto settings = scene->child("compare").list("variants")[0].settings("set");
  EXPECT_EQ(settings[1].value, "/home/scenes/grids/a.vdb");
  EXPECT_EQ(settings[2].value, "smoke") << "a name is no file";
  const auto text = write_scene_text(*scene, "/home/scenes");
  ASSERT_TRUE(text.ok());
  EXPECT_NE(text->find("\"grids/a.vdb\""), std::string::npos) << *text;
  EXPECT_EQ(*read_scene_text(*text, "again.json", "/home/scenes", scene_family()), *scene);
}

TEST(Compare, SettingsCanBeTyped) {
  Node scene = with_variants({{}});
  set(scene, "compare.variants.0.set", "render.bounces=2; render.integrator = ray_march");
  EXPECT_EQ(scene.child("compare").list("variants")[0].settings("set"),
            (Settings{{"render.bounces", "2"}, {"render.integrator", "ray_march"}}));
  EXPECT_FALSE(set_by_path(scene, "compare.variants.0.set", "render.bounces").ok());
  EXPECT_FALSE(set_by_path(scene, "compare.variants.0.set", "a=1; a=2").ok()) << "set twice";
}

}  // namespace
}  // namespace brume
