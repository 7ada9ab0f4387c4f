// Lines of a chart as far as its frame shows them.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "renderer/analysis/chart_layout.h"

namespace brume {

struct Segment {
  std::array<double, 2> from = {}, to = {};
};

/// The part inside the rectangle, edges included; nothing when there is none or an end is not finite.
/// Liang & Barsky 1984, "A New Concept and Method for Line Clipping".
std::optional<Segment> clipped(const Segment& segment, std::array<double, 2> min, std::array<double, 2> max);

/// A point in pixels, in the precision that clipping far points needs.
std::array<double, 2> to_far_pixels(const Projection& projection, std::array<double, 2> point);

using PixelLine = std::vector<std::array<float, 2>>;

/// The line through the points, cut at the frame and interrupted at points without a place: pieces of two points or
/// more. Where many points fall into a column of pixels, the first, last, lowest and highest stand for them: Jugel et
/// al. 2014, "M4: A Visualization-Oriented Time Series Data Aggregation".
std::vector<PixelLine> lines_in_frame(std::span<const std::array<double, 2>> points, const Projection& projection);

}  // namespace brume
