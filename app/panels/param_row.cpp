#include "app/panels/param_row.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/ui/property_row.h"
#include "app/ui/widgets.h"

namespace brume {
namespace {

std::string help_text(const Param& p) {
  std::string text = p.doc;
  if (!p.unit.empty()) text += "\nUnit: " + p.unit + ".";
  if (p.automatic) text += "\nAuto: " + *p.automatic + ".";
  for (const Choice& c : p.choices)
    if (!c.doc.empty()) text += "\n" + c.label + ": " + c.doc + ".";
  text += "\nDefault: " + (format_value(p.default_value).empty() ? "none" : format_value(p.default_value)) + ".";
  return text;
}

/// The nearest value that the parameter accepts: typing may go beyond the slider, not beyond the hard range.
double clamped(const Param& p, double v) {
  if (p.low_open && v <= p.low) return p.slider_low > p.low ? p.slider_low : std::nextafter(p.low, p.high);
  return std::clamp(v, p.low, p.high);
}

const char* number_format(const Param& p) {
  return p.logarithmic || p.slider_high - p.slider_low > 100 ? "%.4g" : "%.3f";
}

std::optional<Value> bool_widget(const char* id, bool value) {
  if (ui::checkbox(id, value)) return value;
  return std::nullopt;
}

std::optional<Value> int_widget(const Param& p, const char* id, std::int64_t value) {
  int v = static_cast<int>(std::clamp<std::int64_t>(value, INT32_MIN, INT32_MAX));
  if (!ui::slider_int(id, v, static_cast<int>(p.slider_low), static_cast<int>(p.slider_high), "%d", false))
    return std::nullopt;
  return static_cast<std::int64_t>(clamped(p, v));
}

std::optional<Value> number_widget(const Param& p, const char* id, double value) {
  if (!ui::slider_float(id, value, {p.slider_low, p.slider_high, p.logarithmic, false, number_format(p)}))
    return std::nullopt;
  return clamped(p, value);
}

std::optional<Value> choice_widget(const Param& p, const char* id, const std::string& value) {
  std::vector<std::string> labels;
  int index = -1;
  for (const Choice& c : p.choices) {
    if (c.key == value) index = static_cast<int>(labels.size());
    labels.push_back(c.label);
  }
  if (!ui::combo(id, index, labels)) return std::nullopt;
  return p.choices[static_cast<std::size_t>(index)].key;
}

std::optional<Value> grid_widget(const char* id, const std::string& value, const std::vector<std::string>& grids) {
  std::vector<std::string> labels{"(none)"};
  labels.insert(labels.end(), grids.begin(), grids.end());
  int index = 0;
  for (std::size_t i = 0; i < grids.size(); ++i)
    if (grids[i] == value) index = static_cast<int>(i) + 1;
  if (index == 0 && !value.empty()) {
    labels.push_back(value);  // named by the scene, but not found in the file
    index = static_cast<int>(labels.size()) - 1;
  }
  if (!ui::combo(id, index, labels)) return std::nullopt;
  return index == 0 ? std::string() : labels[static_cast<std::size_t>(index)];
}

std::optional<Value> vector_widget(const Param& p, const char* id, const Numbers& value) {
  Vec3d v{value[0], value[1], value[2]};
  if (!ui::drag_vec3(id, v, {.speed = 0.01, .min = p.low, .max = p.high, .format = "%.4g"})) return std::nullopt;
  return Numbers{clamped(p, v.x), clamped(p, v.y), clamped(p, v.z)};
}

std::optional<Value> color_widget(const Param& p, const char* id, const Numbers& value) {
  Color c{static_cast<float>(value[0]), static_cast<float>(value[1]), static_cast<float>(value[2])};
  if (!ui::color_edit(id, c, {.min = p.low, .max = p.high, .format = "%.3g"})) return std::nullopt;
  Numbers edited;
  // Channels that the user did not touch keep their double.
  for (int k = 0; k < 3; ++k) {
    const double old = value[static_cast<std::size_t>(k)];
    edited.push_back(c[k] == static_cast<float>(old) ? old : clamped(p, c[k]));
  }
  return edited;
}

/// Fields for any count of numbers: lists, matrices, the size of a picture.
std::optional<Value> fields_widget(const Param& p, const char* id, const Numbers& value, std::size_t columns) {
  const ui::Scope scope(id);
  std::optional<Value> edited;
  const float width =
      (ImGui::CalcItemWidth() - ImGui::GetStyle().ItemInnerSpacing.x * static_cast<float>(columns - 1)) /
      static_cast<float>(columns);
  const float left = ImGui::GetCursorPosX();
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (i % columns != 0)
      ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    else
      ImGui::SetCursorPosX(left);
    ImGui::SetNextItemWidth(width);
    double v = value[i];
    if (!ui::input_double(("##" + std::to_string(i)).c_str(), v)) continue;
    Numbers numbers = value;
    numbers[i] = clamped(p, p.type == ParamType::Resolution ? std::round(v) : v);
    edited = std::move(numbers);
  }
  if (p.type == ParamType::NumberList) {
    ImGui::SetCursorPosX(left);
    if (ui::small_button("+")) {
      Numbers numbers = value;
      numbers.push_back(value.empty() ? 0 : value.back());
      edited = std::move(numbers);
    }
    ImGui::SameLine();
    if (!value.empty() && ui::small_button("-")) edited = Numbers(value.begin(), value.end() - 1);
  }
  if (p.type == ParamType::Matrix && value.empty() && ui::small_button("Use a matrix"))
    edited = Numbers{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  return edited;
}

std::optional<Value> text_widget(const char* id, std::string text) {
  if (!ui::input_text(id, text)) return std::nullopt;
  return text;
}

/// What is set, each with a button that takes it away; parameters are dragged onto a variant to set more.
std::optional<Value> settings_widget(const char* id, const Settings& value) {
  const ui::Scope scope(id);
  if (value.empty()) ImGui::TextDisabled("nothing");
  std::optional<Value> edited;
  const float left = ImGui::GetCursorPosX();
  for (std::size_t i = 0; i < value.size(); ++i) {
    const ui::Scope setting(value[i].path.c_str());
    ImGui::SetCursorPosX(left);
    if (ui::small_button("x")) {
      Settings rest = value;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      edited = std::move(rest);
    }
    ui::tooltip_on_hover("As in the scene again");
    ImGui::SameLine();
    ImGui::TextUnformatted((value[i].path + " = " + value[i].value).c_str());
  }
  return edited;
}

std::optional<Value> widget(const Param& p, const char* id, const Value& value, const ParamRowContext& context,
                            bool& browse) {
  switch (p.type) {
    case ParamType::Bool:
      return bool_widget(id, std::get<bool>(value));
    case ParamType::Int:
      return int_widget(p, id, std::get<std::int64_t>(value));
    case ParamType::Number:
      return number_widget(p, id, std::get<double>(value));
    case ParamType::Choice:
      return choice_widget(p, id, std::get<std::string>(value));
    case ParamType::Grid:
      return grid_widget(id, std::get<std::string>(value), context.grids);
    case ParamType::Text:
      return text_widget(id, std::get<std::string>(value));
    case ParamType::File: {
      const std::string name = std::filesystem::path(std::get<std::string>(value)).filename().string();
      browse = ui::button(((name.empty() ? std::string("choose...") : name) + "##" + p.label).c_str(),
                          {ImGui::CalcItemWidth(), 0});
      return std::nullopt;
    }
    case ParamType::Point:
    case ParamType::Vector:
      return vector_widget(p, id, std::get<Numbers>(value));
    case ParamType::Color:
      return color_widget(p, id, std::get<Numbers>(value));
    case ParamType::Resolution:
      return fields_widget(p, id, std::get<Numbers>(value), 2);
    case ParamType::Matrix:
      return fields_widget(p, id, std::get<Numbers>(value), 4);
    case ParamType::NumberList:
      return fields_widget(p, id, std::get<Numbers>(value), 3);
    case ParamType::SettingList:
      return settings_widget(id, std::get<Settings>(value));
  }
  return std::nullopt;
}

/// The small switch before the widget. @return whether the value is "auto" now
bool auto_switch(const Param& p, bool is_auto, std::optional<Value>& edited, const ParamRowContext& context) {
  const float width = ImGui::CalcItemWidth();
  const ui::Scope scope(p.label.c_str());
  if (ui::checkbox("##auto", is_auto)) {
    edited = is_auto ? Value(Auto{}) : p.manual_value;
    if (!is_auto && context.automatic_value && p.type == ParamType::Number)
      edited = clamped(p, *context.automatic_value);
    if (!is_auto && context.automatic_value && p.type == ParamType::Int)
      edited = Value(static_cast<std::int64_t>(*context.automatic_value));
  }
  ui::tooltip_on_hover("Auto: " + *p.automatic + ".");
  ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
  ImGui::SetNextItemWidth(width - ImGui::GetFrameHeight() - ImGui::GetStyle().ItemInnerSpacing.x);
  return is_auto;
}

}  // namespace

ParamEdit param_row(const Param& p, const Value& value, const ParamRowContext& context) {
  ParamEdit edit;
  ui::PropertyRow row(
      p.label.c_str(),
      {.doc = help_text(p), .modified = context.changed, .reset_help = context.reset_help, .dragged = context.dragged});
  bool is_auto = std::holds_alternative<Auto>(value);
  if (p.automatic) is_auto = auto_switch(p, is_auto, edit.value, context);
  if (is_auto) {
    char text[64] = "auto";
    if (context.automatic_value) std::snprintf(text, sizeof text, "auto: %.4g", *context.automatic_value);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", text);
  } else if (!std::holds_alternative<Auto>(value)) {
    ImGui::BeginGroup();
    auto changed = widget(p, row.id(), value, context, edit.browse);
    ImGui::EndGroup();
    if (changed) edit.value = std::move(changed);
  } else {
    ImGui::NewLine();  // the switch was turned in this frame; the widget comes with the next
  }
  const bool active = ui::item_active();  // of the widget: finish() may draw the reset button after it
  edit.reset = row.finish();
  // A drag is done when it ends; switches, combos, buttons and typed values are done at once.
  edit.finished = row.edit_finished() || edit.reset || (edit.value && !active);
  return edit;
}

}  // namespace brume
