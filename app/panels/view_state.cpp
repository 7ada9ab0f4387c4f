#include "app/panels/view_state.h"

#include <algorithm>

namespace brume {

void ViewState::choose_among(std::size_t count) {
  shown = std::min(shown, std::max<std::size_t>(count, 1) - 1);
  if (count < 2) return;  // a choice made earlier stays for when there is something to choose
  other = std::min(other, count - 1);
  if (other == shown) other = shown == 0 ? 1 : 0;
}

void ViewState::clamp() {
  constexpr float kMaxZoom = 256;
  zoom = std::clamp(zoom, 1.0f, kMaxZoom);
  const float half = 0.5f / zoom;
  center_x = std::clamp(center_x, half, 1 - half);
  center_y = std::clamp(center_y, half, 1 - half);
}

void ViewState::zoom_about(float x, float y, float factor) {
  const float before = zoom;
  zoom *= factor;
  clamp();
  center_x = x + (center_x - x) * before / zoom;
  center_y = y + (center_y - y) * before / zoom;
  clamp();
}

}  // namespace brume
