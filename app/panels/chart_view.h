// A chart in a window: the same drawing as in a report, and the values of the point under the mouse.
#pragma once

#include <imgui.h>

#include "renderer/analysis/chart_layout.h"

namespace brume {

/// Adds the drawing, its background included, with its top left corner at `origin` (display coordinates). Texts are in
/// ImGui's current font.
void draw_chart(const Drawing& drawing, ImDrawList& list, ImVec2 origin);

/// A chart as a widget, on the dark ground and in the size of the current font. The point nearest to the mouse is
/// ringed at once; its series, x and y show as a tooltip. The robot finds it as "Window/label".
/// @param size  in pixels; what is below 1 counts as 1.
void chart_view(const char* label, const Chart& chart, ImVec2 size);

}  // namespace brume
