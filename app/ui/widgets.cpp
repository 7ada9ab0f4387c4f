#include "app/ui/widgets.h"

#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "app/ui/icons.h"
#include "app/ui/keys.h"

namespace brume::ui {

namespace {

// Records the framed part of the widget drawn last; ImGui's own rectangle includes the label at its right.
void record_framed(const char* label, float width) {
  const ImVec2 min = ImGui::GetItemRectMin();
  record_item(label, min, {min.x + width, min.y + ImGui::GetFrameHeight()});
}

void close_on_escape() {
  if (shortcut(Key::Escape)) ImGui::CloseCurrentPopup();
}

template <class EntryAt> bool combo_of(const char* label, int& index, int count, EntryAt entry_at) {
  const float width = ImGui::CalcItemWidth();
  const ImVec2 min = ImGui::GetCursorScreenPos();
  const char* preview = index >= 0 && index < count ? entry_at(index) : "-";
  bool changed = false;
  // A group, so that choosing an entry (an item of the popup) counts as an edit of the combo.
  ImGui::BeginGroup();
  const bool open = ImGui::BeginCombo(label, preview, ImGuiComboFlags_HeightLarge | ImGuiComboFlags_NoArrowButton);
  if (open) {
    {
      const Scope scope(label);  // of the popup's ids: it has to end before the popup does
      for (int i = 0; i < count; ++i) {
        ImGui::PushID(i);
        if (selectable(entry_at(i), i == index) && i != index) {
          index = i;
          changed = true;
        }
        if (i == index && ImGui::IsWindowAppearing()) ImGui::SetItemDefaultFocus();
        ImGui::PopID();
      }
    }
    close_on_escape();
    ImGui::EndCombo();
  }
  ImGui::EndGroup();
  const float height = ImGui::GetFrameHeight();
  draw_chevron({min.x + width - height * 0.5f, min.y + height * 0.5f}, ImGui::GetFontSize() * 0.55f, true,
               ImGui::GetColorU32(ImGuiCol_TextDisabled));
  record_item(label, min, {min.x + width, min.y + height});
  return changed;
}

}  // namespace

bool begin_window(const char* title, bool* open, ImGuiWindowFlags flags) {
  const bool shown = ImGui::Begin(title, open, flags);
  if (ItemRecorder* recorder = ItemRecorder::current()) {
    const ImVec2 min = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    record_area(title, min, {min.x + size.x, min.y + size.y},
                ImGui::IsWindowHovered(ImGuiHoveredFlags_RootAndChildWindows));
    recorder->begin_window(title);
  }
  return shown;
}

void end_window() {
  if (ItemRecorder* recorder = ItemRecorder::current()) recorder->end_window();
  ImGui::End();
}

bool begin_child(const char* label, ImVec2 size, bool border, ImGuiWindowFlags flags) {
  const bool shown = ImGui::BeginChild(label, size, border, flags);
  const ImVec2 min = ImGui::GetWindowPos(), extent = ImGui::GetWindowSize();
  record_area(label, min, {min.x + extent.x, min.y + extent.y}, ImGui::IsWindowHovered());
  return shown;
}

void end_child() { ImGui::EndChild(); }

bool begin_main_menu_bar() {
  if (!ImGui::BeginMainMenuBar()) return false;
  if (ItemRecorder* recorder = ItemRecorder::current()) recorder->begin_window("Menu");
  return true;
}

void end_main_menu_bar() {
  if (ItemRecorder* recorder = ItemRecorder::current()) recorder->end_window();
  ImGui::EndMainMenuBar();
}

bool menu(const char* label, bool enabled) {
  const bool open = ImGui::BeginMenu(label, enabled);
  ItemRecorder* recorder = ItemRecorder::current();
  if (!open) {
    // Another menu of the bar may be open: this one is reachable all the same.
    const bool hovered = ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenBlockedByPopup);
    record_area(label, ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), hovered);
    return false;
  }
  if (recorder) {
    recorder->record_again(recorder->path(label));
    recorder->push_scope(label);
  }
  close_on_escape();
  return true;
}

void end_menu() {
  if (ItemRecorder* recorder = ItemRecorder::current()) recorder->pop_scope();
  ImGui::EndMenu();
}

bool menu_item(const char* label, const char* keys, bool selected, bool enabled) {
  const bool chosen = ImGui::MenuItem(label, keys, selected, enabled);
  record_item(label);
  return chosen;
}

void open_popup(const char* name) { ImGui::OpenPopup(name); }

bool begin_popup(const char* name) {
  if (!ImGui::BeginPopup(name)) return false;
  if (ItemRecorder* recorder = ItemRecorder::current()) recorder->begin_window(name);
  close_on_escape();
  return true;
}

void end_popup() {
  if (ItemRecorder* recorder = ItemRecorder::current()) recorder->end_window();
  ImGui::EndPopup();
}

bool begin_modal(const char* title) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({display.x * 0.5f, display.y * 0.5f}, ImGuiCond_Appearing, {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings))
    return false;
  if (ItemRecorder* recorder = ItemRecorder::current()) recorder->begin_window(title);
  close_on_escape();
  return true;
}

void end_modal() { end_popup(); }

bool button(const char* label, ImVec2 size) {
  const bool pressed = ImGui::Button(label, size);
  record_item(label);
  return pressed;
}

bool small_button(const char* label) {
  const bool pressed = ImGui::SmallButton(label);
  record_item(label);
  return pressed;
}

bool checkbox(const char* label, bool& value) {
  const bool changed = ImGui::Checkbox(label, &value);
  record_framed(label, ImGui::GetFrameHeight());
  return changed;
}

bool selectable(const char* label, bool selected, ImVec2 size) {
  const bool clicked = ImGui::Selectable(label, selected, 0, size);
  record_item(label);
  return clicked;
}

bool combo(const char* label, int& index, std::span<const std::string> entries) {
  return combo_of(label, index, static_cast<int>(entries.size()),
                  [&](int i) { return entries[static_cast<size_t>(i)].c_str(); });
}

bool combo(const char* label, int& index, std::span<const char* const> entries) {
  return combo_of(label, index, static_cast<int>(entries.size()),
                  [&](int i) { return entries[static_cast<size_t>(i)]; });
}

// Drawn here: ImGui's header has a large arrow and indents the text far from it.
bool collapsing_header(const char* label, bool default_open) {
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID id = ImGui::GetID(label);
  bool open = storage.GetBool(id, default_open);
  const ImGuiStyle& style = ImGui::GetStyle();
  const ImVec2 min = ImGui::GetCursorScreenPos();
  const ImVec2 size(std::max(1.0f, ImGui::GetContentRegionAvail().x), ImGui::GetFrameHeight());
  if (ImGui::InvisibleButton(label, size)) storage.SetBool(id, open = !open);

  const float em = ImGui::GetFontSize();
  const ImVec2 max(min.x + size.x, min.y + size.y);
  const ImVec4 bar =
      ImGui::GetStyleColorVec4(ImGui::IsItemHovered() ? ImGuiCol_FrameBgHovered : ImGuiCol_TableHeaderBg);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(min, max, ImGui::GetColorU32(bar), style.FrameRounding);
  draw_chevron({min.x + em * 0.85f, min.y + size.y * 0.5f}, em * 0.55f, open,
               ImGui::GetColorU32(ImGuiCol_TextDisabled));
  const std::string_view name = ItemRecorder::name_of(label);
  list->AddText({min.x + em * 1.6f, min.y + style.FramePadding.y}, ImGui::GetColorU32(ImGuiCol_Text), name.data(),
                name.data() + name.size());
  record_item(label, min, max);
  return open;
}

bool input_text(const char* label, std::string& text, const char* hint) {
  const float width = ImGui::CalcItemWidth();
  const bool changed = ImGui::InputTextWithHint(label, hint, &text);
  record_framed(label, width);
  return changed;
}

bool canvas(const char* label, ImVec2 size) {
  const ImVec2 area(std::max(1.0f, size.x), std::max(1.0f, size.y));  // ImGui forbids a button of no size
  ImGui::InvisibleButton(
      label, area,
      ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
  record_item(label);
  return ImGui::IsItemHovered() || ImGui::IsItemActive();
}

void tooltip_on_hover(std::string_view text) {
  constexpr float kDelay = 0.45f;  // seconds: long enough not to flicker while the mouse passes over a column of fields
  if (text.empty() || ImGui::IsAnyMouseDown() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;

  // How long the mouse has been here is kept in the window's storage: reset when a frame was missed.
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImVec2 min = ImGui::GetItemRectMin();
  ImGui::PushID(static_cast<int>(min.x) * 65537 + static_cast<int>(min.y));
  const ImGuiID frame_key = ImGui::GetID("tooltip frame"), time_key = ImGui::GetID("tooltip time");
  ImGui::PopID();
  const int frame = ImGui::GetFrameCount();
  const bool stayed = storage.GetInt(frame_key, -2) == frame - 1;
  const float rested = stayed ? storage.GetFloat(time_key) + ImGui::GetIO().DeltaTime : 0;
  storage.SetInt(frame_key, frame);
  storage.SetFloat(time_key, rested);
  if (rested < kDelay) return;

  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
  if (ItemRecorder* recorder = ItemRecorder::current()) recorder->record_tooltip(text);
}

bool item_deactivated_after_edit() { return ImGui::IsItemDeactivatedAfterEdit(); }

bool item_active() { return ImGui::IsItemActive(); }

}  // namespace brume::ui
