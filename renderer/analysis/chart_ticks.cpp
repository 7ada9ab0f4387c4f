#include "renderer/analysis/chart_ticks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

namespace brume {
namespace {

constexpr double kFarthest = 1e300;  // beyond, the length of a range would overflow

// ---- Range ---------------------------------------------------------------------------------------------------------

bool has_place(const Axis& axis, double value) { return std::isfinite(value) && (!axis.logarithmic || value > 0); }

AxisRange padded_linear(double low, double high) {
  const double largest = std::max(std::abs(low), std::abs(high)), length = high - low;
  // Shorter ranges have no digits left to tell their ticks apart.
  constexpr double kShortest = 1e-9, kSmallest = 1e-280;
  double padding = 0.04 * length;
  if (largest < kSmallest)
    padding = 1;
  else if (length < kShortest * largest)
    padding = 0.1 * largest;
  return {low >= 0 ? std::max(0.0, low - padding) : low - padding, high + padding, false};
}

AxisRange padded_logarithmic(double low, double high) {
  constexpr double kMost = 1.0 / 3, kShortest = 1e-9;
  const double first = std::log10(low), last = std::log10(high), decades = last - first;
  const double padding = decades < kShortest ? kMost : std::clamp(0.05 * decades, 0.02, kMost);
  return {std::pow(10, first - padding), std::pow(10, last + padding), true};
}

AxisRange range_of_values(const Axis& axis, std::span<const double> values) {
  std::optional<std::pair<double, double>> ends;
  for (double value : values) {
    if (!has_place(axis, value)) continue;
    value = axis.logarithmic ? std::clamp(value, 1 / kFarthest, kFarthest) : std::clamp(value, -kFarthest, kFarthest);
    if (!ends) ends = {value, value};
    ends = {std::min(ends->first, value), std::max(ends->second, value)};
  }
  if (!ends) return {axis.logarithmic ? 1.0 : 0.0, axis.logarithmic ? 10.0 : 1.0, axis.logarithmic};
  return axis.logarithmic ? padded_logarithmic(ends->first, ends->second) : padded_linear(ends->first, ends->second);
}

// ---- Numbers -------------------------------------------------------------------------------------------------------

std::string digits(double value, std::chars_format format, int precision) {
  char buffer[400];  // 1e300 in full has 301 characters
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, format, precision).ptr};
}

std::string without_trailing_zeros(std::string number) {
  if (number.find('.') == std::string::npos) return number;
  number.erase(number.find_last_not_of('0') + 1);
  if (number.back() == '.') number.pop_back();
  return number;
}

/// "1.5e6", not "1.500e+06".
std::string scientific(double value, int precision) {
  const std::string number = digits(value, std::chars_format::scientific, precision);
  const std::size_t e = number.find('e');
  const std::size_t first = std::min(number.find_first_not_of('0', e + 2), number.size() - 1);
  return without_trailing_zeros(number.substr(0, e)) + (number[e + 1] == '-' ? "e-" : "e") + number.substr(first);
}

int exponent_of(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)))); }

// Between these people write all digits: 0.001, 10000.
bool reads_in_full(double value) { return std::abs(value) >= 0.999e-3 && std::abs(value) < 0.999e5; }

/// One digit and a power of ten.
std::string power_label(const Axis& axis, int digit, int exponent) {
  const int shown = exponent + (axis.percent ? 2 : 0);
  const double value = digit * std::pow(10, shown);
  return (reads_in_full(value) ? digits(value, std::chars_format::fixed, std::max(0, -shown)) : scientific(value, 0)) +
         (axis.percent ? " %" : "");
}

// ---- Linear ticks --------------------------------------------------------------------------------------------------

/// 1, 2 or 5 times a power of ten.
struct Step {
  int digit = 1, exponent = 0;

  Step next() const { return digit == 5 ? Step{1, exponent + 1} : Step{digit == 1 ? 2 : 5, exponent}; }
  /// Dividing by a power of ten is exact to the last bit where multiplying by 0.1 is not.
  double times(double count) const {
    const double n = count * digit;
    return exponent < 0 ? n / std::pow(10, -exponent) : n * std::pow(10, exponent);
  }
};

bool within(const AxisRange& range, double value) {
  constexpr double kRounding = 1e-9;
  const double fraction = range.fraction(value);
  return fraction >= -kRounding && fraction <= 1 + kRounding;
}

/// All labels in one manner, with the decimals of the step: 0, 0.5, 1.0.
void label_steps(std::vector<Tick>& ticks, const Axis& axis, const Step& step) {
  constexpr int kMostDigits = 3;  // of a mantissa; with more of them the power of ten saves no room
  const double unit = axis.percent ? 100 : 1;
  const int last_digit = step.exponent + (axis.percent ? 2 : 0);
  double largest = 0;
  for (const Tick& tick : ticks) largest = std::max(largest, std::abs(tick.value * unit));
  const bool in_full = largest == 0 || reads_in_full(largest) || exponent_of(largest) - last_digit > kMostDigits;
  for (Tick& tick : ticks) {
    const double value = tick.value * unit;
    if (value == 0)
      tick.label = "0";
    else if (in_full)
      tick.label = digits(value, std::chars_format::fixed, std::max(0, -last_digit));
    else
      tick.label = scientific(value, std::max(0, exponent_of(value * 1.000001) - last_digit));
    if (axis.percent) tick.label += " %";
  }
}

std::vector<Tick> step_ticks(const Axis& axis, const AxisRange& range, const Step& step) {
  std::vector<Tick> ticks;
  const double first = std::ceil(range.low / step.times(1) - 1e-6), last = range.high / step.times(1) + 1e-6;
  for (double n = first; n <= last; ++n)
    if (within(range, step.times(n))) ticks.push_back({step.times(n)});
  label_steps(ticks, axis, step);
  return ticks;
}

// ---- Choice --------------------------------------------------------------------------------------------------------

std::size_t count_labels(const std::vector<Tick>& ticks) {
  return static_cast<std::size_t>(std::ranges::count_if(ticks, [](const Tick& tick) { return !tick.label.empty(); }));
}

bool labels_fit(const std::vector<Tick>& ticks, const AxisRange& range, const TickRoom& room, double least_distance) {
  double free_from = -1e9, previous = -1e9;
  for (const Tick& tick : ticks) {
    if (tick.label.empty()) continue;
    const double middle = range.fraction(tick.value) * static_cast<double>(room.length);
    const double half = static_cast<double>(room.extent(tick.label)) / 2;
    if (middle - half < free_from || middle - previous < least_distance) return false;
    free_from = middle + half + static_cast<double>(room.gap);
    previous = middle;
  }
  return true;
}

std::vector<Tick> linear_ticks(const Axis& axis, const AxisRange& range, const TickRoom& room) {
  const double length = range.high - range.low, distance = std::max(1.0, static_cast<double>(room.least_distance));
  const double shortest = length * std::min(1.0, distance / std::max(1.0, static_cast<double>(room.length)));
  const int finest = axis.whole ? std::max(0, exponent_of(shortest)) : exponent_of(shortest);
  for (Step step{1, finest};; step = step.next()) {
    std::vector<Tick> ticks = step_ticks(axis, range, step);
    // Ends at the latest when the step passes the range, which has at most one tick then.
    if (ticks.size() < 2 || labels_fit(ticks, range, room, distance)) return ticks;
  }
}

/// Every so many powers of ten, labelled, and the lines between as far as there is room for them. With `digits_too`
/// labels also at 2 and 5 times a power.
std::vector<Tick> power_ticks(const Axis& axis, const AxisRange& range, const TickRoom& room, int every,
                              bool digits_too) {
  // From 9 to 10 is 0.046 of a decade: with 2 pixels there, the lines do not become a grey area.
  constexpr double kRoomForDigits = 43, kRoomForPowers = 8;
  const double decade = static_cast<double>(room.length) / (std::log10(range.high) - std::log10(range.low));
  std::vector<Tick> ticks;
  for (int power = exponent_of(range.low) - 1; power <= exponent_of(range.high) + 1; ++power)
    for (int digit = 1; digit <= 9; ++digit) {
      const double value = Step{digit, power}.times(1);
      if (!within(range, value)) continue;
      const bool labelled = digit == 1 ? power % every == 0 : digits_too && (digit == 2 || digit == 5);
      if (!labelled && decade < (digit == 1 ? kRoomForPowers : kRoomForDigits)) continue;
      ticks.push_back({value, labelled ? power_label(axis, digit, power) : "", digit > 1});
    }
  return ticks;
}

std::vector<Tick> logarithmic_ticks(const Axis& axis, const AxisRange& range, const TickRoom& room) {
  const std::vector<Tick> powers = power_ticks(axis, range, room, 1, false);
  if (count_labels(powers) < 3) {
    std::vector<Tick> ticks = power_ticks(axis, range, room, 1, true);
    if (count_labels(ticks) >= 2 && labels_fit(ticks, range, room, 0)) return ticks;
  }
  if (count_labels(powers) < 2) return linear_ticks(axis, range, room);
  for (int every = 1;; ++every) {
    std::vector<Tick> ticks = power_ticks(axis, range, room, every, false);
    if (count_labels(ticks) < 2 || labels_fit(ticks, range, room, 0)) return ticks;
  }
}

}  // namespace

double AxisRange::fraction(double value) const {
  return logarithmic ? (std::log10(value) - std::log10(low)) / (std::log10(high) - std::log10(low))
                     : (value - low) / (high - low);
}

double AxisRange::value(double fraction) const {
  return logarithmic ? std::pow(10, std::log10(low) + fraction * (std::log10(high) - std::log10(low)))
                     : low + fraction * (high - low);
}

AxisRange axis_range(const Axis& axis, std::span<const double> values) {
  const AxisRange of_values = range_of_values(axis, values);
  const auto fixed = [&](const std::optional<double>& end) {
    return end && has_place(axis, *end) && std::abs(*end) <= kFarthest && (!axis.logarithmic || *end >= 1 / kFarthest);
  };
  AxisRange range = of_values;
  if (fixed(axis.low)) range.low = *axis.low;
  if (fixed(axis.high)) range.high = *axis.high;
  const double least =
      std::max(1e-9 * std::max(std::abs(range.low), std::abs(range.high)), axis.logarithmic ? 0.0 : 1e-280);
  return range.high - range.low > least ? range : of_values;
}

std::vector<Tick> axis_ticks(const Axis& axis, const AxisRange& range, const TickRoom& room) {
  return range.logarithmic ? logarithmic_ticks(axis, range, room) : linear_ticks(axis, range, room);
}

std::string value_text(const Axis& axis, double value) {
  const double shown = axis.percent ? value * 100 : value;
  const std::string unit = axis.percent ? " %" : "";
  if (!std::isfinite(shown)) return "-";
  if (shown == 0) return "0" + unit;
  const int exponent = exponent_of(shown);
  if (exponent < -3 || exponent >= 7) return scientific(shown, 3) + unit;
  return without_trailing_zeros(digits(shown, std::chars_format::fixed, std::max(0, 3 - exponent))) + unit;
}

}  // namespace brume
