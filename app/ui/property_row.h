// One row of a two-column inspector: the name at the left, the widget at the right, a way back to the default.
#pragma once

#include <imgui.h>

#include <string>

namespace brume::ui {

struct PropertyRowOptions {
  std::string doc = {};   ///< shown when the mouse rests on the name or the widget
  bool modified = false;  ///< the value differs from its default: the name is brighter, the reset button is shown
  std::string reset_help = "Back to the default";
  std::string dragged = {};  ///< text that the name carries when it is dragged, see kDraggedSetting; empty: it stays
};

/// What ImGui calls the payload of a dragged name; its data is the text.
inline constexpr const char* kDraggedSetting = "setting";

/// Draw one widget between the constructor and finish():
///   ui::PropertyRow row("Step size", {.doc = "...", .modified = value != standard});
///   bool changed = ui::slider_float(row.id(), value, {...});
///   if (row.finish()) value = standard, changed = true;
///   if (row.edit_finished()) close the step of undo
/// The widget is named "Window/Step size", the button "Window/Step size/reset", the name "Window/Step size/name".
class PropertyRow {
 public:
  explicit PropertyRow(const char* label, const PropertyRowOptions& options = {});
  PropertyRow(const PropertyRow&) = delete;
  PropertyRow& operator=(const PropertyRow&) = delete;

  /// The label to give to the widget: "##Step size".
  const char* id() const { return id_.c_str(); }
  /// Right after the widget. Draws the reset button if it is due and returns whether it was pressed.
  [[nodiscard]] bool finish();
  /// After finish(): the widget has ended an edit, or reset was pressed.
  bool edit_finished() const { return edit_finished_; }

 private:
  std::string label_, id_;
  PropertyRowOptions options_;
  float reset_x_ = 0;  // in window coordinates
  bool edit_finished_ = false;
};

}  // namespace brume::ui
