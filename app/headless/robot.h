// A user who finds widgets by their labels.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "app/ui/item_recorder.h"
#include "app/ui/keys.h"
#include "app/ui/stage.h"

namespace brume {

/// Works a Stage through the mouse and the keyboard only, one frame after the other. Labels are the names of the
/// ItemRecorder: "Window/label", "Window/combo/entry", "Menu/File/Open", "Window/position/x".
///
/// Every action fails, and does nothing, when its widget was not drawn in the last frame (the error lists the names
/// most like it), is drawn twice under one name, is scrolled away, covered or disabled. After an action its effects
/// have been drawn.
class Robot {
 public:
  /// Runs one frame, so that there is something to look at. Keeps a reference to the stage.
  Robot(Stage& stage, DrawUi draw_ui);

  Result<void> click(const std::string& label) { return click_with(label, ImGuiMouseButton_Left, 1); }
  Result<void> double_click(const std::string& label) { return click_with(label, ImGuiMouseButton_Left, 2); }
  Result<void> right_click(const std::string& label) { return click_with(label, ImGuiMouseButton_Right, 1); }
  /// Clicks at a place of the widget: (0,0) is its top left corner, (1,1) its bottom right.
  Result<void> click_at(const std::string& label, float x, float y, ImGuiMouseButton button = ImGuiMouseButton_Left);
  /// From one fraction of the widget's width to another, at half its height: drag("Camera/focal length", 0.1, 0.8).
  Result<void> drag(const std::string& label, float from, float to);
  /// From the middle of the widget by so many pixels, y down.
  Result<void> drag_by(const std::string& label, float dx, float dy, ImGuiMouseButton button = ImGuiMouseButton_Left);
  /// Notches over the middle of the widget; positive scrolls up.
  Result<void> wheel(const std::string& label, float notches);
  /// Ctrl+click (which turns a slider into a text field), select all, type, Enter.
  Result<void> type_into(const std::string& label, const std::string& text);
  /// Opens the combo and clicks the entry, scrolling to it.
  Result<void> choose(const std::string& combo, const std::string& entry);
  /// Rests on the widget until its tooltip shows.
  Result<void> hover(const std::string& label);
  /// Turns the wheel over the widget's window until the widget can be clicked.
  Result<void> scroll_to(const std::string& label);

  /// For a drag with something in between: press(), move_by() as often as needed, release().
  Result<void> press(const std::string& label, float x, float y, ImGuiMouseButton button = ImGuiMouseButton_Left);
  void move_by(float dx, float dy);
  void release();

  void press_key(ui::Key key, ui::Mods mods = {});
  void hold_key(ui::Key key);
  void release_key(ui::Key key);
  /// As if typed on the keyboard, to whoever takes it: "?"
  void type(const std::string& utf8);
  void frames(int count);

  /// Drawn in the last frame, be it scrolled away.
  bool exists(const std::string& label) const { return last_drawn(label) != nullptr; }
  /// Drawn in the last frame and at least partly in sight.
  bool visible(const std::string& label) const;
  /// What was drawn in the last frame under this name, or null.
  const ui::ItemRecord* last_drawn(const std::string& label) const;
  /// Of the last frame; empty when none shows.
  std::string tooltip() const;

 private:
  Result<ImVec2> reach(const std::string& label, float x, float y);
  Result<const ui::ItemRecord*> look_up(const std::string& label) const;
  Result<void> click_with(const std::string& label, ImGuiMouseButton button, int times);
  void move_to(ImVec2 position);
  void press_and_release(ImGuiMouseButton button);
  void forget_last_click();

  Stage& stage_;
  DrawUi draw_ui_;
  ImVec2 mouse_{0, 0};
  ImGuiMouseButton pressed_ = ImGuiMouseButton_Left;
};

}  // namespace brume
