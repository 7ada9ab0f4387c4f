// What a click, a drag or typed text does to the value of every widget.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/ui/keys.h"
#include "app/ui/property_row.h"
#include "app/ui/theme.h"
#include "tests/ui/robot_fixture.h"

namespace brume {
namespace {

using ui::Key;
using WidgetsTest = RobotFixture;

TEST_F(WidgetsTest, ClicksACheckbox) {
  bool on = false;
  int changes = 0, finished = 0;
  show([&] {
    changes += ui::checkbox("on", on);
    finished += ui::item_deactivated_after_edit();
  });
  ASSERT_TRUE(done(robot().click("Panel/on")));
  EXPECT_TRUE(on);
  EXPECT_EQ(changes, 1);
  EXPECT_EQ(finished, 1);
  ASSERT_TRUE(done(robot().click("Panel/on")));
  EXPECT_FALSE(on);
}

TEST_F(WidgetsTest, DragsASliderToAFraction) {
  double value = 0.5;
  int changes = 0, finished = 0;
  show([&] {
    changes += ui::slider_float("density", value, {.min = 0, .max = 10});
    finished += ui::item_deactivated_after_edit();
  });
  ASSERT_TRUE(done(robot().drag("Panel/density", 0.1f, 0.75f)));
  EXPECT_NEAR(value, 7.5, 0.1);  // a pixel of a slider of 250
  EXPECT_GT(changes, 3) << "it follows the mouse";
  EXPECT_EQ(finished, 1) << "one step of undo for the whole drag";
}

TEST_F(WidgetsTest, DragsALogarithmicSlider) {
  double value = 1;
  show([&] { ui::slider_float("step", value, {.min = 0.01, .max = 100, .logarithmic = true, .format = "%.4f"}); });
  ASSERT_TRUE(done(robot().drag("Panel/step", 0.1f, 0.75f)));
  EXPECT_NEAR(std::log10(value), 1, 0.05);
}

TEST_F(WidgetsTest, TypesAnExactValueIntoASlider) {
  double value = 0.5;
  std::vector<double> seen;
  int finished = 0;
  show([&] {
    if (ui::slider_float("density", value, {.min = 0, .max = 10})) seen.push_back(value);
    finished += ui::item_deactivated_after_edit();
  });
  ASSERT_TRUE(done(robot().type_into("Panel/density", "3.14159265")));
  EXPECT_EQ(value, 3.14159265);
  EXPECT_EQ(seen, std::vector<double>{3.14159265}) << "typing changes the value once, when it ends";
  EXPECT_EQ(finished, 1);

  ASSERT_TRUE(done(robot().type_into("Panel/density", "99")));
  EXPECT_EQ(value, 10) << "held to the range";
  ASSERT_TRUE(done(robot().type_into("Panel/density", "")));
  EXPECT_EQ(value, 10) << "no number, no change";
}

TEST_F(WidgetsTest, DoubleClickTypesIntoSlidersAndDragFields) {
  double density = 0.5, power = 1;
  int samples = 1;
  show([&] {
    ui::slider_float("density", density);
    ui::drag_float("power", power);
    ui::slider_int("samples", samples, 1, 8);
  });
  for (const char* label : {"Panel/density", "Panel/power", "Panel/samples"}) {
    ASSERT_TRUE(done(robot().double_click(label)));
    robot().type(label == std::string("Panel/samples") ? "7" : "0.875");
    robot().press_key(Key::Enter);
  }
  EXPECT_EQ(density, 0.875);
  EXPECT_EQ(power, 0.875);
  EXPECT_EQ(samples, 7);
}

TEST_F(WidgetsTest, TypingGoesBeyondASliderThatDoesNotClamp) {
  double density = 0.5;
  int samples = 1, only = 3;
  show([&] {
    ui::slider_float("density", density, {.clamp = false});
    ui::slider_int("samples", samples, 1, 8, "%d", false);
    ui::slider_int("only", only, 3, 3);
  });
  ASSERT_TRUE(done(robot().type_into("Panel/density", "12")));
  ASSERT_TRUE(done(robot().type_into("Panel/samples", "64")));
  robot().frames(2);
  EXPECT_EQ(density, 12);
  EXPECT_EQ(samples, 64);
}

TEST_F(WidgetsTest, EscapeGivesTypingUp) {
  double value = 0.123456789;
  show([&] { ui::input_double("seed", value, "%.3f"); });
  ASSERT_TRUE(done(robot().click("Panel/seed")));
  robot().press_key(Key::A, {.ctrl = true});
  robot().type("42");
  robot().press_key(Key::Escape);
  EXPECT_EQ(value, 0.123456789);
}

TEST_F(WidgetsTest, ClickingElsewhereEndsTyping) {
  double first = 1, second = 2;
  show([&] {
    ui::input_double("first", first);
    ui::input_double("second", second);
  });
  ASSERT_TRUE(done(robot().click("Panel/first")));
  robot().type("5");
  EXPECT_EQ(first, 1) << "not yet";
  ASSERT_TRUE(done(robot().click("Panel/second")));
  EXPECT_EQ(first, 5);
  robot().type("6");
  ASSERT_TRUE(done(robot().click("Panel/first")));
  EXPECT_EQ(second, 6);
}

TEST_F(WidgetsTest, NeverGetsAValueThatIsNotFinite) {
  double value = 1;
  show([&] { ui::drag_float("power", value); });
  ASSERT_TRUE(done(robot().type_into("Panel/power", "1e999")));
  EXPECT_TRUE(std::isfinite(value));
}

TEST_F(WidgetsTest, DragsAndTypesVectorsAndColours) {
  Vec3d position{1, 2, 3};
  Color color{1, 1, 1};
  int samples = 1;
  int finished = 0;
  show([&] {
    ui::drag_vec3("position", position);
    finished += ui::item_deactivated_after_edit();
    ui::color_edit("colour", color);
    ui::slider_int("samples", samples, 1, 8);
  });
  ASSERT_TRUE(done(robot().type_into("Panel/position/y", "-4.25")));
  EXPECT_EQ(position, (Vec3d{1, -4.25, 3}));
  ASSERT_TRUE(done(robot().drag_by("Panel/position/z", 30, 0)));
  EXPECT_GT(position.z, 3);
  EXPECT_EQ(finished, 2);
  ASSERT_TRUE(done(robot().type_into("Panel/colour/r", "12.5")));
  EXPECT_EQ(color, (Color{12.5f, 1, 1}));
  ASSERT_TRUE(done(robot().type_into("Panel/samples", "6")));
  EXPECT_EQ(samples, 6);
  ASSERT_TRUE(done(robot().drag("Panel/samples", 0.9f, 0.02f)));
  EXPECT_EQ(samples, 1);
}

TEST_F(WidgetsTest, PicksAHueAndKeepsTheIntensity) {
  Color color{8, 8, 8};
  int finished = 0;
  show([&] {
    ui::color_edit("colour", color);
    finished += ui::item_deactivated_after_edit();
  });
  ASSERT_TRUE(done(robot().click("Panel/colour/swatch")));
  ASSERT_TRUE(done(robot().click_at("Panel/colour/picker", 0.5f, 0.01f)));
  EXPECT_NEAR(max_channel(color), 8, 0.3);
  EXPECT_LT(std::min({color.r, color.g, color.b}), 4);
  EXPECT_EQ(finished, 1);
  robot().press_key(Key::Escape);
  EXPECT_FALSE(robot().exists("Panel/colour/picker"));
}

TEST_F(WidgetsTest, ChoosesFromACombo) {
  int index = 0, changes = 0, finished = 0;
  std::vector<std::string> entries;
  for (int i = 0; i < 40; ++i) entries.push_back("entry " + std::to_string(i));
  show([&] {
    changes += ui::combo("integrator", index, entries);
    finished += ui::item_deactivated_after_edit();
  });
  EXPECT_FALSE(robot().exists("Panel/integrator/entry 3"));
  ASSERT_TRUE(done(robot().choose("Panel/integrator", "entry 3")));
  EXPECT_EQ(index, 3);
  ASSERT_TRUE(done(robot().choose("Panel/integrator", "entry 37"))) << "far down the list";
  EXPECT_EQ(index, 37);
  EXPECT_EQ(changes, 2);
  EXPECT_EQ(finished, 2);
  EXPECT_TRUE(fails_with(robot().choose("Panel/integrator", "entry 99"), "not drawn"));
  robot().press_key(Key::Escape);
  EXPECT_FALSE(robot().exists("Panel/integrator/entry 3"));
}

TEST_F(WidgetsTest, TypesText) {
  std::string name = "key";
  int selected = 0;
  show([&] {
    ui::input_text("name", name);
    for (int i = 0; i < 3; ++i)
      if (ui::selectable(("light " + std::to_string(i)).c_str(), selected == i)) selected = i;
  });
  ASSERT_TRUE(done(robot().type_into("Panel/name", "Größe σ")));
  EXPECT_EQ(name, "Größe σ");
  ASSERT_TRUE(done(robot().type_into("Panel/name", "")));
  EXPECT_EQ(name, "");
  ASSERT_TRUE(done(robot().click("Panel/light 2")));
  EXPECT_EQ(selected, 2);
  EXPECT_TRUE(fails_with(robot().type_into("Panel/light 1", "x"), "takes no text"));
}

TEST_F(WidgetsTest, UsesMenus) {
  int opened = 0, other = 0;
  show([&] {
    if (!ui::begin_main_menu_bar()) return;
    if (ui::menu("File")) {
      opened += ui::menu_item("Open", "Ctrl+O");
      ui::menu_item("Export", nullptr, false, false);
      ui::end_menu();
    }
    if (ui::menu("View")) {
      other += ui::menu_item("Panels");
      ui::end_menu();
    }
    ui::end_main_menu_bar();
  });
  ASSERT_TRUE(done(robot().click("Menu/File")));
  EXPECT_TRUE(fails_with(robot().click("Menu/File/Export"), "disabled"));
  ASSERT_TRUE(done(robot().click("Menu/File/Open")));
  EXPECT_EQ(opened, 1);
  EXPECT_FALSE(robot().exists("Menu/File/Open"));
  ASSERT_TRUE(done(robot().click("Menu/View")));
  ASSERT_TRUE(done(robot().click("Menu/View/Panels")));
  EXPECT_EQ(other, 1);
  ASSERT_TRUE(done(robot().click("Menu/File")));
  robot().press_key(Key::Escape);
  EXPECT_FALSE(robot().exists("Menu/File/Open"));
}

TEST_F(WidgetsTest, ResetsAPropertyRow) {
  double value = 2;
  int finished = 0;
  show([&] {
    ui::PropertyRow row("Density", {.doc = "How thick it is.", .modified = value != 1});
    ui::slider_float(row.id(), value, {.max = 4});
    if (row.finish()) value = 1;
    finished += row.edit_finished();
  });
  ASSERT_TRUE(done(robot().hover("Panel/Density")));
  EXPECT_EQ(robot().tooltip(), "How thick it is.");
  ASSERT_TRUE(done(robot().click("Panel/Density/reset")));
  EXPECT_EQ(value, 1);
  EXPECT_EQ(finished, 1);
  EXPECT_FALSE(robot().exists("Panel/Density/reset"));
}

TEST_F(WidgetsTest, TooltipWaitsForTheMouseToRest) {
  show([] {
    ui::button("render");
    ui::tooltip_on_hover("Starts again.");
    ui::button("pause");
  });
  ASSERT_TRUE(done(robot().click("Panel/render")));
  EXPECT_EQ(robot().tooltip(), "");
  ASSERT_TRUE(done(robot().hover("Panel/render")));
  EXPECT_EQ(robot().tooltip(), "Starts again.");
  ASSERT_TRUE(done(robot().hover("Panel/pause")));
  EXPECT_EQ(robot().tooltip(), "");
}

TEST_F(WidgetsTest, ModalCoversTheRestUntilItCloses) {
  int replaced = 0, behind = 0;
  show([&] {
    if (ui::button("Save")) ui::open_popup("Overwrite?");
    behind += ui::button("behind");
    if (ui::begin_modal("Overwrite?")) {
      if (ui::button("Replace")) {
        ++replaced;
        ImGui::CloseCurrentPopup();
      }
      ui::end_modal();
    }
  });
  ASSERT_TRUE(done(robot().click("Panel/Save")));
  EXPECT_TRUE(fails_with(robot().click("Panel/behind"), "covered"));
  ASSERT_TRUE(done(robot().click("Overwrite?/Replace")));
  EXPECT_EQ(replaced, 1);
  ASSERT_TRUE(done(robot().click("Panel/behind")));
  ASSERT_TRUE(done(robot().click("Panel/Save")));
  robot().press_key(Key::Escape);
  EXPECT_FALSE(robot().exists("Overwrite?/Replace"));
}

TEST_F(WidgetsTest, HeadersFoldWhatIsBelow) {
  show([] {
    if (ui::collapsing_header("Advanced", false)) ui::button("inside");
    ui::small_button("small##1");
    ui::button("##hidden");
  });
  EXPECT_FALSE(robot().exists("Panel/inside"));
  ASSERT_TRUE(done(robot().click("Panel/Advanced")));
  EXPECT_TRUE(robot().exists("Panel/inside"));
  EXPECT_TRUE(done(robot().click("Panel/small"))) << "the name ends at ##";
  EXPECT_TRUE(done(robot().click("Panel/hidden"))) << "or is what comes after";
}

TEST(Theme, FontHasTheSignsWeUse) {
  auto stage = Stage::create();
  ASSERT_TRUE(stage.ok());
  if ((*stage)->font().empty()) GTEST_SKIP() << "no font file here";
  (*stage)->frame([](const Gl&) {
    for (const int sign : {0x3C3, 0x3C4, 0x3BB, 0xB7, 0xD7, 0x2264, 0xB0, 0xB5, 0xB2, 0xB3})
      EXPECT_TRUE(ui::font_has(static_cast<ImWchar>(sign))) << std::hex << sign;
  });
}

TEST(Theme, DoesWithoutAnyFontFile) {
  auto stage = Stage::create({.scale = 2, .font_paths = {"/nonexistent.ttf", "/etc/passwd"}});
  ASSERT_TRUE(stage.ok());
  (*stage)->frame([](const Gl&) { ImGui::TextUnformatted("fallback"); });
}

}  // namespace
}  // namespace brume
