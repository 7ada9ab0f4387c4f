#include "app/ui/icons.h"

#include <algorithm>
#include <cmath>

#include "renderer/core/vec.h"

namespace brume::ui {

void draw_chevron(ImVec2 center, float size, bool down, ImU32 color) {
  const float along = size * 0.25f, across = size * 0.5f;
  const ImVec2 right[] = {
      {center.x - along, center.y - across}, {center.x + along, center.y}, {center.x - along, center.y + across}};
  const ImVec2 below[] = {
      {center.x - across, center.y - along}, {center.x, center.y + along}, {center.x + across, center.y - along}};
  ImGui::GetWindowDrawList()->AddPolyline(down ? below : right, 3, color, 0, std::max(1.2f, size * 0.18f));
}

void draw_reset_arrow(ImVec2 center, float radius, ImU32 color) {
  // With y down, angles grow clockwise: the head sits left of the top and points left, the gap follows it.
  constexpr float kHead = -0.52f * kPi, kTail = 0.86f * kPi;
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PathArcTo(center, radius, kHead, kTail, 24);
  list->PathStroke(color, 0, std::max(1.2f, radius * 0.3f));
  const ImVec2 outward(std::cos(kHead), std::sin(kHead)), onward(std::sin(kHead), -std::cos(kHead));
  const ImVec2 base(center.x + radius * outward.x, center.y + radius * outward.y);
  const float half = radius * 0.68f, length = radius * 0.95f;
  list->AddTriangleFilled({base.x + onward.x * length, base.y + onward.y * length},
                          {base.x + outward.x * half, base.y + outward.y * half},
                          {base.x - outward.x * half, base.y - outward.y * half}, color);
}

}  // namespace brume::ui
