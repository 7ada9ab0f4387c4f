// The few signs that fonts do not have, drawn.
#pragma once

#include <imgui.h>

namespace brume::ui {

/// An open arrow head pointing right or down; `size` is about its height.
void draw_chevron(ImVec2 center, float size, bool down, ImU32 color);

/// A circle that ends in an arrow head, counterclockwise: back to where it was.
void draw_reset_arrow(ImVec2 center, float radius, ImU32 color);

}  // namespace brume::ui
