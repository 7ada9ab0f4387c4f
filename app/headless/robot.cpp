#include "app/headless/robot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/headless/synthetic_input.h"

namespace brume {

namespace {

Error robot_error(const std::string& label, const std::string& what) {
  return bad_input("Robot: \"" + label + "\" " + what);
}

bool inside(const ui::ItemRect& rect, ImVec2 point) {
  return point.x >= rect.min.x && point.x < rect.max.x && point.y >= rect.min.y && point.y < rect.max.y;
}

}  // namespace

Robot::Robot(Stage& stage, DrawUi draw_ui) : stage_(stage), draw_ui_(std::move(draw_ui)) { frames(1); }

// --- Looking.

const ui::ItemRecord* Robot::last_drawn(const std::string& label) const {
  stage_.make_current();
  const ui::ItemRecord* item = stage_.recorder().find(label);
  return item && item->frame == ImGui::GetFrameCount() ? item : nullptr;
}

bool Robot::visible(const std::string& label) const {
  const ui::ItemRecord* item = last_drawn(label);
  return item && !item->visible.empty();
}

std::string Robot::tooltip() const {
  stage_.make_current();
  return stage_.recorder().tooltip();
}

Result<const ui::ItemRecord*> Robot::look_up(const std::string& label) const {
  const ui::ItemRecord* item = last_drawn(label);
  if (!item) {
    std::string what = "was not drawn in the last frame; drawn were, most like it first:";
    for (const std::string& name : stage_.recorder().near_names(label, 8)) what += "\n  " + name;
    return robot_error(label, what);
  }
  if (item->times > 1)
    return robot_error(label, "was drawn " + std::to_string(item->times) +
                                  " times in the last frame; give the widgets different labels or a ui::Scope.");
  return item;
}

Result<ImVec2> Robot::reach(const std::string& label, float x, float y) {
  Result<const ui::ItemRecord*> found = look_up(label);
  if (!found) return found.error();
  const ui::ItemRecord item = **found;
  // The middle is that of the part in sight; any other place is meant literally.
  ImVec2 point(item.rect.min.x + x * (item.rect.max.x - item.rect.min.x),
               item.rect.min.y + y * (item.rect.max.y - item.rect.min.y));
  if (item.visible.empty()) return robot_error(label, "is scrolled out of sight; use scroll_to first.");
  if (x == 0.5f) point.x = item.visible.center().x;
  if (y == 0.5f) point.y = item.visible.center().y;
  // The right and bottom edges belong to the neighbour.
  point.x = std::min(point.x, item.rect.max.x - 1);
  point.y = std::min(point.y, item.rect.max.y - 1);
  if (!inside(item.visible, point))
    return robot_error(label, "is scrolled partly out of sight, just where it was to be touched.");

  move_to(point);
  // The second frame draws hover effects, and lets a popup that this move opened or closed settle.
  frames(2);
  found = look_up(label);
  if (!found) return found.error();
  const ui::ItemRecord& now = **found;
  if (now.disabled) return robot_error(label, "is disabled.");
  if (!now.hovered) {
    const std::string above = stage_.recorder().hovered();
    return robot_error(label, "is covered; under the mouse is " +
                                  (above.empty() ? "nothing that was recorded." : "\"" + above + "\"."));
  }
  return point;
}

// --- Mouse.

void Robot::frames(int count) {
  for (int i = 0; i < count; ++i) stage_.frame(draw_ui_);
}

void Robot::move_to(ImVec2 position) {
  // Whole pixels, as a real mouse reports them.
  mouse_ = {std::floor(position.x), std::floor(position.y)};
  stage_.make_current();
  synthetic_input::move_mouse(mouse_);
}

void Robot::press_and_release(ImGuiMouseButton button) {
  synthetic_input::set_button(button, true);
  frames(1);
  synthetic_input::set_button(button, false);
  frames(1);
}

void Robot::forget_last_click() {
  // Two clicks of the robot are never a double click unless it was asked for one.
  const ImGuiIO& io = ImGui::GetIO();
  frames(static_cast<int>(std::ceil(io.MouseDoubleClickTime / io.DeltaTime)) + 1);
}

Result<void> Robot::click_with(const std::string& label, ImGuiMouseButton button, int times) {
  if (const Result<ImVec2> point = reach(label, 0.5f, 0.5f); !point) return point.error();
  for (int i = 0; i < times; ++i) press_and_release(button);
  frames(1);
  forget_last_click();
  return {};
}

Result<void> Robot::click_at(const std::string& label, float x, float y, ImGuiMouseButton button) {
  if (const Result<ImVec2> point = reach(label, x, y); !point) return point.error();
  press_and_release(button);
  frames(1);
  forget_last_click();
  return {};
}

Result<void> Robot::press(const std::string& label, float x, float y, ImGuiMouseButton button) {
  if (const Result<ImVec2> point = reach(label, x, y); !point) return point.error();
  pressed_ = button;
  synthetic_input::set_button(button, true);
  frames(1);
  return {};
}

void Robot::move_by(float dx, float dy) {
  constexpr int kSteps = 6;  // a hand passes through the places between
  const ImVec2 start = mouse_;
  for (int i = 1; i <= kSteps; ++i) {
    const float part = static_cast<float>(i) / kSteps;
    move_to({start.x + dx * part, start.y + dy * part});
    frames(1);
  }
}

void Robot::release() {
  stage_.make_current();
  synthetic_input::set_button(pressed_, false);
  frames(2);
  forget_last_click();
}

Result<void> Robot::drag(const std::string& label, float from, float to) {
  if (const Result<void> pressed = press(label, from, 0.5f); !pressed) return pressed;
  const ui::ItemRecord* item = last_drawn(label);
  if (!item) {
    release();
    return robot_error(label, "vanished when it was pressed.");
  }
  const float target = item->rect.min.x + to * (item->rect.max.x - item->rect.min.x);
  move_by(target - mouse_.x, 0);
  release();
  return {};
}

Result<void> Robot::drag_by(const std::string& label, float dx, float dy, ImGuiMouseButton button) {
  if (const Result<void> pressed = press(label, 0.5f, 0.5f, button); !pressed) return pressed;
  move_by(dx, dy);
  release();
  return {};
}

Result<void> Robot::wheel(const std::string& label, float notches) {
  if (const Result<ImVec2> point = reach(label, 0.5f, 0.5f); !point) return point.error();
  synthetic_input::turn_wheel(notches);
  frames(2);
  return {};
}

Result<void> Robot::hover(const std::string& label) {
  if (const Result<ImVec2> point = reach(label, 0.5f, 0.5f); !point) return point.error();
  frames(static_cast<int>(std::ceil(0.6f / ImGui::GetIO().DeltaTime)));  // longer than the delay of tooltips
  return {};
}

Result<void> Robot::scroll_to(const std::string& label) {
  constexpr int kTurns = 200;  // a window of 200 notches is not scrolled through by hand either
  for (int turn = 0; turn < kTurns; ++turn) {
    const Result<const ui::ItemRecord*> found = look_up(label);
    if (!found) return found.error();
    const ui::ItemRecord item = **found;
    const float above = item.clip.min.y - item.rect.min.y, below = item.rect.max.y - item.clip.max.y;
    if (above <= 0 && below <= 0) return {};
    move_to(item.clip.center());
    frames(1);
    synthetic_input::turn_wheel(above > 0 ? 1.0f : -1.0f);
    frames(2);
    const ui::ItemRecord* now = last_drawn(label);
    if (now && now->rect.min.y == item.rect.min.y)
      return now->visible.empty() ? robot_error(label, "stays out of sight: its window does not scroll any further.")
                                  : Result<void>();
  }
  return robot_error(label, "could not be scrolled to.");
}

// --- Keyboard.

void Robot::hold_key(ui::Key key) {
  stage_.make_current();
  synthetic_input::set_key(key, true);
  frames(1);
}

void Robot::release_key(ui::Key key) {
  stage_.make_current();
  synthetic_input::set_key(key, false);
  frames(1);
}

void Robot::press_key(ui::Key key, ui::Mods mods) {
  stage_.make_current();
  synthetic_input::set_mods(mods);
  frames(1);
  hold_key(key);
  release_key(key);
  synthetic_input::set_mods({});
  frames(1);
}

void Robot::type(const std::string& utf8) {
  stage_.make_current();
  synthetic_input::type(utf8);
  frames(1);
}

Result<void> Robot::type_into(const std::string& label, const std::string& text) {
  if (const Result<ImVec2> point = reach(label, 0.5f, 0.5f); !point) return point.error();
  synthetic_input::set_mods({.ctrl = true});
  frames(1);
  press_and_release(ImGuiMouseButton_Left);
  synthetic_input::set_mods({});
  frames(1);
  if (!ImGui::GetIO().WantTextInput) return robot_error(label, "takes no text.");
  press_key(ui::Key::A, {.ctrl = true});
  if (text.empty())
    press_key(ui::Key::Delete);
  else
    type(text);
  // Newer versions of ImGui hand out queued characters a few per frame.
  frames(2);
  press_key(ui::Key::Enter);
  forget_last_click();
  return {};
}

Result<void> Robot::choose(const std::string& combo, const std::string& entry) {
  const std::string path = combo + "/" + entry;
  if (!exists(path))
    if (const Result<void> opened = click(combo); !opened) return opened;
  if (const Result<void> scrolled = scroll_to(path); !scrolled) return scrolled;
  return click(path);
}

}  // namespace brume
