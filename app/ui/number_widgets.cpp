// The widgets of widgets.h that edit numbers.
#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "app/ui/keys.h"
#include "app/ui/widgets.h"

namespace brume::ui {

namespace {

// The number being typed into a field, from the first key to the end of the typing. It lives in the window's own
// storage, which knows no double: two ints hold its bits. A frame in which the field was not drawn ends it.
class TypedNumber {
 public:
  explicit TypedNumber(const char* label) : storage_(*ImGui::GetStateStorage()) {
    ImGui::PushID(label);
    frame_ = ImGui::GetID("typed frame");
    low_ = ImGui::GetID("typed low");
    high_ = ImGui::GetID("typed high");
    ImGui::PopID();
  }

  bool held() const { return storage_.GetInt(frame_, -2) == ImGui::GetFrameCount() - 1; }
  double value() const {
    const auto low = static_cast<std::uint32_t>(storage_.GetInt(low_));
    const auto high = static_cast<std::uint32_t>(storage_.GetInt(high_));
    return std::bit_cast<double>(static_cast<std::uint64_t>(high) << 32 | low);
  }
  void hold(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    storage_.SetInt(frame_, ImGui::GetFrameCount());
    storage_.SetInt(low_, static_cast<int>(static_cast<std::uint32_t>(bits)));
    storage_.SetInt(high_, static_cast<int>(static_cast<std::uint32_t>(bits >> 32)));
  }

 private:
  ImGuiStorage& storage_;
  ImGuiID frame_, low_, high_;
};

// Runs `draw(number, typing)`, an ImGui number field, on a copy of the value. Dragging changes the value at once,
// typing when it ends; Esc gives the typing up.
template <class T, class Draw> bool edit_number(const char* label, T& value, Draw draw) {
  TypedNumber typed(label);
  const bool was_typing = typed.held();
  T number = was_typing ? static_cast<T>(typed.value()) : value;
  draw(number, was_typing);
  if (ImGui::IsItemActive() && ImGui::GetIO().WantTextInput) {
    typed.hold(static_cast<double>(number));
    return false;
  }
  // ImGui puts back the text as it was first shown, which has fewer digits than the value.
  if (was_typing && key_went_down(Key::Escape)) return false;
  if (!std::isfinite(static_cast<double>(number)) || number == value) return false;
  value = number;
  return true;
}

// ImGui's sliders take typing only after Ctrl+click, its drag fields after a double click as well. To be alike, a
// double click on the slider about to be drawn counts as Ctrl+click for as long as this lives.
class DoubleClickTypes {
 public:
  explicit DoubleClickTypes(float width) : io_(ImGui::GetIO()), ctrl_(io_.KeyCtrl) {
    const ImVec2 min = ImGui::GetCursorScreenPos();
    if (ImGui::IsMouseDoubleClicked(0) &&
        ImGui::IsMouseHoveringRect(min, {min.x + width, min.y + ImGui::GetFrameHeight()}))
      io_.KeyCtrl = true;
  }
  ~DoubleClickTypes() { io_.KeyCtrl = ctrl_; }
  DoubleClickTypes(const DoubleClickTypes&) = delete;
  DoubleClickTypes& operator=(const DoubleClickTypes&) = delete;

 private:
  ImGuiIO& io_;
  bool ctrl_;
};

// Digits after the point that printf would show: 3 for "%.3f m"; 6, printf's default, when the format has none.
int precision_of(const char* format) {
  const char* percent = std::strchr(format, '%');
  const char* point = percent ? std::strchr(percent, '.') : nullptr;
  return point ? std::atoi(point + 1) : 6;
}

// Where on the slider the value sits, 0 to 1, as ImGui's sliders reckon: logarithmic ones start at the smallest value
// that the format can show when the range starts at 0.
float slider_fraction(double value, const SliderOptions& options) {
  if (!(options.min < options.max)) return 0;  // a range of one value
  const double clamped = std::clamp(value, options.min, options.max);
  double fraction = (clamped - options.min) / (options.max - options.min);
  if (options.logarithmic) {
    const double low = std::max(options.min, std::pow(10.0, -precision_of(options.format)));
    fraction = clamped <= low || options.max <= low ? 0 : std::log(clamped / low) / std::log(options.max / low);
  }
  return static_cast<float>(std::clamp(fraction, 0.0, 1.0));
}

// Draws a slider as a bar filled up to its value, under an ImGui slider whose own frame and grab are made invisible:
// at a glance a column of bars says more than a column of small grabs.
class FilledBar {
 public:
  /// Filled from one fraction of the range to another. `steps`: how many values the slider can take, 0 for a
  /// continuous one.
  FilledBar(float width, float from, float to, int steps, bool filled) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const ImVec2 min = ImGui::GetCursorScreenPos();
    const ImVec2 max(min.x + width, min.y + ImGui::GetFrameHeight());
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(min, max, ImGui::GetColorU32(ImGuiCol_FrameBg), style.FrameRounding);
    // ImGui keeps 2 pixels free at both ends and gives every step of an int slider its share of the rest.
    const float padding = 2, usable = width - 2 * padding;
    const float grab = std::min(usable, std::max(kGrab, steps > 0 ? usable / static_cast<float>(steps) : 0.0f));
    const auto position = [&](float fraction) {
      return fraction <= 0 ? min.x : fraction >= 1 ? max.x : min.x + padding + grab * 0.5f + fraction * (usable - grab);
    };
    if (filled) {
      // A step is filled as a whole. Clipped rather than drawn narrow, so that the rounded corners stay the frame's.
      const float half_step = steps > 0 ? grab * 0.5f : 0.0f;
      const float left = position(std::min(from, to)), right = position(std::max(from, to)) + half_step;
      list->PushClipRect({left - (left > min.x ? 1.0f : 0.0f), min.y}, {std::min(right, max.x), max.y}, true);
      list->AddRectFilled(min, max, ImGui::GetColorU32(ImGuiCol_SliderGrab), style.FrameRounding);
      list->PopClipRect();
    }
    ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, kGrab);
    ImGui::PushStyleColor(ImGuiCol_FrameBg, ImVec4(0, 0, 0, 0));
    ImGui::PushStyleColor(ImGuiCol_FrameBgHovered, ImVec4(1, 1, 1, 0.06f));
    ImGui::PushStyleColor(ImGuiCol_FrameBgActive, ImVec4(1, 1, 1, 0.09f));
    ImGui::PushStyleColor(ImGuiCol_SliderGrab, ImVec4(0, 0, 0, 0));
    ImGui::PushStyleColor(ImGuiCol_SliderGrabActive, ImVec4(0, 0, 0, 0));
  }
  ~FilledBar() {
    ImGui::PopStyleColor(5);
    ImGui::PopStyleVar();
  }
  FilledBar(const FilledBar&) = delete;
  FilledBar& operator=(const FilledBar&) = delete;

 private:
  static constexpr float kGrab = 1;
};

void record_framed(const char* label, ImVec2 min, float width) {
  record_item(label, min, {min.x + width, min.y + ImGui::GetFrameHeight()});
}

// A thin line at the left edge of the widget drawn last: red, green and blue for x, y and z.
void mark_axis(int axis) {
  constexpr ImU32 kAxisColors[] = {IM_COL32(196, 82, 82, 255), IM_COL32(106, 160, 84, 255),
                                   IM_COL32(84, 128, 196, 255)};
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  const float thickness = std::floor(ImGui::GetFontSize() * 0.16f), inset = ImGui::GetStyle().FrameRounding;
  ImGui::GetWindowDrawList()->AddRectFilled({min.x, min.y + inset}, {min.x + thickness, max.y - inset},
                                            kAxisColors[axis]);
}

// sRGB transfer functions, IEC 61966-2-1.
float encode_srgb(float linear) {
  const float x = std::clamp(linear, 0.0f, 1.0f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}
float decode_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

bool color_picker(Color& linear) {
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID key = ImGui::GetID("picker intensity");
  if (ImGui::IsWindowAppearing()) storage.SetFloat(key, std::max(1.0f, max_channel(linear)));
  // Fixed while the picker is open: taken anew each frame it would undo every change of brightness.
  const float intensity = std::max(1.0f, storage.GetFloat(key, 1));
  float encoded[3] = {encode_srgb(linear.r / intensity), encode_srgb(linear.g / intensity),
                      encode_srgb(linear.b / intensity)};
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 14);
  if (!ImGui::ColorPicker3("##picker", encoded, ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoSidePreview))
    return false;
  linear = Color(decode_srgb(encoded[0]), decode_srgb(encoded[1]), decode_srgb(encoded[2])) * intensity;
  return true;
}

}  // namespace

bool slider_float(const char* label, double& value, const SliderOptions& options) {
  const float width = ImGui::CalcItemWidth();
  const ImVec2 min = ImGui::GetCursorScreenPos();
  ImGuiSliderFlags flags = 0;
  if (options.clamp) flags |= ImGuiSliderFlags_AlwaysClamp;
  if (options.logarithmic) flags |= ImGuiSliderFlags_Logarithmic;
  const bool changed = edit_number(label, value, [&](double& number, bool typing) {
    // A range with both signs is filled from zero, so that the sign is seen.
    const float zero = options.logarithmic ? 0.0f : slider_fraction(0, options);
    const FilledBar bar(width, zero, slider_fraction(number, options), 0, !typing);
    const DoubleClickTypes typing_by_double_click(width);
    ImGui::SliderScalar(label, ImGuiDataType_Double, &number, &options.min, &options.max, options.format, flags);
  });
  record_framed(label, min, width);
  return changed;
}

bool slider_int(const char* label, int& value, int min, int max, const char* format, bool clamp) {
  const float width = ImGui::CalcItemWidth();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const bool changed = edit_number(label, value, [&](int& number, bool typing) {
    const SliderOptions range{.min = static_cast<double>(min), .max = static_cast<double>(max)};
    const FilledBar bar(width, 0, slider_fraction(number, range), max - min + 1, !typing);
    const DoubleClickTypes typing_by_double_click(width);
    ImGui::SliderInt(label, &number, min, max, format, clamp ? ImGuiSliderFlags_AlwaysClamp : 0);
  });
  record_framed(label, corner, width);
  return changed;
}

bool drag_float(const char* label, double& value, const DragOptions& options) {
  const float width = ImGui::CalcItemWidth();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const double min = std::max(options.min, -DBL_MAX), max = std::min(options.max, DBL_MAX);
  const double speed = options.speed > 0 ? options.speed : std::max(0.01, std::abs(value) * 0.005);
  const bool changed = edit_number(label, value, [&](double& number, bool) {
    ImGui::DragScalar(label, ImGuiDataType_Double, &number, static_cast<float>(speed), &min, &max, options.format,
                      ImGuiSliderFlags_AlwaysClamp);
  });
  record_framed(label, corner, width);
  return changed;
}

bool drag_vec3(const char* label, Vec3d& value, const DragOptions& options) {
  const float gap = std::floor(ImGui::GetStyle().ItemInnerSpacing.x * 0.5f), width = ImGui::CalcItemWidth();
  const float third = std::floor((width - 2 * gap) / 3);
  const bool stacked = third < ImGui::GetFontSize() * 3.2f;  // 3.2 em: "-10.000" no longer fits
  const char* const axes[] = {"##x", "##y", "##z"};
  bool changed = false;
  ImGui::BeginGroup();
  {
    const Scope scope(label);
    if (stacked) ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, gap});
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0 && !stacked) ImGui::SameLine(0, gap);
      ImGui::SetNextItemWidth(stacked ? width : axis < 2 ? third : width - 2 * (third + gap));
      changed |= drag_float(axes[axis], value[axis], options);
      mark_axis(axis);
    }
    if (stacked) ImGui::PopStyleVar();
  }
  ImGui::EndGroup();
  return changed;
}

bool input_double(const char* label, double& value, const char* format) {
  const float width = ImGui::CalcItemWidth();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const bool changed = edit_number(label, value, [&](double& number, bool) {
    ImGui::InputDouble(label, &number, 0, 0, format, ImGuiInputTextFlags_AutoSelectAll);
  });
  record_framed(label, corner, width);
  return changed;
}

bool color_edit(const char* label, Color& linear, const DragOptions& options) {
  const float gap = std::floor(ImGui::GetStyle().ItemInnerSpacing.x * 0.5f), side = ImGui::GetFrameHeight();
  const float width = ImGui::CalcItemWidth() - side - gap;
  const float third = std::floor((width - 2 * gap) / 3);
  const bool stacked = third < ImGui::GetFontSize() * 2.6f;  // 2.6 em: "10.00" no longer fits
  const char* const channels[] = {"##r", "##g", "##b"};
  bool changed = false;
  ImGui::BeginGroup();
  {
    const Scope scope(label);
    const float intensity = std::max(1.0f, max_channel(linear));
    const ImVec4 shown(encode_srgb(linear.r / intensity), encode_srgb(linear.g / intensity),
                       encode_srgb(linear.b / intensity), 1);
    if (ImGui::ColorButton("##swatch", shown, ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop,
                           {side, side}))
      ImGui::OpenPopup("picker");
    record_item("##swatch");
    const ImVec2 swatch_min = ImGui::GetItemRectMin(), below(swatch_min.x, ImGui::GetItemRectMax().y + gap);
    for (int channel = 0; channel < 3; ++channel) {
      if (!stacked || channel == 0)
        ImGui::SameLine(0, gap);
      else
        ImGui::SetCursorScreenPos({swatch_min.x + side + gap, ImGui::GetItemRectMax().y + gap});
      ImGui::SetNextItemWidth(stacked ? width : channel < 2 ? third : width - 2 * (third + gap));
      double value = linear[channel];
      if (drag_float(channels[channel], value, options)) {
        linear[channel] = static_cast<float>(value);
        changed = true;
      }
    }
    ImGui::SetNextWindowPos(below, ImGuiCond_Appearing);
    if (ImGui::BeginPopup("picker")) {
      changed |= color_picker(linear);
      record_item("##picker");
      if (shortcut(Key::Escape)) ImGui::CloseCurrentPopup();
      ImGui::EndPopup();
    }
  }
  ImGui::EndGroup();
  return changed;
}

}  // namespace brume::ui
