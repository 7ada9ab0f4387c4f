#include "app/panels/view_state.h"

#include <algorithm>

namespace brume {

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
