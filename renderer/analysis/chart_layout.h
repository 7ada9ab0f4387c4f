// Where the lines and texts of a chart go, in pixels.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "renderer/analysis/chart.h"

namespace brume {

// ---- A drawing: the few shapes that every canvas has ----------------------------------------------------------------
//
// Pixels, origin at the top left, x right, y down; a pixel's middle lies at halves. Colours are opaque: what is to look
// faint was mixed with the background. Later shapes cover earlier ones.

/// Strokes and gaps of dashed lines, in widths of the line, from its first point on.
inline constexpr float kDashStroke = 4, kDashGap = 3;

struct Line {
  std::array<float, 2> from = {}, to = {};
  Rgb color = {};
  float width = 1;
  bool dashed = false;
};

/// Two points or more, with round or mitred joints, whatever the canvas does best.
struct Polyline {
  std::vector<std::array<float, 2>> points = {};
  Rgb color = {};
  float width = 1;
  bool dashed = false;
};

/// Filled.
struct Rect {
  std::array<float, 2> min = {}, max = {};
  Rgb color = {};
};

struct Disc {
  std::array<float, 2> center = {};
  float radius = 1;
  Rgb color = {};
  float ring = 0;  ///< width of the line of a ring, whose middle is at the radius; 0: a filled disc
};

enum class TextAnchor { Start, Middle, End };

/// One line of UTF-8.
struct Text {
  std::array<float, 2> position = {};  ///< the anchor on the baseline
  TextAnchor anchor = TextAnchor::Start;
  float size = 14;  ///< of the em
  Rgb color = {};
  std::string text = {};
  bool rotated = false;  ///< by 90 degrees against the clock about `position`: it reads upwards
};

struct Drawing {
  using Shape = std::variant<Line, Polyline, Rect, Disc, Text>;

  float width = 0, height = 0;
  Rgb background = {};
  std::vector<Shape> shapes = {};
};

// ---- The layout -----------------------------------------------------------------------------------------------------

enum class Ground { Dark, Light };

struct ChartSize {
  float width = 960, height = 600;  ///< pixels; at least 1
  float font = 14;                  ///< pixels of an em; everything else grows with it
  Ground ground = Ground::Light;
};

/// Data to pixels and back, within the frame of a plot.
struct Projection {
  std::array<float, 2> min = {}, max = {};    ///< the frame in pixels: top left, bottom right
  std::array<double, 2> low = {}, high = {};  ///< x and y of the data at the left and right, at the bottom and top
  std::array<bool, 2> logarithmic = {};

  /// Anywhere, be it outside the frame; not finite for a point without a place (see has_place).
  std::array<float, 2> to_pixels(std::array<double, 2> point) const;
  std::array<double, 2> to_data(std::array<float, 2> pixel) const;
  /// Whether the pixel lies in the frame or on its edge.
  bool contains(std::array<float, 2> pixel) const;
  /// Whether the point is finite and, where an axis is logarithmic, above 0.
  bool has_place(std::array<double, 2> point) const;
};

struct ChartLayout {
  Drawing drawing;
  Projection projection;
};

/// The whole chart: title and subtitle at the top left, the plot in its frame with ticks as people write numbers, the
/// legend in a column at the right where it covers no data. Labels never overlap: where room is short there are fewer
/// ticks, and long names are wrapped or shortened. Text is taken to be 0.56 em a character wide, about the mean of sans
/// serif fonts. A chart without a point to draw says so.
/// Any thread; the same chart and size give the same drawing. Lines of many points are thinned to what pixels show.
ChartLayout lay_out(const Chart& chart, const ChartSize& size = {});

/// Indices into Chart::series and Series::points.
struct NearestPoint {
  std::size_t series = 0, point = 0;
};

/// For hovering: the point inside the frame that is nearest to a pixel, if one is within `reach` pixels. Of points at
/// one place it is that of the last series, which covers the others.
std::optional<NearestPoint> nearest_point(const Chart& chart, const Projection& projection, std::array<float, 2> pixel,
                                          float reach);

}  // namespace brume
