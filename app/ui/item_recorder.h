// Where every widget of the last frame was drawn, so that a robot can find it by its label.
#pragma once

#include <imgui.h>

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace brume::ui {

/// A rectangle in display coordinates, y down.
struct ItemRect {
  ImVec2 min{0, 0}, max{0, 0};

  bool empty() const { return max.x <= min.x || max.y <= min.y; }
  ImVec2 center() const { return {(min.x + max.x) * 0.5f, (min.y + max.y) * 0.5f}; }
};

/// One widget as drawn in one frame.
struct ItemRecord {
  ItemRect rect;          ///< the part that takes clicks, without a label beside it
  ItemRect clip;          ///< what its window or child shows of itself
  ItemRect visible;       ///< rect within clip; empty when scrolled away
  int frame = -1;         ///< ImGui::GetFrameCount() when it was drawn
  int times = 0;          ///< how often the name was drawn in that frame; over 1 the name is ambiguous
  bool hovered = false;   ///< the mouse was on it, and nothing covered it
  bool disabled = false;  ///< known only while the mouse is on it
};

/// Reached through ImGui::GetIO().UserData; null there means that nobody wants to know. UI thread only.
class ItemRecorder {
 public:
  /// The recorder of the current ImGui context, or null.
  static ItemRecorder* current() { return static_cast<ItemRecorder*>(ImGui::GetIO().UserData); }

  /// What a label is called in names: the text before "##" if there is any, else the part after.
  static std::string_view name_of(std::string_view label);

  void begin_window(const char* title);
  void end_window();
  /// A level below the window: a menu, a popup, a repeated block such as one of several lights.
  void push_scope(const char* label);
  void pop_scope();

  /// "Window/scope/label" of a widget drawn now.
  std::string path(const char* label) const;
  void record(const std::string& path, const ItemRecord& item);
  /// The widget is drawn at its place of the last frame (a menu whose popup is open tells no rectangle).
  void record_again(const std::string& path);
  void record_tooltip(std::string_view text);

  /// The record drawn last under this name, in whatever frame; null if there never was one.
  const ItemRecord* find(std::string_view path) const;
  /// Names drawn in the current frame, sorted.
  std::vector<std::string> names() const;
  /// Names drawn in the current frame that look most like `path`, best first.
  std::vector<std::string> near_names(std::string_view path, size_t limit) const;
  /// The name drawn last under the mouse in the current frame, empty when there is none.
  std::string hovered() const;
  /// The tooltip of the current frame, empty when none is shown.
  std::string tooltip() const;

 private:
  std::map<std::string, ItemRecord, std::less<>> items_;
  // Paths of the open windows and scopes, outermost first: a window starts anew, a scope adds to the one before.
  std::vector<std::string> prefixes_;
  std::string tooltip_;
  int tooltip_frame_ = -1;
};

/// Tells the recorder, if any, of the widget that was drawn last: `min`, `max` are the part that takes clicks.
void record_item(const char* label, ImVec2 min, ImVec2 max);
/// The same with the whole rectangle of the item.
void record_item(const char* label);
/// The same for something that is no ImGui item; the caller knows whether the mouse is on it.
void record_area(const char* label, ImVec2 min, ImVec2 max, bool hovered);

/// Names and ImGui ids below `label` for as long as it lives, for blocks that repeat: "Scene/key light/intensity".
class Scope {
 public:
  explicit Scope(const char* label);
  ~Scope();
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;
};

}  // namespace brume::ui
