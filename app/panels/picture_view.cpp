#include "app/panels/picture_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace brume {

ImVec2 PictureArea::to_picture(const ViewState& view, ImVec2 screen) const {
  return {view.center_x + ((screen.x - min.x) / width() - 0.5f) / view.zoom,
          view.center_y + ((screen.y - min.y) / height() - 0.5f) / view.zoom};
}

ImVec2 PictureArea::to_screen(const ViewState& view, ImVec2 place) const {
  return {min.x + width() * (0.5f + (place.x - view.center_x) * view.zoom),
          min.y + height() * (0.5f + (place.y - view.center_y) * view.zoom)};
}

void PictureTexture::show(const std::shared_ptr<const Picture>& picture, const DisplaySettings& settings) {
  if (!picture || (picture == uploaded_ && settings == settings_)) return;
  to_display(picture->image, settings, 4, display_);
  if (!texture_.upload(display_.width, display_.height, display_.bytes)) return;
  uploaded_ = picture;
  settings_ = settings;
}

void PictureTexture::show(const Image8& rgba) {
  static_cast<void>(texture_.upload(rgba.width, rgba.height, rgba.bytes).ok());
  uploaded_.reset();
}

void PictureTexture::draw(const PictureArea& area, const ViewState& view, float clip_left, float clip_right) {
  // Magnified pixels are shown as what they are.
  texture_.set_filter(view.zoom > 1 ? TextureFilter::Nearest : TextureFilter::Linear);
  const ImVec2 low = area.to_picture(view, area.min), high = area.to_picture(view, area.max);
  ImDrawList* draw = ImGui::GetWindowDrawList();
  draw->PushClipRect({std::max(clip_left, area.min.x), area.min.y}, {std::min(clip_right, area.max.x), area.max.y},
                     true);
  draw->AddImage(texture_.id(), area.min, area.max, low, high);
  draw->PopClipRect();
}

void draw_pixel_values(const Image& image, const PictureArea& area, const ViewState& view) {
  const float line = ImGui::GetFontSize() * 0.95f;
  const float pixel = area.width() * view.zoom / static_cast<float>(image.width);
  if (image.empty() || pixel < 4.2f * line) return;
  ImDrawList* draw = ImGui::GetWindowDrawList();
  draw->PushClipRect(area.min, area.max, true);
  const ImVec2 low = area.to_picture(view, area.min), high = area.to_picture(view, area.max);
  const float w = static_cast<float>(image.width), h = static_cast<float>(image.height);
  const int x0 = std::max(0, static_cast<int>(low.x * w)), x1 = std::min(image.width, static_cast<int>(high.x * w) + 1);
  const int y0 = std::max(0, static_cast<int>(low.y * h)),
            y1 = std::min(image.height, static_cast<int>(high.y * h) + 1);
  constexpr ImU32 kChannels[] = {IM_COL32(255, 130, 120, 255), IM_COL32(130, 230, 130, 255),
                                 IM_COL32(140, 170, 255, 255)};
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const ImVec2 middle =
          area.to_screen(view, {(static_cast<float>(x) + 0.5f) / w, (static_cast<float>(y) + 0.5f) / h});
      for (int c = 0; c < 3; ++c) {
        char text[24];
        std::snprintf(text, sizeof text, "%.4g", static_cast<double>(image.at(x, y)[c]));
        const ImVec2 size = ImGui::CalcTextSize(text);
        const ImVec2 at(std::floor(middle.x - size.x / 2),
                        std::floor(middle.y + (static_cast<float>(c) - 1.5f) * line));
        draw->AddText({at.x + 1, at.y + 1}, IM_COL32(0, 0, 0, 200), text);
        draw->AddText(at, kChannels[c], text);
      }
    }
  draw->PopClipRect();
}

}  // namespace brume
