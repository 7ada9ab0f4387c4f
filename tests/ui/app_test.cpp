// The application as a user works it: clicks, drags and keys, then the state and the picture.
#include <fstream>

#include "renderer/film/image_io.h"
#include "renderer/integrators/registry.h"
#include "renderer/scene_io/scene_file.h"
#include "tests/ui/app_fixture.h"

namespace brume {
namespace {

class App : public AppFixture {
 protected:
  // A small window: these tests look at what happens, not at how it looks.
  void start(const std::string& scene, int samples = 2) { AppFixture::start(scene, samples, 1000, 620); }
};

std::string scratch(const std::string& name) { return std::string(BRUME_TEST_OUTPUT_DIR) + "/" + name; }

TEST_F(App, OpensTheDefaultSceneAndShowsAPicture) {
  start(scene_path("smoke.json"));
  EXPECT_EQ(session().title(), "smoke.json");
  EXPECT_FALSE(session().modified());
  EXPECT_GT(brightness(), 0.001);
  EXPECT_TRUE(session().black_picture().empty()) << session().black_picture();
  EXPECT_EQ(session().picture()->statistics.rays.non_finite, 0u);
}

TEST_F(App, ChoosingTheDistanceSamplingChangesTheSceneAndRestartsThePicture) {
  start(scene_path("smoke.json"));
  const auto before = session().picture();
  ASSERT_TRUE(done(robot().choose("Inspector/Distance sampling", "Density")));
  settle();
  EXPECT_EQ(render().text("distance_sampling"), "density");
  EXPECT_EQ(session().scene()->render.distance_sampling, DistanceSampling::Density);
  EXPECT_GT(session().picture()->generation, before->generation);
  EXPECT_NE(session().picture()->image.pixels, before->image.pixels) << "other samples, other noise";
  EXPECT_TRUE(session().modified());
}

TEST_F(App, StepSizeLeavesAutoAtItsPresentValueAndFollowsTheDrag) {
  start(scene_path("smoke.json"));
  const float automatic = session().scene()->step_size;
  ASSERT_TRUE(done(robot().click("Inspector/Step size/auto")));
  settle();
  EXPECT_FLOAT_EQ(static_cast<float>(render().number("step_size")), automatic);
  const auto lookups = session().picture()->statistics.rays.march.segments;
  ASSERT_TRUE(done(robot().drag("Inspector/Step size", 0.3f, 0.9f)));
  settle();
  EXPECT_GT(render().number("step_size"), 4 * static_cast<double>(automatic));
  EXPECT_LT(session().picture()->statistics.rays.march.segments, lookups / 2) << "longer steps, fewer segments";
  // The whole drag is one step of the history, the switch another.
  session().undo();
  EXPECT_FLOAT_EQ(static_cast<float>(render().number("step_size")), automatic);
  session().undo();
  EXPECT_TRUE(render().is_auto("step_size"));
  EXPECT_FALSE(session().can_undo());
}

TEST_F(App, MoreBouncesMakeTheSmokeBrighter) {
  start(scene_path("smoke.json"), 4);
  const double before = brightness();
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "4")));
  settle();
  EXPECT_EQ(render().integer("bounces"), 4);
  EXPECT_GT(brightness(), 1.05 * before);
}

TEST_F(App, TypedValueBeyondTheHardRangeIsBroughtBackIntoIt) {
  start(scene_path("smoke.json"), 1);
  ASSERT_TRUE(done(robot().click("Scene/Camera")));
  ASSERT_TRUE(done(robot().type_into("Inspector/Field of view", "500")));
  settle();
  EXPECT_DOUBLE_EQ(camera().number("vfov_deg"), 179);
}

TEST_F(App, ResetButtonBringsTheDefaultBack) {
  start(scene_path("smoke.json"));
  ASSERT_EQ(render().integer("bounces"), 1);
  ASSERT_TRUE(done(robot().click("Inspector/Bounces/reset")));
  EXPECT_EQ(render().integer("bounces"), 0);
  EXPECT_FALSE(robot().exists("Inspector/Bounces/reset")) << "nothing to reset any more";
}

TEST_F(App, LeftDragOrbitsAtTheSameDistance) {
  start(scene_path("smoke.json"), 1);
  const Vec3d before = camera().vec3("position"), target = camera().vec3("look_at");
  ASSERT_TRUE(done(robot().drag_by("View/picture", 120, 40)));
  settle();
  const Vec3d after = camera().vec3("position");
  EXPECT_GT(length(after - before), 0.5);
  EXPECT_NEAR(length(after - target), length(before - target), 1e-9);
  EXPECT_EQ(camera().vec3("look_at"), target);
  EXPECT_GT(after.z, before.z) << "dragging down lifts the camera, as if one tilted the object";
  session().undo();
  EXPECT_EQ(camera().vec3("position"), before) << "one drag is one step of the history";
}

TEST_F(App, MiddleDragPansAndWheelDollies) {
  start(scene_path("smoke.json"), 1);
  const Vec3d offset = camera().vec3("position") - camera().vec3("look_at");
  ASSERT_TRUE(done(robot().drag_by("View/picture", 60, 0, ImGuiMouseButton_Middle)));
  EXPECT_NEAR(length((camera().vec3("position") - camera().vec3("look_at")) - offset), 0, 1e-9);
  ASSERT_TRUE(done(robot().wheel("View/picture", 3)));
  EXPECT_NEAR(length(camera().vec3("position") - camera().vec3("look_at")), length(offset) * std::pow(0.9, 3), 1e-6);
}

TEST_F(App, ExposureDoesNotRestartThePicture) {
  start(scene_path("smoke.json"));
  const auto before = session().picture();
  const auto shown_before = stage_->pixels();
  robot().press_key(ui::Key::E);
  robot().frames(3);
  EXPECT_EQ(session().picture(), before) << "the very same picture, only shown brighter";
  EXPECT_NE(stage_->pixels(), shown_before);
  EXPECT_DOUBLE_EQ(session().description().child("film").number("exposure"), 2.0);
}

TEST_F(App, LightsAreSwitchedAddedAndRemoved) {
  start(scene_path("smoke.json"));
  const double both = brightness();
  ASSERT_TRUE(done(robot().click("Scene/Lights/lamp/on")));
  settle();
  EXPECT_EQ(session().scene()->lights.size(), 1u);
  EXPECT_LT(brightness(), both);
  ASSERT_TRUE(done(robot().click("Scene/Lights/+")));
  ASSERT_TRUE(done(robot().click("Add light/Environment")));
  settle();
  EXPECT_EQ(session().scene()->lights.size(), 2u);
  EXPECT_TRUE(robot().exists("Inspector/Radiance/r")) << "the new light is selected";
  ASSERT_TRUE(done(robot().click("Scene/Lights/environment/x")));
  settle();
  EXPECT_EQ(session().scene()->lights.size(), 1u);
}

TEST_F(App, VolumeParametersComeFromTheTable) {
  start(scene_path("smoke.json"));
  ASSERT_TRUE(done(robot().click("Scene/Volumes/plume/plume")));
  const double before = brightness();
  ASSERT_TRUE(done(robot().type_into("Inspector/Density scale", "2")));
  settle();
  EXPECT_LT(brightness(), before) << "thin smoke scatters less";
  // Another grid of the same file, from the list of those it has.
  ASSERT_TRUE(done(robot().choose("Inspector/Density grid", "temperature")));
  settle();
  EXPECT_EQ(session().description().list("volumes")[0].text("grid"), "temperature");
  EXPECT_TRUE(session().problem().empty()) << session().problem();
  EXPECT_TRUE(done(robot().hover("Inspector/Density scale")));
  EXPECT_NE(robot().tooltip().find("1/world unit"), std::string::npos)
      << "the tooltip names the unit: " << robot().tooltip();
}

TEST_F(App, ChangingTheShaderKeepsWhatBothHave) {
  start(scene_path("smoke.json"));
  ASSERT_TRUE(done(robot().click("Scene/Volumes/plume/plume")));
  ASSERT_TRUE(done(robot().choose("Inspector/Shader", "Homogeneous")));
  settle();
  const Node& volume = session().description().list("volumes")[0];
  EXPECT_EQ(volume.kind(), "homogeneous");
  EXPECT_EQ(volume.text("name"), "plume");
  EXPECT_DOUBLE_EQ(volume.number("density_scale"), 20);
  EXPECT_DOUBLE_EQ(volume.child("phase").number("g"), 0.2);
}

TEST_F(App, BareGridFileIsFramedScaledAndLit) {
  start(scene_path("vdb/smoke_plume_96_f050.vdb"));
  EXPECT_TRUE(session().path().empty()) << "there is no scene file to overwrite";
  const Node& volume = session().description().list("volumes")[0];
  EXPECT_EQ(volume.text("grid"), "density");
  EXPECT_GT(volume.number("density_scale"), 1);
  EXPECT_GT(brightness(), 0.01);
  // The film is filled: the smoke covers a good part of the picture and leaves its border free.
  const Image& image = session().picture()->image;
  int lit = 0, border = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const bool on = max_channel(image.at(x, y)) > 0;
      lit += on;
      border += on && (x == 0 || y == 0 || x == image.width - 1 || y == image.height - 1);
    }
  EXPECT_GT(lit, image.width * image.height / 12);
  EXPECT_EQ(border, 0);
}

TEST_F(App, DroppedFileReplacesTheSceneAfterTheQuestion) {
  start(scene_path("fog.json"), 1);
  ASSERT_TRUE(done(robot().choose("Inspector/Sampler", "Independent")));
  window_->drop({scene_path("smoke.json")});
  robot().frames(2);
  ASSERT_TRUE(robot().exists("Unsaved changes/Discard")) << "the change must not be lost unasked";
  EXPECT_EQ(session().title(), "fog.json");
  ASSERT_TRUE(done(robot().click("Unsaved changes/Discard")));
  settle();
  EXPECT_EQ(session().title(), "smoke.json");
}

TEST_F(App, BadFileIsReportedAndLeavesTheSceneAlone) {
  const std::string path = scratch("broken.json");
  std::ofstream(path) << "{\"brume\": 1, \"render\": {\"step_sise\": 0.1}}";
  start(scene_path("fog.json"), 1);
  window_->drop({path});
  settle();
  EXPECT_EQ(session().title(), "fog.json");
  ASSERT_FALSE(session().messages().empty());
  const Session::Message& last = session().messages().back();
  EXPECT_EQ(last.level, LogLevel::Error);
  EXPECT_NE(last.text.find("step_sise"), std::string::npos) << last.text;
  EXPECT_NE(last.text.find("step_size"), std::string::npos) << "the right word is named: " << last.text;
  EXPECT_TRUE(session().problem().empty());
}

TEST_F(App, SaveAsWritesASceneThatOpensToTheSameDescription) {
  start(scene_path("smoke.json"), 1);
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "3")));
  const std::string path = scratch("saved.json");
  std::filesystem::remove(path);
  robot().press_key(ui::Key::S, {.ctrl = true, .shift = true});
  robot().frames(2);
  ASSERT_TRUE(done(robot().type_into("Save as/path", path)));
  if (robot().exists("Save as/Save")) ASSERT_TRUE(done(robot().click("Save as/Save")));
  robot().frames(2);
  EXPECT_FALSE(session().modified());
  EXPECT_EQ(session().title(), "saved.json");
  const auto read = read_scene_file(path, scene_family());
  ASSERT_TRUE(read.ok()) << read.error().to_string();
  EXPECT_TRUE(*read == session().description());
}

TEST_F(App, ExportedPictureBringsItsSceneBack) {
  start(scene_path("fog.json"), 2);
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "1")));
  settle();
  const std::string path = scratch("exported.png");
  ASSERT_TRUE(session().export_picture(path).ok());
  const Node edited = session().description();
  session().open(scene_path("smoke.json"));
  settle();
  session().open(path);
  settle();
  EXPECT_TRUE(session().description() == edited);
}

TEST_F(App, UndoAndRedoWalkTheHistory) {
  start(scene_path("fog.json"), 1);
  const Node original = session().description();
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "5")));
  ASSERT_TRUE(done(robot().choose("Inspector/MIS heuristic", "Balance")));
  const Node edited = session().description();
  robot().press_key(ui::Key::Z, {.ctrl = true});
  robot().press_key(ui::Key::Z, {.ctrl = true});
  EXPECT_TRUE(session().description() == original);
  EXPECT_FALSE(session().modified()) << "back at what was opened";
  robot().press_key(ui::Key::Z, {.ctrl = true, .shift = true});
  robot().press_key(ui::Key::Z, {.ctrl = true, .shift = true});
  EXPECT_TRUE(session().description() == edited);
}

TEST_F(App, QuitAsksOnlyWhenSomethingWouldBeLost) {
  start(scene_path("fog.json"), 1);
  window_->request_quit();
  EXPECT_TRUE(window_->may_quit());
  TearDown();
  start(scene_path("fog.json"), 1);
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "5")));
  window_->request_quit();
  robot().frames(2);
  EXPECT_FALSE(window_->may_quit());
  ASSERT_TRUE(done(robot().click("Unsaved changes/Cancel")));
  EXPECT_FALSE(window_->may_quit());
  window_->request_quit();
  robot().frames(2);
  ASSERT_TRUE(done(robot().click("Unsaved changes/Discard")));
  EXPECT_TRUE(window_->may_quit());
}

TEST_F(App, BlackPictureIsExplainedInPlainWords) {
  start(scene_path("smoke.json"), 1);
  ASSERT_TRUE(done(robot().click("Scene/Volumes/plume/plume")));
  ASSERT_TRUE(done(robot().type_into("Inspector/Density scale", "0.001")));
  settle();
  EXPECT_NE(session().black_picture().find("raise density_scale"), std::string::npos) << session().black_picture();
  ASSERT_TRUE(done(robot().type_into("Inspector/Density scale", "20")));
  ASSERT_TRUE(done(robot().click("Scene/Lights/lamp/on")));
  ASSERT_TRUE(done(robot().click("Scene/Lights/window/on")));
  settle();
  EXPECT_NE(session().black_picture().find("light"), std::string::npos) << session().black_picture();
}

TEST_F(App, DescriptionThatCannotRenderKeepsTheLastPicture) {
  start(scene_path("fog.json"), 1);
  const auto before = session().picture();
  // A camera that looks at itself.
  session().change([](Node& d) { ASSERT_TRUE(d.child("camera").set("look_at", Numbers{0, -6, 0.4}).ok()); });
  settle();
  EXPECT_NE(session().problem().find("camera.look_at"), std::string::npos) << session().problem();
  EXPECT_EQ(session().picture(), before);
  session().undo();
  settle();
  EXPECT_TRUE(session().problem().empty());
}

TEST_F(App, PauseKeepsTheSamplesAndGoesOn) {
  start(scene_path("fog.json"), kEndless);
  robot().press_key(ui::Key::Space);
  EXPECT_TRUE(session().paused());
  // The pass under way ends first, which takes as long as the machine is busy.
  auto held = session().picture();
  for (int i = 0; i < 60; ++i) {
    std::this_thread::sleep_for(std::chrono::seconds(1));
    if (session().picture() == held) break;
    held = session().picture();
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_EQ(session().picture(), held);
  robot().press_key(ui::Key::Space);
  for (int i = 0; i < 2000 && session().picture() == held; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_NE(session().picture(), held);
  EXPECT_GT(session().picture()->statistics.samples_per_pixel, held->statistics.samples_per_pixel);
}

TEST_F(App, TabLeavesThePictureAlone) {
  start(scene_path("fog.json"), 1);
  robot().press_key(ui::Key::Tab);
  settle();
  EXPECT_FALSE(robot().exists("Inspector/Bounces"));
  EXPECT_GT(session().picture()->width, 700);
}

}  // namespace
}  // namespace brume
