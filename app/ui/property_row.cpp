#include "app/ui/property_row.h"

#include <algorithm>
#include <cmath>

#include "app/ui/icons.h"
#include "app/ui/widgets.h"

namespace brume::ui {

namespace {

// Cut to fit `width`, ending in dots; UTF-8 sequences are never cut in half.
std::string fitting(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  std::string cut = text;
  while (!cut.empty()) {
    do cut.pop_back();
    while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0x80) != 0 &&
           (static_cast<unsigned char>(cut.back()) & 0xC0) != 0xC0);
    if (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0) == 0xC0) cut.pop_back();
    if (ImGui::CalcTextSize((cut + "...").c_str()).x <= width) break;
  }
  return cut + "...";
}

}  // namespace

PropertyRow::PropertyRow(const char* label, const PropertyRowOptions& options)
    : label_(label), id_(std::string("##") + label), options_(options) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float em = ImGui::GetFontSize();
  // Measured from the window's edge, not from the indentation, so that nested sections keep one column.
  const float left = style.WindowPadding.x;
  const float right = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x;
  const float widget_x = left + std::floor(std::clamp((right - left) * 0.36f, em * 6, em * 12));
  reset_x_ = right - std::floor(em * 1.15f);

  const float label_x = ImGui::GetCursorPosX();
  const float label_width = widget_x - label_x - style.ItemInnerSpacing.x;
  const std::string name(ItemRecorder::name_of(label_));
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text,
                        ImGui::GetStyleColorVec4(options_.modified ? ImGuiCol_Text : ImGuiCol_TextDisabled));
  const std::string shown = fitting(name, label_width);
  ImGui::TextUnformatted(shown.c_str());
  ImGui::PopStyleColor();
  if (!options_.dragged.empty()) {
    const Scope scope(label_.c_str());
    record_item("name");
    if (ImGui::BeginDragDropSource(ImGuiDragDropFlags_SourceAllowNullID)) {
      ImGui::SetDragDropPayload(kDraggedSetting, options_.dragged.data(), options_.dragged.size());
      ImGui::TextUnformatted(options_.dragged.c_str());
      ImGui::EndDragDropSource();
    }
  }
  tooltip_on_hover(shown == name || options_.doc.empty() ? (shown == name ? options_.doc : name)
                                                         : name + "\n" + options_.doc);

  ImGui::SameLine(widget_x);
  ImGui::SetNextItemWidth(std::max(em * 2, reset_x_ - widget_x - std::floor(style.ItemInnerSpacing.x * 0.5f)));
}

bool PropertyRow::finish() {
  edit_finished_ = item_deactivated_after_edit();
  tooltip_on_hover(options_.doc);
  if (!options_.modified) return false;

  const float em = ImGui::GetFontSize(), height = ImGui::GetFrameHeight();
  const float top = ImGui::GetItemRectMin().y;
  ImGui::SameLine(reset_x_);
  const ImVec2 corner(ImGui::GetCursorScreenPos().x, top), size(std::floor(em * 1.15f), height);
  ImGui::SetCursorScreenPos(corner);
  const Scope scope(label_.c_str());
  const bool pressed = ImGui::InvisibleButton("##reset", size);
  const ImGuiCol color = ImGui::IsItemActive() || ImGui::IsItemHovered() ? ImGuiCol_Text : ImGuiCol_TextDisabled;
  draw_reset_arrow({std::floor(corner.x + size.x * 0.55f) + 0.5f, std::floor(corner.y + height * 0.5f) + 0.5f},
                   em * 0.3f, ImGui::GetColorU32(color));
  record_item("##reset");
  tooltip_on_hover(options_.reset_help);
  edit_finished_ |= pressed;
  return pressed;
}

}  // namespace brume::ui
