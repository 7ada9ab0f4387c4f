// A chart as data: what is plotted, not where it lands.
//
// lay_out() in chart_layout.h turns it into lines and texts; to_svg() and the panel chart_view() only put those on a
// canvas, so a chart in a report and on the screen cannot differ.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace brume {

/// A colour of a picture on a monitor, sRGB-encoded.
using Rgb = std::array<std::uint8_t, 3>;

struct Axis {
  std::string label = {};
  /// Equal ratios take equal room. Values <= 0 have no place on it.
  bool logarithmic = false;
  /// A fixed end of the range; without it the end comes from the data, padded a little. An end that is not finite, has
  /// no place on the axis or leaves no range is taken from the data, too.
  std::optional<double> low = {}, high = {};
  bool percent = false;  ///< 0.05 is shown as "5 %"
  bool whole = false;    ///< counts: a linear axis has no ticks between whole numbers
};

enum class LineStyle { Solid, Dashed, None };

struct Series {
  std::string name = {};  ///< in the legend; empty: not in it
  Rgb color = {};
  /// (x, y) in the order of the line. Points that are not finite or have no place on a logarithmic axis are left out,
  /// and the line is interrupted there.
  std::vector<std::array<double, 2>> points = {};
  LineStyle line = LineStyle::Solid;
  bool markers = true;  ///< a disc at every point
};

/// y = y0 (x / x0)^slope through the point (x0, y0): a straight line in a chart of two logarithmic axes, where it
/// guides the eye ("N^-1/2"). Charts of other axes leave it out.
struct Guide {
  std::string label = {};
  double slope = 0;
  std::array<double, 2> through = {};
};

/// A horizontal line across the chart ("target").
struct Level {
  std::string label = {};
  double y = 0;
  Rgb color = {};
};

/// A ring around a point with a text beside it ("winner").
struct Mark {
  std::string label = {};
  std::array<double, 2> at = {};
  Rgb color = {};
};

struct Chart {
  std::string title = {}, subtitle = {};
  Axis x = {}, y = {};
  std::vector<Series> series = {};
  std::vector<Guide> guides = {};
  std::vector<Level> levels = {};
  std::vector<Mark> marks = {};
};

/// Eight colours, then again from the first. People with any of the common kinds of colour-blindness tell them apart,
/// on white and on near black.
/// Hues of Okabe & Ito 2008, "Color Universal Design". Their black and yellow vanish on one of the two grounds, so a
/// grey and a second violet stand in for them, and all were moved as far apart as the hues allow: Euclidean distance in
/// Oklab (Ottosson 2020) under normal vision and the dichromacies of Machado, Oliveira & Fernandes 2009. The test
/// states the distances.
Rgb series_color(std::size_t i);

}  // namespace brume
