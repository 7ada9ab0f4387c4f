// The numbers along an axis: its range, where ticks go, and how they are written.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "renderer/analysis/chart.h"

namespace brume {

struct AxisRange {
  double low = 0, high = 1;  ///< low < high, finite; above 0 on a logarithmic axis
  bool logarithmic = false;

  /// Where a value lies: 0 at the low end, 1 at the high end. Not finite for a value without a place on the axis.
  double fraction(double value) const;
  double value(double fraction) const;
};

/// The fixed ends of the axis, else those of the values padded: by 4 % of the range (not below 0 if all values are at
/// least 0), on a logarithmic axis by 5 % of its decades but by no more than a third of one. Values that are all the
/// same lie in the middle of a range (zeros at its low end). No values: 0 to 1, or 1 to 10. Values that are not finite
/// or have no place on the axis do not count; what lies beyond 1e300 lies beyond the range.
AxisRange axis_range(const Axis& axis, std::span<const double> values);

struct Tick {
  double value = 0;
  std::string label = {};  ///< empty: a line of the grid only
  bool minor = false;      ///< of a fainter line: 2 to 9 times a power of ten
};

/// What the ticks must fit into.
struct TickRoom {
  float length = 0;                                      ///< of the axis, in pixels
  float gap = 0;                                         ///< kept free between labels, in pixels
  float least_distance = 0;                              ///< of linear steps, in pixels: closer looks crowded
  std::function<float(const std::string&)> extent = {};  ///< of a label along the axis, in pixels
};

/// Ticks within the range, rising. Linear: at steps of 1, 2 or 5 times a power of ten. Logarithmic: labels at powers of
/// ten, all or every second, third, ... ; at 1, 2 and 5 times a power of ten where few powers lie in the range; where
/// none of these says enough, linear steps.
/// The densest of these whose labels keep the distances is taken. Labels never overlap.
std::vector<Tick> axis_ticks(const Axis& axis, const AxisRange& range, const TickRoom& room);

/// What to call the value of an axis in a sentence: four significant digits, whole numbers whole, "5 %".
std::string value_text(const Axis& axis, double value);

}  // namespace brume
