// A pixel probed, and takes kept and restored, as a user does it.
#include "tests/ui/app_fixture.h"

namespace brume {
namespace {

using ui::Key;

class ProbeUi : public AppFixture {
 protected:
  void start(int samples = 4) { AppFixture::start(scene_path("smoke.json"), samples, 900, 600); }

  /// Frames until the probe is of that many samples.
  std::shared_ptr<const PixelProbe> wait_for_probe() {
    for (int i = 0; i < 5000; ++i) {
      robot().frames(1);
      const auto p = session().probe();
      if (p && session().finished()) return p;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return nullptr;
  }
};

TEST_F(ProbeUi, AKeyProbesAPixelAndAClickChoosesAnother) {
  start();
  EXPECT_FALSE(session().probe());
  robot().press_key(Key::P);
  EXPECT_TRUE(robot().exists("Probe/along the ray"));
  const auto middle = wait_for_probe();
  ASSERT_TRUE(middle);
  settle();  // the picture has become smaller
  const auto picture = session().picture();
  EXPECT_EQ(wait_for_probe()->place,
            (PixelPlace{picture->width / 2, picture->height / 2, picture->width, picture->height}));

  const Node before = camera();
  ASSERT_TRUE(done(robot().click_at("View/picture", 0.25f, 0.75f)));
  const auto chosen = wait_for_probe();
  ASSERT_TRUE(chosen);
  EXPECT_NEAR(chosen->place.x, 0.25 * picture->width, 2);
  EXPECT_NEAR(chosen->place.y, 0.75 * picture->height, 2);
  EXPECT_EQ(camera(), before) << "a click is no drag";

  ASSERT_TRUE(done(robot().drag_by("View/picture", 40, 0)));
  EXPECT_NE(camera(), before) << "a drag still orbits";

  robot().press_key(Key::P);
  EXPECT_FALSE(robot().exists("Probe/along the ray"));
  EXPECT_FALSE(session().probe());
}

TEST_F(ProbeUi, TheProbeFollowsAnEdit) {
  start();
  robot().press_key(Key::P);
  settle();
  const auto before = wait_for_probe();
  ASSERT_TRUE(before);
  session().change([](Node& d) { static_cast<void>(d.list("volumes")[0].set("density_scale", 1.0).ok()); });
  settle();
  const auto after = wait_for_probe();
  ASSERT_TRUE(after);
  EXPECT_LT(after->optical_depth.r, 0.5f * before->optical_depth.r);
}

TEST_F(ProbeUi, AClickOnATileProbesThatVariant) {
  start();
  robot().press_key(Key::V);
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "0")));
  robot().press_key(Key::P);
  settle();
  ASSERT_TRUE(done(robot().click_at("View/picture " + session().shown()[1].variant.name, 0.5f, 0.5f)));
  const auto second = wait_for_probe();
  ASSERT_TRUE(second);
  const auto picture = session().picture(1);
  EXPECT_NEAR(second->place.x, picture->width / 2, 2);
  ASSERT_TRUE(done(robot().click_at("View/picture " + session().shown()[0].variant.name, 0.5f, 0.5f)));
  const auto first = wait_for_probe();
  ASSERT_TRUE(first);
  EXPECT_GT(first->radiance.r, second->radiance.r) << "one bounce is brighter than none";
}

TEST_F(ProbeUi, ATakeBringsBackItsScene) {
  start(1);
  const Node kept = session().description();
  robot().press_key(Key::T);
  ASSERT_EQ(session().takes().size(), 1u);
  EXPECT_EQ(session().takes()[0].picture, session().picture());
  ASSERT_TRUE(robot().exists("Takes/take 1"));

  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "0")));
  settle();
  robot().press_key(Key::T);
  ASSERT_EQ(session().takes().size(), 2u);
  const Node edited = session().description();
  ASSERT_NE(edited, kept);

  ASSERT_TRUE(done(robot().click("Takes/take 1")));
  EXPECT_EQ(session().description(), kept);
  robot().press_key(Key::Z, {.ctrl = true});
  EXPECT_EQ(session().description(), edited) << "restoring is a step that can be undone";

  ASSERT_TRUE(done(robot().right_click("Takes/take 1")));
  ASSERT_TRUE(done(robot().click("take 1/Remove")));
  ASSERT_EQ(session().takes().size(), 1u);
  EXPECT_EQ(session().takes()[0].number, 2);
}

TEST_F(ProbeUi, ATakeCanBeExportedAndDroppedBackIn) {
  start(1);
  const Node kept = session().description();
  robot().press_key(Key::T);
  session().change([](Node& d) { static_cast<void>(d.list("volumes")[0].set("density_scale", 1.0).ok()); });
  settle();
  ASSERT_TRUE(done(robot().right_click("Takes/take 1")));
  ASSERT_TRUE(done(robot().click("take 1/Export...")));
  const std::string path = testing::TempDir() + "/take.exr";
  std::filesystem::remove(path);
  ASSERT_TRUE(done(robot().type_into("Export take/path", path)));
  robot().frames(2);
  ASSERT_TRUE(std::filesystem::exists(path));
  session().open(path);
  settle();
  EXPECT_EQ(session().description().list("volumes")[0].number("density_scale"),
            kept.list("volumes")[0].number("density_scale"));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace brume
