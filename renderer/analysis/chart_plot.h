// What a chart shows inside its frame: guides, levels, series, marks and their labels.
#pragma once

#include "renderer/analysis/chart_layout.h"
#include "renderer/analysis/chart_style.h"

namespace brume {

/// Adds the shapes of everything inside the frame to the drawing, faint things first. Labels go where they cover
/// neither each other nor, as far as there is room, a line.
void plot(const Chart& chart, const Projection& projection, const ChartStyle& style, Drawing& drawing);

/// A horizontal piece of a line with a marker in its middle, as the series shows them, for a legend.
void plot_sample(const Series& series, std::array<float, 2> from, float length, const ChartStyle& style,
                 Drawing& drawing);

}  // namespace brume
