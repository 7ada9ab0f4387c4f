// Variants as a user works with them: made, edited, and looked at in every way.
#include <algorithm>

#include "app/headless/synthetic_input.h"
#include "renderer/analysis/difference.h"
#include "renderer/film/film.h"
#include "renderer/scene/scene_cache.h"
#include "tests/ui/app_fixture.h"

namespace brume {

void PrintTo(const Setting& setting, std::ostream* out) { *out << setting.path << " = " << setting.value; }

namespace {

using ui::Key;

/// The screen, row 0 at the top.
struct Screen {
  std::vector<std::uint8_t> rgba;
  int width = 0;

  std::array<std::uint8_t, 3> at(int x, int y) const {
    const std::size_t i =
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {rgba[i], rgba[i + 1], rgba[i + 2]};
  }
};

/// Whole pixels, the ends excluded.
struct Area {
  int x0, y0, x1, y1;

  int count() const { return (x1 - x0) * (y1 - y0); }
};

int count_differing(const Screen& a, const Screen& b, const Area& area, int dx = 0, int dy = 0) {
  int differing = 0;
  for (int y = area.y0; y < area.y1; ++y)
    for (int x = area.x0; x < area.x1; ++x) differing += a.at(x, y) != b.at(x + dx, y + dy);
  return differing;
}

class CompareUi : public AppFixture {
 protected:
  void start(int samples = 1) { AppFixture::start(scene_path("smoke.json"), samples, 900, 600); }

  std::span<const Node> variants() { return session().description().child("compare").list("variants"); }
  Settings settings_of(std::size_t variant) { return variants()[variant].settings("set"); }

  /// A is the scene, B has no bounces and is the one that the inspector edits.
  void make_two() {
    robot().press_key(Key::V);
    ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "0")));
    settle();
    ASSERT_EQ(session().shown().size(), 2u);
    ASSERT_NE(session().picture(0)->image.pixels, session().picture(1)->image.pixels);
  }

  /// The mouse rests on the picture, so that no help covers any of it.
  Screen screen() {
    stage_->make_current();
    const ui::ItemRect view = rect_of("View");
    synthetic_input::move_mouse({std::floor(view.center().x), std::floor(view.center().y)});
    robot().frames(2);
    return {stage_->pixels(), stage_->width()};
  }
  /// Shows them by a key and takes what is then on the screen.
  Screen screen_of(Key key) {
    robot().press_key(key);
    return screen();
  }

  ui::ItemRect rect_of(const std::string& label) {
    const ui::ItemRecord* item = robot().last_drawn(label);
    EXPECT_TRUE(item) << label;
    return item ? item->rect : ui::ItemRect();
  }
  /// The inner part of the one picture, without what is written along its upper and lower edge.
  Area inner_picture() {
    const ui::ItemRect r = rect_of("View/picture");
    constexpr int kWritten = 60;
    return {static_cast<int>(r.min.x) + 1, static_cast<int>(r.min.y) + kWritten, static_cast<int>(r.max.x) - 1,
            static_cast<int>(r.max.y) - kWritten};
  }

  Result<void> ctrl_wheel(const std::string& label, float notches) {
    hold({.ctrl = true});
    const auto turned = robot().wheel(label, notches);
    hold({});
    return turned;
  }
  Result<void> ctrl_drag(const std::string& label, float dx, float dy) {
    hold({.ctrl = true});
    const auto dragged = robot().drag_by(label, dx, dy);
    hold({});
    return dragged;
  }

  /// Takes what is drawn under the first label and lets it fall on the second.
  Result<void> drag_onto(const std::string& label, const std::string& target) {
    const ImVec2 from = rect_of(label).center(), to = rect_of(target).center();
    if (const auto pressed = robot().press(label, 0.5f, 0.5f); !pressed) return pressed;
    robot().move_by(to.x - from.x, to.y - from.y);
    robot().release();
    return {};
  }

 private:
  void hold(ui::Mods mods) {
    stage_->make_current();
    synthetic_input::set_mods(mods);
    robot().frames(1);
  }
};

// --- Making variants

TEST_F(CompareUi, FirstDuplicateMakesTheSceneAndItsCopyInOneStep) {
  start();
  robot().press_key(Key::V);
  settle();
  ASSERT_EQ(variants().size(), 2u);
  ASSERT_EQ(session().shown().size(), 2u);
  EXPECT_EQ(session().shown()[0].variant.name, "A");
  EXPECT_EQ(session().shown()[1].variant.name, "B");
  EXPECT_TRUE(robot().visible("View/picture A"));
  EXPECT_TRUE(robot().visible("View/picture B"));
  session().undo();
  settle();
  EXPECT_TRUE(variants().empty());
  EXPECT_FALSE(session().can_undo());
  EXPECT_TRUE(robot().visible("View/picture"));
}

TEST_F(CompareUi, ButtonDuplicatesUpToFourAndIsThenGone) {
  start();
  for (const std::size_t count : {2u, 3u, 4u}) {
    ASSERT_TRUE(done(robot().click("Scene/Compare/Duplicate as variant")));
    EXPECT_EQ(variants().size(), count);
  }
  EXPECT_FALSE(robot().exists("Scene/Compare/Duplicate as variant"));
  settle();
  EXPECT_EQ(session().shown().size(), 4u);
  EXPECT_TRUE(robot().visible("View/picture D"));
}

TEST_F(CompareUi, KeyThatCanAddNoFifthLeavesTheEditedVariantSelected) {
  start();
  for (int i = 0; i < 4; ++i) robot().press_key(Key::V);
  EXPECT_EQ(variants().size(), 4u);
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "0")));
  EXPECT_EQ(settings_of(3), (Settings{{"render.bounces", "0"}}));
  EXPECT_EQ(render().integer("bounces"), 1) << "nobody asked to edit the scene";
}

TEST_F(CompareUi, DuplicateOfAVariantHasItsSettings) {
  start();
  make_two();
  robot().press_key(Key::V);
  settle();
  ASSERT_EQ(variants().size(), 3u);
  EXPECT_EQ(settings_of(2), settings_of(1));
  EXPECT_EQ(session().picture(2)->image.pixels, session().picture(1)->image.pixels);
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "2")));
  EXPECT_EQ(settings_of(2), (Settings{{"render.bounces", "2"}})) << "the new one is edited";
  EXPECT_EQ(settings_of(1), (Settings{{"render.bounces", "0"}}));
}

TEST_F(CompareUi, RemovingAVariantKeepsTheOthersPicture) {
  start();
  make_two();
  const auto kept = session().picture(1);
  ASSERT_TRUE(done(robot().click("Scene/Compare/A/x")));
  settle();
  ASSERT_EQ(variants().size(), 1u);
  EXPECT_EQ(settings_of(0), (Settings{{"render.bounces", "0"}}));
  EXPECT_EQ(session().picture(0), kept);
  session().undo();
  settle();
  ASSERT_EQ(session().shown().size(), 2u);
  EXPECT_EQ(session().picture(1), kept);
}

TEST_F(CompareUi, VariantThatIsOffIsNotRenderedAndTheOtherKeepsItsPicture) {
  start();
  make_two();
  const auto kept = session().picture(1);
  ASSERT_TRUE(done(robot().click("Scene/Compare/A/on")));
  settle();
  ASSERT_EQ(session().shown().size(), 1u);
  EXPECT_EQ(session().shown()[0].variant.name, "B");
  EXPECT_EQ(session().picture(0), kept);
  EXPECT_TRUE(robot().visible("View/picture")) << "one picture has all the room";
  // Its settings are still edited where they are, second in the list although first on the screen.
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "2")));
  EXPECT_EQ(settings_of(1), (Settings{{"render.bounces", "2"}}));
  settle();
  const auto edited = session().picture(0);
  ASSERT_TRUE(done(robot().click("Scene/Compare/A/on")));
  settle();
  ASSERT_EQ(session().shown().size(), 2u);
  EXPECT_EQ(session().picture(1), edited);
}

// --- Editing them

TEST_F(CompareUi, EditsOfASelectedVariantAreItsSettingsAndTheSceneStaysAsItIs) {
  start();
  make_two();
  EXPECT_EQ(settings_of(1), (Settings{{"render.bounces", "0"}}));
  EXPECT_TRUE(settings_of(0).empty());
  EXPECT_EQ(render().integer("bounces"), 1);
  EXPECT_FALSE(robot().exists("Inspector/Samples/reset"));
  ASSERT_TRUE(done(robot().hover("Inspector/Bounces/reset")));
  EXPECT_EQ(robot().tooltip(), "As in the scene again");
  ASSERT_TRUE(done(robot().click("Inspector/Bounces/reset")));
  EXPECT_TRUE(settings_of(1).empty());
  EXPECT_EQ(render().integer("bounces"), 1) << "not the default, 0";
  EXPECT_FALSE(robot().exists("Inspector/Bounces/reset"));
  ASSERT_TRUE(done(robot().choose("Inspector/Integrator", "Delta tracking")));
  EXPECT_EQ(settings_of(1), (Settings{{"render.integrator", "delta_tracking"}}));
  EXPECT_EQ(render().kind(), "decoupled");
}

TEST_F(CompareUi, ClickingTheSelectedVariantEditsTheSceneAgain) {
  start();
  make_two();
  ASSERT_TRUE(done(robot().click("Scene/Compare/B/B")));
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "2")));
  EXPECT_EQ(render().integer("bounces"), 2);
  EXPECT_EQ(settings_of(1), (Settings{{"render.bounces", "0"}}));
  ASSERT_TRUE(done(robot().click("Scene/Compare/A/A")));
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "3")));
  EXPECT_EQ(settings_of(0), (Settings{{"render.bounces", "3"}}));
  EXPECT_EQ(render().integer("bounces"), 2);
}

TEST_F(CompareUi, ButtonBesideASettingTakesItBack) {
  start();
  make_two();
  ASSERT_TRUE(done(robot().click("Scene/Compare/B/render.bounces/x")));
  EXPECT_TRUE(settings_of(1).empty());
  settle();
  EXPECT_EQ(session().picture(1)->image.pixels, session().picture(0)->image.pixels);
}

TEST_F(CompareUi, CameraFilmAndSeedAreThoseOfTheSceneWhicheverVariantIsSelected) {
  start();
  make_two();
  const Settings before = settings_of(1);
  ASSERT_TRUE(done(robot().scroll_to("Inspector/Seed")));
  ASSERT_TRUE(done(robot().type_into("Inspector/Seed", "7")));
  EXPECT_EQ(render().integer("seed"), 7);
  ASSERT_TRUE(done(robot().click("Scene/Camera")));
  ASSERT_TRUE(done(robot().type_into("Inspector/Field of view", "50")));
  EXPECT_DOUBLE_EQ(camera().number("vfov_deg"), 50);
  ASSERT_TRUE(done(robot().click("Scene/Film")));
  ASSERT_TRUE(done(robot().type_into("Inspector/Exposure", "2")));
  EXPECT_DOUBLE_EQ(session().description().child("film").number("exposure"), 2);
  EXPECT_EQ(settings_of(1), before);
  EXPECT_FALSE(robot().exists("Inspector/Exposure/name")) << "it cannot be dragged onto a variant either";
}

TEST_F(CompareUi, ANameDraggedOntoAVariantBecomesItsSettingWithTheScenesValue) {
  start();
  make_two();
  ASSERT_TRUE(done(drag_onto("Inspector/Bounces/name", "Scene/Compare/A/A")));
  EXPECT_EQ(settings_of(0), (Settings{{"render.bounces", "1"}})) << "the scene's value, not that of B, which is shown";
  ASSERT_TRUE(done(drag_onto("Inspector/Integrator/name", "Scene/Compare/A/A")));
  EXPECT_EQ(settings_of(0), (Settings{{"render.bounces", "1"}, {"render.integrator", "decoupled"}}));
  session().undo();
  EXPECT_EQ(settings_of(0), (Settings{{"render.bounces", "1"}})) << "a drag is a step of the history";
  ASSERT_TRUE(done(robot().click("Scene/Volumes/plume/plume")));
  ASSERT_TRUE(done(drag_onto("Inspector/Shader/name", "Scene/Compare/A/A")));
  EXPECT_EQ(settings_of(0), (Settings{{"render.bounces", "1"}, {"volumes.plume.shader", "vdb"}}));
}

TEST_F(CompareUi, PartsThatOnlyTheVariantsKindHasCanBeEdited) {
  start();
  make_two();
  ASSERT_TRUE(done(robot().click("Scene/Volumes/plume/plume")));
  ASSERT_TRUE(done(robot().choose("Inspector/Shader", "Homogeneous")));
  settle();
  ASSERT_EQ(session().problem(), "");
  // Grids of a file bring their own bounds: the scene's volume has no such part.
  ASSERT_TRUE(done(robot().scroll_to("Inspector/Bounds/Type")));
  ASSERT_TRUE(done(robot().choose("Inspector/Bounds/Type", "Sphere")));
  settle();
  EXPECT_EQ(session().problem(), "");
  EXPECT_EQ(settings_of(1).back(), (Setting{"volumes.plume.bounds.type", "sphere"}));
  EXPECT_EQ(session().description().list("volumes")[0].kind(), "vdb");
}

TEST_F(CompareUi, FileChosenForAVariantIsThatOfTheVariant) {
  start();
  make_two();
  const std::string scenes_file = session().description().list("volumes")[0].text("file");
  const std::string chosen = scene_path("vdb/fire_80_f036.vdb");
  ASSERT_TRUE(done(robot().click("Scene/Volumes/plume/plume")));
  ASSERT_TRUE(done(robot().click("Inspector/smoke_plume_96_f050.vdb")));
  ASSERT_TRUE(done(robot().type_into("Choose grid file/path", chosen)));
  if (robot().exists("Choose grid file/Open")) ASSERT_TRUE(done(robot().click("Choose grid file/Open")));
  settle();
  EXPECT_EQ(settings_of(1).back(), (Setting{"volumes.plume.file", chosen}));
  EXPECT_EQ(session().description().list("volumes")[0].text("file"), scenes_file);
  EXPECT_EQ(session().problem(), "");
}

TEST_F(CompareUi, ReferenceIsChosenAmongPictures) {
  start();
  ASSERT_TRUE(done(robot().click("Scene/Compare")));
  ASSERT_TRUE(done(robot().click("Inspector/choose...")));
  const std::string path = std::string(BRUME_TEST_OUTPUT_DIR) + "/reference.exr";
  ASSERT_TRUE(session().export_picture(path).ok());
  ASSERT_TRUE(done(robot().type_into("Choose reference/path", path)));
  if (robot().exists("Choose reference/Open")) ASSERT_TRUE(done(robot().click("Choose reference/Open")));
  EXPECT_EQ(session().description().child("compare").text("reference"), path);
}

// --- Their pictures

TEST_F(CompareUi, EachPictureIsBitForBitThatOfItsSceneRenderedAlone) {
  start(2);
  make_two();
  robot().press_key(Key::V);
  ASSERT_TRUE(done(robot().choose("Inspector/Distance sampling", "Density")));
  settle();
  const auto made = variants_of(session().description());
  ASSERT_TRUE(made.ok());
  ASSERT_EQ(made->size(), 3u);
  WorkerPool pool(2);
  SceneCache cache;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto scene = commit((*made)[i].description, cache, {});
    ASSERT_TRUE(scene.ok()) << scene.error().to_string();
    const auto picture = session().picture(i);
    Film film(picture->width, picture->height);
    render_batch(**scene, 2, film, pool);
    EXPECT_EQ(picture->image.pixels, film.mean_image().pixels) << "variant " << (*made)[i].name;
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_NE(picture->image.pixels, session().picture(j)->image.pixels) << "or the test shows nothing";
  }
}

TEST_F(CompareUi, EditOfOneVariantLeavesTheOtherItsVeryPicture) {
  start();
  make_two();
  const auto a = session().picture(0), b = session().picture(1);
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "2")));
  settle();
  EXPECT_EQ(session().picture(0), a);
  EXPECT_NE(session().picture(1)->image.pixels, b->image.pixels);
}

TEST_F(CompareUi, PicturesOfScenesThatDifferAreNeverTakenForOneAnother) {
  start();
  // Both differ from what is there, so that one edit commits both.
  session().change([](Node& d) {
    std::vector<Node>& list = d.child("compare").list("variants");
    list.resize(2, Node(*compare_family().tables.front()->find_slot("variants")->family->tables.front()));
    set_in_variant(d, 0, "render.bounces", "0");
    set_in_variant(d, 1, "render.bounces", "2");
  });
  settle();
  ASSERT_EQ(session().shown().size(), 2u);
  EXPECT_NE(session().scene(0)->generation, session().scene(1)->generation)
      << "by which a picture is known to be up to date when the one before it in the list is switched off";
}

TEST_F(CompareUi, SettingThatCannotBeIsAProblemThatLosesNothing) {
  start();
  make_two();
  const auto a = session().picture(0), b = session().picture(1);
  session().change([](Node& d) { set_in_variant(d, 1, "render.stp_size", "0.1"); });
  session().close_step();
  settle();
  EXPECT_NE(session().problem().find("compare.variants.1.set"), std::string::npos) << session().problem();
  EXPECT_NE(session().problem().find("stp_size"), std::string::npos) << session().problem();
  EXPECT_EQ(session().shown().size(), 2u);
  EXPECT_EQ(session().picture(0), a);
  EXPECT_EQ(session().picture(1), b);
  EXPECT_EQ(settings_of(1), (Settings{{"render.bounces", "0"}, {"render.stp_size", "0.1"}}));
  ASSERT_TRUE(done(robot().click("Scene/Compare/B/render.stp_size/x")));
  settle();
  EXPECT_EQ(session().problem(), "");
  EXPECT_EQ(session().picture(0), a);
  EXPECT_EQ(session().picture(1), b);
  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "2")));
  settle();
  EXPECT_NE(session().picture(1), b) << "the app goes on";
}

// --- Looking at them

TEST_F(CompareUi, TapOnANumberShowsThatVariantAndSShowsAll) {
  start();
  make_two();
  const Screen first = screen_of(Key::Num1), second = screen_of(Key::Num2);
  ASSERT_TRUE(robot().exists("View/picture"));
  EXPECT_FALSE(robot().exists("View/picture A"));
  EXPECT_GT(count_differing(first, second, inner_picture()), inner_picture().count() / 20);
  robot().press_key(Key::Num3);
  robot().frames(60);
  EXPECT_EQ(screen().rgba, second.rgba) << "there is no third";
  robot().press_key(Key::S);
  EXPECT_TRUE(robot().exists("View/picture A"));
  EXPECT_TRUE(robot().exists("View/picture B"));
  EXPECT_FALSE(robot().exists("View/picture"));
}

TEST_F(CompareUi, NumberPressedBeforeThereAreVariantsHidesNoneLater) {
  start();
  robot().press_key(Key::Num1);
  robot().press_key(Key::V);
  settle();
  EXPECT_TRUE(robot().exists("View/picture A"));
  EXPECT_TRUE(robot().exists("View/picture B"));
}

TEST_F(CompareUi, NumberThatIsHeldShowsItsVariantUntilItIsLetGo) {
  start();
  make_two();
  const Screen first = screen_of(Key::Num1), second = screen_of(Key::Num2);
  robot().hold_key(Key::Num1);
  robot().frames(30);  // half a second
  EXPECT_EQ(screen().rgba, first.rgba);
  robot().release_key(Key::Num1);
  robot().frames(1);
  EXPECT_EQ(screen().rgba, second.rgba);
  robot().press_key(Key::W);
  robot().hold_key(Key::Num1);
  robot().frames(30);
  EXPECT_FALSE(robot().exists("View/wipe line"));
  robot().release_key(Key::Num1);
  robot().frames(1);
  EXPECT_TRUE(robot().exists("View/wipe line"));
}

TEST_F(CompareUi, NumbersHeldOneAfterTheOtherGoBackToWhatWasThereFirst) {
  start();
  make_two();
  ASSERT_TRUE(robot().exists("View/picture A"));
  robot().hold_key(Key::Num1);
  robot().frames(30);
  robot().hold_key(Key::Num2);
  robot().frames(30);
  robot().release_key(Key::Num1);
  robot().frames(5);
  robot().release_key(Key::Num2);
  robot().frames(1);
  EXPECT_TRUE(robot().exists("View/picture A"));
}

TEST_F(CompareUi, ZoomMadeWhileANumberIsHeldStays) {
  start();
  make_two();
  const Screen all = screen_of(Key::Num2);
  robot().hold_key(Key::Num1);
  ASSERT_TRUE(done(ctrl_wheel("View/picture", 4)));
  robot().frames(30);
  robot().release_key(Key::Num1);
  EXPECT_NE(screen().rgba, all.rgba);
  EXPECT_EQ(screen_of(Key::Z).rgba, all.rgba) << "of the second, which was shown before";
}

TEST_F(CompareUi, WipeShowsOneVariantLeftAndTheOtherRightOfTheLine) {
  start();
  make_two();
  const Screen left = screen_of(Key::Num1), right = screen_of(Key::Num2);
  const Area whole = inner_picture();
  robot().press_key(Key::Num1);
  const Screen both = screen_of(Key::W);
  ASSERT_TRUE(robot().exists("View/wipe line"));
  const ui::ItemRect line = rect_of("View/wipe line");
  Area l = whole, r = whole;
  l.x1 = static_cast<int>(line.min.x) - 1;
  r.x0 = static_cast<int>(line.max.x) + 1;
  ASSERT_GT(l.count(), 1000);
  ASSERT_GT(r.count(), 1000);
  EXPECT_EQ(count_differing(both, left, l), 0);
  EXPECT_EQ(count_differing(both, right, r), 0);
  EXPECT_GT(count_differing(both, right, l), 0) << "or the test shows nothing";
  EXPECT_GT(count_differing(both, left, r), 0);
}

TEST_F(CompareUi, WipeLineIsDraggedAndKeepsItsPlaceInThePictureWhenZoomed) {
  start();
  make_two();
  robot().press_key(Key::W);
  robot().frames(1);
  const Vec3d position = camera().vec3("position");
  const ui::ItemRect picture = rect_of("View/picture");
  const float before = rect_of("View/wipe line").center().x;
  EXPECT_NEAR(before, picture.center().x, 1);
  ASSERT_TRUE(done(robot().drag_by("View/wipe line", -40, 15)));
  const float after = rect_of("View/wipe line").center().x;
  EXPECT_NEAR(after, before - 40, 1);
  EXPECT_EQ(camera().vec3("position"), position);
  ASSERT_TRUE(done(ctrl_wheel("View/picture", 2)));
  const float middle = std::floor(picture.center().x);
  EXPECT_NEAR(rect_of("View/wipe line").center().x, middle + (after - middle) * 1.25f * 1.25f, 1);
}

TEST_F(CompareUi, WipeLineDraggedPastTheEdgeCanBeDraggedBack) {
  start();
  make_two();
  robot().press_key(Key::W);
  robot().frames(1);
  const ui::ItemRect picture = rect_of("View/picture");
  const float width = picture.max.x - picture.min.x;
  // The hand turns back beyond the edge, with the button still down.
  ASSERT_TRUE(done(robot().press("View/wipe line", 0.5f, 0.5f)));
  robot().move_by(-width, 0);
  robot().move_by(width - 30, 0);
  robot().release();
  ASSERT_TRUE(robot().exists("View/wipe line"));
  EXPECT_NEAR(rect_of("View/wipe line").center().x, picture.center().x - 30, 2);
  // It lets go beyond the edge, also of a part of the picture.
  ASSERT_TRUE(done(robot().drag_by("View/wipe line", width, 0)));
  ASSERT_TRUE(robot().exists("View/wipe line"));
  ASSERT_TRUE(done(robot().press("View/wipe line", 0.25f, 0.25f)));
  robot().move_by(-width / 2, 0);
  robot().release();
  EXPECT_NEAR(rect_of("View/wipe line").center().x, picture.center().x, 8);
  ASSERT_TRUE(done(ctrl_wheel("View/picture", 4)));
  ASSERT_TRUE(done(robot().drag_by("View/wipe line", -width, 0)));
  EXPECT_TRUE(robot().exists("View/wipe line"));
}

TEST_F(CompareUi, DifferenceOfEqualPicturesHasTheColourOfZeroAndALegend) {
  start();
  robot().press_key(Key::V);
  settle();
  robot().press_key(Key::D);
  robot().frames(2);
  const Area inner = inner_picture();
  const auto count_of = [](const Screen& s, const Area& area, std::array<std::uint8_t, 3> color) {
    int count = 0;
    for (int y = area.y0; y < area.y1; ++y)
      for (int x = area.x0; x < area.x1; ++x) count += s.at(x, y) == color;
    return count;
  };
  Area lower = inner;
  lower.y0 = inner.y1, lower.y1 = static_cast<int>(rect_of("View/picture").max.y);
  const auto lowest = difference_color(2 * (0.5 / 64) - 1, DifferenceKind::Signed);
  EXPECT_EQ(count_of(screen(), inner, {0, 0, 0}), inner.count());
  EXPECT_GT(count_of(screen(), lower, lowest), 10) << "the legend's lowest colour";

  ASSERT_TRUE(done(robot().click("Menu/Compare")));
  ASSERT_TRUE(done(robot().click("Menu/Compare/Absolute")));
  robot().frames(2);
  const auto zero = difference_color(0, DifferenceKind::Absolute);
  EXPECT_EQ(count_of(screen(), inner, zero), inner.count());

  ASSERT_TRUE(done(robot().type_into("Inspector/Bounces", "0")));
  settle();
  EXPECT_LT(count_of(screen(), inner, zero), inner.count() * 9 / 10) << "and of others it has not";
}

TEST_F(CompareUi, ZoomAndPanLeaveTheSceneAndItsPicturesAlone) {
  start();
  make_two();
  const Node before = session().description();
  const auto a = session().picture(0), b = session().picture(1);
  const Screen all = screen_of(Key::Num1);
  const Area inner = inner_picture();
  ASSERT_TRUE(done(ctrl_wheel("View/picture", 6)));
  const Screen zoomed = screen();
  EXPECT_GT(count_differing(all, zoomed, inner), inner.count() / 20);
  ASSERT_TRUE(done(ctrl_drag("View/picture", 24, 15)));
  const Screen panned = screen();
  Area moved = inner;
  moved.x0 += 2, moved.x1 -= 26, moved.y1 -= 15;
  EXPECT_LT(count_differing(zoomed, panned, moved, 24, 15), moved.count() / 100) << "the picture follows the hand";
  EXPECT_GT(count_differing(zoomed, panned, moved), moved.count() / 20);
  EXPECT_EQ(screen_of(Key::Z).rgba, all.rgba);
  EXPECT_EQ(session().description(), before);
  EXPECT_EQ(session().picture(0), a);
  EXPECT_EQ(session().picture(1), b);
}

TEST_F(CompareUi, ZoomOfOneTileIsThatOfAll) {
  start();
  make_two();
  robot().press_key(Key::S);
  ASSERT_TRUE(done(ctrl_wheel("View/picture A", 6)));
  const Screen second = screen_of(Key::Num2);
  EXPECT_NE(second.rgba, screen_of(Key::Z).rgba);
}

TEST_F(CompareUi, DragInOneOfTwoTilesWithTheSameNameMovesTheCameraOnce) {
  start();
  make_two();
  ASSERT_TRUE(done(robot().drag_by("View/picture A", 30, 0)));
  const Vec3d once = camera().vec3("position");
  session().undo();
  const ui::ItemRect tile = rect_of("View/picture A"), view = rect_of("View");
  session().change([](Node& d) {
    for (Node& v : d.child("compare").list("variants")) ASSERT_TRUE(v.set("name", std::string("same")).ok());
  });
  settle();
  ASSERT_TRUE(done(robot().press("View", (tile.center().x - view.min.x) / (view.max.x - view.min.x),
                                 (tile.center().y - view.min.y) / (view.max.y - view.min.y))));
  robot().move_by(30, 0);
  robot().release();
  EXPECT_EQ(camera().vec3("position"), once);
}

}  // namespace
}  // namespace brume
