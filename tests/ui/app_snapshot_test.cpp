// Every view and panel of the user interface as a picture, compared with tests/ui/baselines.
#include "renderer/core/simd.h"
#include "tests/support/snapshot.h"
#include "tests/ui/app_fixture.h"

namespace brume {
namespace {

class AppSnapshot : public AppFixture {
 protected:
  void SetUp() override {
    // One level for all machines: the lowest that every x86-64 of the last fifteen years has.
    ASSERT_TRUE(force_simd_level("sse4").ok());
  }
  void TearDown() override {
    AppFixture::TearDown();
    ASSERT_TRUE(force_simd_level("auto").ok());
  }

  /// Each with one setting, or as the scene is.
  void make_variants(const std::vector<Setting>& settings) {
    session().change([&](Node& d) {
      const Node plain(*compare_family().tables.front()->find_slot("variants")->family->tables.front());
      d.child("compare").list("variants").assign(settings.size(), plain);
      for (std::size_t i = 0; i < settings.size(); ++i)
        if (!settings[i].path.empty()) set_in_variant(d, i, settings[i].path, settings[i].value);
    });
    session().close_step();
    settle();
  }

  testing::AssertionResult looks_like(const std::string& name) {
    // The mouse leaves every widget, so that nothing is lit up by it.
    robot().frames(2);
    Image8 image(stage_->width(), stage_->height(), 4);
    image.bytes = stage_->pixels();
    Region rendered;
    // Of several pictures it is all the room they have.
    const ui::ItemRecord* picture = robot().last_drawn("View/picture");
    if (!picture && session().shown().size() > 1) picture = robot().last_drawn("View");
    if (picture) {
      const auto& r = picture->rect;
      rendered = {static_cast<int>(r.min.x), static_cast<int>(r.min.y), static_cast<int>(r.max.x - r.min.x),
                  static_cast<int>(r.max.y - r.min.y)};
    }
    return matches_baseline(image, name, rendered);
  }
};

TEST_F(AppSnapshot, SmokeWithRenderSettings) {
  start(scene_path("smoke.json"), 8);
  EXPECT_TRUE(looks_like("smoke_render"));
}

TEST_F(AppSnapshot, FireWithVolume) {
  start(scene_path("fire.json"), 8);
  ASSERT_TRUE(done(robot().click("Scene/Volumes/fire/fire")));
  EXPECT_TRUE(looks_like("fire_volume"));
}

TEST_F(AppSnapshot, FogWithLight) {
  start(scene_path("fog.json"), 8);
  ASSERT_TRUE(done(robot().click("Scene/Lights/lantern/lantern")));
  EXPECT_TRUE(looks_like("fog_light"));
}

TEST_F(AppSnapshot, CloudWithShader) {
  start(scene_path("cloud.json"), 4);
  ASSERT_TRUE(done(robot().click("Scene/Volumes/cumulus/cumulus")));
  EXPECT_TRUE(looks_like("cloud_volume"));
}

TEST_F(AppSnapshot, CameraAndFilm) {
  start(scene_path("fog.json"), 2);
  ASSERT_TRUE(done(robot().click("Scene/Camera")));
  EXPECT_TRUE(looks_like("camera"));
  ASSERT_TRUE(done(robot().click("Scene/Film")));
  EXPECT_TRUE(looks_like("film"));
}

TEST_F(AppSnapshot, BareGridFile) {
  start(scene_path("vdb/smoke_plume_96_f050.vdb"), 8);
  EXPECT_TRUE(looks_like("first_look"));
}

TEST_F(AppSnapshot, Log) {
  start(scene_path("fog.json"), 2);
  // The file's own path differs between machines, so the messages here are the test's.
  session().say(LogLevel::Warning, "3 voxels were not finite and count as 0.");
  session().say(LogLevel::Error, "scene.json:3:9: render.step_size: found -1, expected a number greater than 0");
  robot().frames(3);
  ASSERT_TRUE(robot().exists("View/picture"));
  settle();
  EXPECT_TRUE(looks_like("log"));
}

TEST_F(AppSnapshot, HelpOverlay) {
  start(scene_path("fog.json"), 2);
  robot().type("?");
  robot().frames(3);
  EXPECT_TRUE(looks_like("help"));
}

TEST_F(AppSnapshot, MenuAndPictureOnly) {
  start(scene_path("fog.json"), 2);
  ASSERT_TRUE(done(robot().click("Menu/View")));
  EXPECT_TRUE(looks_like("menu_view"));
  robot().press_key(ui::Key::Escape);
  robot().press_key(ui::Key::Tab);
  settle();
  EXPECT_TRUE(looks_like("picture_only"));
}

TEST_F(AppSnapshot, BlackPictureExplained) {
  start(scene_path("smoke.json"), 2);
  session().change([](Node& d) { ASSERT_TRUE(d.list("volumes")[0].set("density_scale", 0.001).ok()); });
  settle();
  EXPECT_TRUE(looks_like("black_explained"));
}

TEST_F(AppSnapshot, ProbeAndTakes) {
  start(scene_path("smoke.json"), 4);
  robot().press_key(ui::Key::T);
  session().change([](Node& d) { ASSERT_TRUE(d.list("volumes")[0].set("density_scale", 8.0).ok()); });
  settle();
  robot().press_key(ui::Key::T);
  robot().press_key(ui::Key::P);
  robot().frames(2);
  settle();
  EXPECT_TRUE(looks_like("probe_and_takes"));
}

TEST_F(AppSnapshot, FourVariantsAsTiles) {
  start(scene_path("smoke.json"), 4);
  make_variants({{}, {"render.bounces", "0"}, {"render.distance_sampling", "density"}, {"render.bounces", "3"}});
  EXPECT_TRUE(looks_like("compare_tiles"));
}

TEST_F(AppSnapshot, TwoVariantsAsAWipe) {
  start(scene_path("smoke.json"), 4);
  make_variants({{}, {"render.bounces", "0"}});
  robot().press_key(ui::Key::W);
  EXPECT_TRUE(looks_like("compare_wipe"));
}

TEST_F(AppSnapshot, UnsavedQuestion) {
  start(scene_path("fog.json"), 2);
  session().change([](Node& d) { ASSERT_TRUE(d.child("render").set("bounces", std::int64_t{1}).ok()); });
  settle();
  window_->request_quit();
  robot().frames(3);
  EXPECT_TRUE(looks_like("unsaved"));
}

TEST_F(AppSnapshot, EmptyScene) {
  start("", 1);
  EXPECT_TRUE(looks_like("empty"));
}

}  // namespace
}  // namespace brume
