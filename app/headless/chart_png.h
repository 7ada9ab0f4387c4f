// A chart as a picture, drawn by ImGui as in the window.
#pragma once

#include <string>

#include "renderer/analysis/chart_layout.h"
#include "renderer/core/error.h"

namespace brume {

/// Writes the drawing as a PNG of its size.  Errors: no OpenGL; the file cannot be written.
Result<void> write_chart_png(const std::string& path, const Drawing& drawing);

}  // namespace brume
