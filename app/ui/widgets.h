// The widgets Brume uses: ImGui's, with values as double, and each telling the ItemRecorder where it was drawn.
//
// A label follows ImGui's "##" rules and is also the widget's name for the robot: "Window/label". Every widget returns
// whether the value changed in this frame. Numbers typed with the keyboard (Ctrl+click or double click on a field)
// change the value once, when the typing ends: nobody wants the render to restart for the "2" of "25".
#pragma once

#include <imgui.h>

#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "app/ui/item_recorder.h"
#include "renderer/core/vec.h"

namespace brume::ui {

// --- Windows. Every begin_window and begin_child needs its end_, whatever it returned; menus and popups need theirs
// only when they returned true.

bool begin_window(const char* title, bool* open = nullptr, ImGuiWindowFlags flags = 0);
void end_window();
/// A part with its own scrolling; widgets inside keep the names of the window.
bool begin_child(const char* label, ImVec2 size = {0, 0}, bool border = false, ImGuiWindowFlags flags = 0);
void end_child();

/// The bar at the top of the application; its menus are named "Menu/File".
bool begin_main_menu_bar();
void end_main_menu_bar();
/// Entries are named after the menu: "Menu/File/Open".
bool menu(const char* label, bool enabled = true);
void end_menu();
/// Returns whether it was chosen. `keys` is only shown ("Ctrl+O"); see keys.h for acting on it.
bool menu_item(const char* label, const char* keys = nullptr, bool selected = false, bool enabled = true);

/// Opens the popup or modal of this name; call it at the same level of ids as begin_popup or begin_modal.
void open_popup(const char* name);
/// Widgets inside are named "name/label". Esc closes it.
bool begin_popup(const char* name);
void end_popup();
/// In the middle of the window, the rest darkened. Esc closes it.
bool begin_modal(const char* title);
void end_modal();

// --- Buttons and choices.

bool button(const char* label, ImVec2 size = {0, 0});
/// Without the height of a framed widget, to sit in a line of text.
bool small_button(const char* label);
bool checkbox(const char* label, bool& value);
/// Returns whether it was clicked.
bool selectable(const char* label, bool selected, ImVec2 size = {0, 0});
/// Entries are named "Window/combo/entry" while the list is open. An index out of range shows as a dash.
bool combo(const char* label, int& index, std::span<const std::string> entries);
bool combo(const char* label, int& index, std::span<const char* const> entries);
/// Returns whether it is open.
bool collapsing_header(const char* label, bool default_open = true);
/// Changes with every key.
bool input_text(const char* label, std::string& text, const char* hint = "");

// --- Numbers. A value that is not finite is never returned.

struct SliderOptions {
  double min = 0, max = 1;      ///< the reach of the slider
  bool logarithmic = false;     ///< needs min >= 0; 0 sits at the left end, next to the smallest value the format shows
  bool clamp = true;            ///< false: typing may go beyond the reach
  const char* format = "%.3f";  ///< may hold a unit: "%.2f m"
};
bool slider_float(const char* label, double& value, const SliderOptions& options = {});

/// `clamp` as above.
bool slider_int(const char* label, int& value, int min, int max, const char* format = "%d", bool clamp = true);

struct DragOptions {
  double speed = 0;  ///< change per pixel; 0: half a percent of the value, at least 0.01
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  const char* format = "%.3f";
};
bool drag_float(const char* label, double& value, const DragOptions& options = {});
/// Fields "label/x", "label/y", "label/z": side by side, or one below the other where it is too narrow.
bool drag_vec3(const char* label, Vec3d& value, const DragOptions& options = {});
/// A plain field for typing.
bool input_double(const char* label, double& value, const char* format = "%.6g");

/// Linear, unbounded above: fields "label/r", "label/g", "label/b" and "label/swatch", which opens a picker of hue and
/// saturation that keeps the intensity.
bool color_edit(const char* label, Color& linear, const DragOptions& options = {.min = 0});

// --- Pictures and help.

/// A place for pictures that takes the mouse (left, right, middle), so that dragging in it does not move the window.
/// Draw into it afterwards. Returns whether the mouse is on it or was pressed on it; ImGui::IsItemActive() and
/// GetItemRectMin() then speak of it.
bool canvas(const char* label, ImVec2 size);

/// Help for the widget drawn last: wrapped, shown when the mouse has rested on it for a moment. Empty text: nothing.
void tooltip_on_hover(std::string_view text);

// --- The widget drawn last.

/// A drag, a click or typing has ended and changed the value: the moment to close a step of undo.
bool item_deactivated_after_edit();
/// It is being dragged or typed into.
bool item_active();

}  // namespace brume::ui
