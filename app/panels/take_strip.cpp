#include "app/panels/take_strip.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/session/display.h"
#include "app/ui/formatted.h"
#include "app/ui/widgets.h"

namespace brume {
namespace {

/// Means of blocks, so that about `rows` rows are left.
Image shrunk(const Image& image, int rows) {
  const int block = std::max(1, image.height / rows);
  Image small(std::max(1, image.width / block), std::max(1, image.height / block));
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      Color sum;
      for (int j = 0; j < block; ++j)
        for (int i = 0; i < block; ++i) sum += image.at(x * block + i, y * block + j);
      small.at(x, y) = sum / static_cast<float>(block * block);
    }
  return small;
}

std::string told(const Take& take) {
  const RenderStatistics& s = take.picture->statistics;
  return "Take " + std::to_string(take.number) + ": " + take.name + ", " + std::to_string(s.samples_per_pixel) +
         formatted(" spp, %.2f CPU s", s.cpu_seconds) +
         ".\nA click brings back its scene (Ctrl+Z undoes that); a right click exports or removes it.";
}

}  // namespace

TakeStrip::Thumbnail& TakeStrip::thumbnail(const Take& take) {
  const auto known =
      std::find_if(thumbnails_.begin(), thumbnails_.end(), [&](const Thumbnail& t) { return t.number == take.number; });
  if (known != thumbnails_.end()) return *known;
  constexpr int kRows = 160;
  const Image small = shrunk(take.picture->image, kRows);
  Thumbnail& made = thumbnails_.emplace_back(
      Thumbnail{take.number, static_cast<float>(take.picture->width) / static_cast<float>(take.picture->height),
                PictureTexture(gl_)});
  Image8 display;
  to_display(small, display_settings(take.description.child("film")), 4, display);
  made.texture.show(display);
  return made;
}

std::optional<std::size_t> TakeStrip::draw(Session& session) {
  std::erase_if(thumbnails_, [&](const Thumbnail& t) {
    return std::none_of(session.takes().begin(), session.takes().end(),
                        [&](const Take& take) { return take.number == t.number; });
  });
  std::optional<std::size_t> exported, removed;
  const float height = ImGui::GetContentRegionAvail().y - ImGui::GetStyle().ScrollbarSize;
  for (std::size_t i = 0; i < session.takes().size(); ++i) {
    const Take& take = session.takes()[i];
    Thumbnail& small = thumbnail(take);
    const std::string name = "take " + std::to_string(take.number);
    if (i > 0) ImGui::SameLine();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size(std::floor(height * small.aspect), height);
    ui::canvas(name.c_str(), size);
    const bool hovered = ImGui::IsItemHovered();
    const bool clicked = hovered && ImGui::IsItemDeactivated();  // pressed and released here
    if (clicked && ImGui::IsMouseReleased(ImGuiMouseButton_Left)) session.restore_take(i);
    if (clicked && ImGui::IsMouseReleased(ImGuiMouseButton_Right)) ui::open_popup(name.c_str());
    ui::tooltip_on_hover(told(take));
    small.texture.draw({corner, {corner.x + size.x, corner.y + size.y}}, {});
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddText({corner.x + 0.4f * ImGui::GetFontSize(), corner.y + 0.2f * ImGui::GetFontSize()},
                  ImGui::GetColorU32(ImGuiCol_Text), std::to_string(take.number).c_str());
    if (hovered)
      draw->AddRect(corner, {corner.x + size.x, corner.y + size.y}, ImGui::GetColorU32(ImGuiCol_Text), 0, 0, 1.5f);
    if (ui::begin_popup(name.c_str())) {
      if (ui::selectable("Restore", false)) session.restore_take(i);
      if (ui::selectable("Export...", false)) exported = i;
      if (ui::selectable("Remove", false)) removed = i;
      ui::end_popup();
    }
  }
  if (removed) session.remove_take(*removed);
  return exported;
}

}  // namespace brume
