// Charts as files.
#pragma once

#include <string>

#include "renderer/analysis/chart_layout.h"
#include "renderer/experiments/sweep.h"

namespace brume {

/// Writes the drawing (.svg, or .png drawn by ImGui as in the window) or the numbers behind it (.csv).
/// Errors: another extension; no OpenGL for a .png; the file cannot be written.
Result<void> write_chart(const std::string& path, const Drawing& drawing, const Sweep& sweep);

}  // namespace brume
