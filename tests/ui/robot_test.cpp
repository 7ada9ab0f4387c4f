// What the robot can do, and that it fails loudly where a user could not go on.
#include <imgui.h>

#include <array>
#include <string>

#include "app/ui/keys.h"
#include "tests/ui/robot_fixture.h"

namespace brume {
namespace {

using ui::Key;
using RobotTest = RobotFixture;

TEST_F(RobotTest, FailsForWhatIsNotThere) {
  show([] { ui::button("Density scale"); });
  EXPECT_TRUE(fails_with(robot().click("Panel/Density"), "not drawn"));
  EXPECT_TRUE(fails_with(robot().click("Panel/Density"), "Panel/Density scale")) << "names what is like it";
}

TEST_F(RobotTest, FailsForALabelDrawnTwice) {
  show([] {
    for (const char* light : {"key", "rim"}) {
      ImGui::PushID(light);
      ui::button("solo");
      ImGui::PopID();
      const ui::Scope scope(light);
      ui::button("mute");
    }
  });
  EXPECT_TRUE(fails_with(robot().click("Panel/solo"), "2 times"));
  EXPECT_TRUE(done(robot().click("Panel/rim/mute")));
}

TEST_F(RobotTest, FailsForWhatIsCoveredOrDisabled) {
  int pressed = 0;
  bool lid = true;
  show([&] {
    pressed += ui::button("under");
    ImGui::BeginDisabled();
    pressed += ui::button("off");
    ImGui::EndDisabled();
    ui::end_window();
    if (lid) {
      place(0, 0, 300, 80);
      ui::begin_window("Lid");
      ui::end_window();
    }
    ui::begin_window("Panel");
  });
  EXPECT_TRUE(fails_with(robot().click("Panel/under"), "covered; under the mouse is \"Lid\""));
  lid = false;
  robot().frames(1);
  EXPECT_TRUE(done(robot().click("Panel/under")));
  EXPECT_TRUE(fails_with(robot().click("Panel/off"), "disabled"));
  EXPECT_EQ(pressed, 1);
}

TEST_F(RobotTest, ScrollsToWhatIsOutOfSight) {
  int pressed = -1;
  show(
      [&] {
        for (int i = 0; i < 40; ++i)
          if (ui::button(("button " + std::to_string(i)).c_str())) pressed = i;
      },
      200);
  EXPECT_TRUE(robot().exists("Panel/button 35"));
  EXPECT_FALSE(robot().visible("Panel/button 35"));
  EXPECT_TRUE(fails_with(robot().click("Panel/button 35"), "out of sight"));
  ASSERT_TRUE(done(robot().scroll_to("Panel/button 35")));
  ASSERT_TRUE(done(robot().click("Panel/button 35")));
  EXPECT_EQ(pressed, 35);
  ASSERT_TRUE(done(robot().scroll_to("Panel/button 0")));
  ASSERT_TRUE(done(robot().click("Panel/button 0")));
  EXPECT_EQ(pressed, 0);
}

TEST_F(RobotTest, DragsInAPictureWithEveryButton) {
  std::array<ImVec2, 3> moved{};
  float turned = 0;
  int doubles = 0;
  ImVec2 window_position{0, 0};
  show([&] {
    ui::canvas("viewport", {300, 200});
    if (ImGui::IsItemActive())
      for (int button = 0; button < 3; ++button)
        if (ImGui::IsMouseDown(button)) {
          moved[static_cast<size_t>(button)].x += ImGui::GetIO().MouseDelta.x;
          moved[static_cast<size_t>(button)].y += ImGui::GetIO().MouseDelta.y;
        }
    if (ImGui::IsItemHovered()) turned += ImGui::GetIO().MouseWheel;
    doubles += ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0);
    window_position = ImGui::GetWindowPos();
  });
  for (int button = 0; button < 3; ++button) {
    ASSERT_TRUE(done(robot().drag_by("Panel/viewport", 40, -25, button)));
    EXPECT_EQ(moved[static_cast<size_t>(button)].x, 40) << button;
    EXPECT_EQ(moved[static_cast<size_t>(button)].y, -25) << button;
  }
  EXPECT_EQ(window_position.x, 20) << "the window stays where it is";
  ASSERT_TRUE(done(robot().wheel("Panel/viewport", -3)));
  EXPECT_EQ(turned, -3);
  ASSERT_TRUE(done(robot().click("Panel/viewport")));
  ASSERT_TRUE(done(robot().click("Panel/viewport")));
  EXPECT_EQ(doubles, 0) << "two clicks are no double click";
  ASSERT_TRUE(done(robot().double_click("Panel/viewport")));
  EXPECT_EQ(doubles, 1);
}

TEST_F(RobotTest, PressesKeysUnlessTextIsTyped) {
  int frame_all = 0, undo = 0, redo = 0, help = 0, held = 0;
  std::string text;
  show([&] {
    ui::input_text("name", text);
    frame_all += ui::shortcut(Key::F);
    undo += ui::shortcut(Key::Z, {.ctrl = true});
    redo += ui::shortcut(Key::Z, {.ctrl = true, .shift = true});
    help += ui::typed('?');
    held += ui::key_held(Key::Num2);
  });
  robot().press_key(Key::F);
  robot().press_key(Key::Z, {.ctrl = true});
  robot().press_key(Key::Z, {.ctrl = true, .shift = true});
  robot().type("?");
  robot().hold_key(Key::Num2);
  robot().frames(4);
  robot().release_key(Key::Num2);
  EXPECT_EQ(frame_all, 1);
  EXPECT_EQ(undo, 1);
  EXPECT_EQ(redo, 1);
  EXPECT_EQ(help, 1);
  EXPECT_EQ(held, 5);
  ASSERT_TRUE(done(robot().click("Panel/name")));
  robot().press_key(Key::F);
  robot().press_key(Key::Z, {.ctrl = true});
  robot().type("?");
  EXPECT_EQ(frame_all + undo + help, 3) << "the text field takes them";
  EXPECT_EQ(text, "?");
}

}  // namespace
}  // namespace brume
