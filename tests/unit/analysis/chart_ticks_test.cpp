#include "renderer/analysis/chart_ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace brume {
namespace {

const Axis kLinear{.label = "x"}, kLogarithmic{.label = "x", .logarithmic = true};

/// As on a horizontal axis: eight pixels a character.
TickRoom room_of(float length) {
  return {.length = length, .gap = 10, .least_distance = 50, .extent = [](const std::string& label) {
            return 8 * static_cast<float>(label.size());
          }};
}

std::vector<std::string> labels(const Axis& axis, double low, double high, float length = 600) {
  std::vector<std::string> result;
  for (const Tick& tick : axis_ticks(axis, {low, high, axis.logarithmic}, room_of(length)))
    if (!tick.label.empty()) result.push_back(tick.label);
  return result;
}

using Labels = std::vector<std::string>;

TEST(ChartTicks, LinearStepsAreOneTwoOrFive) {
  EXPECT_EQ(labels(kLinear, 0, 1), (Labels{"0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1.0"}));
  EXPECT_EQ(labels(kLinear, 0, 1, 300), (Labels{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(labels(kLinear, 0, 1, 120), (Labels{"0", "0.5", "1.0"}));
  EXPECT_EQ(labels(kLinear, -30, 30, 250), (Labels{"-20", "0", "20"}));
  EXPECT_EQ(labels(kLinear, 0.012, 0.0126, 400),
            (Labels{"0.0120", "0.0121", "0.0122", "0.0123", "0.0124", "0.0125", "0.0126"}));
}

TEST(ChartTicks, LargeAndSmallNumbersGetAPowerOfTen) {
  EXPECT_EQ(labels(kLinear, 0, 2e6, 250), (Labels{"0", "5e5", "1e6", "1.5e6", "2e6"}));
  EXPECT_EQ(labels(kLinear, 0, 4e-6, 250), (Labels{"0", "1e-6", "2e-6", "3e-6", "4e-6"}));
  EXPECT_EQ(labels(kLinear, 0, 40000, 250), (Labels{"0", "10000", "20000", "30000", "40000"}));
  EXPECT_EQ(labels(kLinear, 123456.0, 123460.0, 250), (Labels{"123456", "123457", "123458", "123459", "123460"}))
      << "no power of ten where it would not be shorter";
}

TEST(ChartTicks, CountsHaveNoTicksBetweenWholeNumbers) {
  EXPECT_EQ(labels(Axis{.whole = true}, 0, 2, 900), (Labels{"0", "1", "2"}));
  EXPECT_EQ(labels(Axis{.whole = true}, 0, 40, 250), labels(kLinear, 0, 40, 250));
}

TEST(ChartTicks, PercentAreHundredths) {
  const Axis linear{.percent = true}, logarithmic{.logarithmic = true, .percent = true};
  EXPECT_EQ(labels(linear, 0, 0.2, 250), (Labels{"0 %", "5 %", "10 %", "15 %", "20 %"}));
  EXPECT_EQ(labels(logarithmic, 1e-6, 1, 600),
            (Labels{"1e-4 %", "0.001 %", "0.01 %", "0.1 %", "1 %", "10 %", "100 %"}));
}

TEST(ChartTicks, PowersOfTenAreWrittenAsPeopleWriteThem) {
  EXPECT_EQ(labels(kLogarithmic, 1e-6, 1e6, 900),
            (Labels{"1e-6", "1e-5", "1e-4", "0.001", "0.01", "0.1", "1", "10", "100", "1000", "10000", "1e5", "1e6"}));
  EXPECT_EQ(labels(kLogarithmic, 0.5, 5000), (Labels{"1", "10", "100", "1000"}));
}

TEST(ChartTicks, ShortLogarithmicAxesAreLabelledAtOneTwoAndFive) {
  EXPECT_EQ(labels(kLogarithmic, 0.8, 25), (Labels{"1", "2", "5", "10", "20"}));
  EXPECT_EQ(labels(kLogarithmic, 0.08, 2.5), (Labels{"0.1", "0.2", "0.5", "1", "2"}));
  EXPECT_EQ(labels(kLogarithmic, 3, 4.5), (Labels{"3.0", "3.2", "3.4", "3.6", "3.8", "4.0", "4.2", "4.4"}))
      << "linear steps where there is too little of a decade";
}

TEST(ChartTicks, LogarithmicGridHasLinesAtTwoToNine) {
  std::vector<double> minor;
  for (const Tick& tick : axis_ticks(kLogarithmic, {1, 1000, true}, room_of(600)))
    if (tick.minor) minor.push_back(tick.value);
  EXPECT_EQ(minor, (std::vector<double>{2,  3,  4,  5,  6,   7,   8,   9,   20,  30,  40,  50,
                                        60, 70, 80, 90, 200, 300, 400, 500, 600, 700, 800, 900}));
  for (const Tick& tick : axis_ticks(kLogarithmic, {1, 1e30, true}, room_of(600)))
    EXPECT_FALSE(tick.minor) << "twenty pixels a decade: they would be a grey area";
}

TEST(ChartTicks, ManyPowersAreLabelledEverySoMany) {
  EXPECT_EQ(labels(kLogarithmic, 1, 1e12, 250), (Labels{"1", "1000", "1e6", "1e9", "1e12"}));
}

TEST(ChartTicks, LabelsNeverOverlapAndTicksLieWithinTheRange) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> exponent(-12, 12), span(0.001, 8), length(1, 1000);
  for (int i = 0; i < 4000; ++i) {
    const Axis axis{.label = "", .logarithmic = i % 2 == 0, .percent = i % 3 == 0};
    const double low = std::pow(10, exponent(random)) * (!axis.logarithmic && i % 5 == 0 ? -1 : 1);
    const AxisRange range{low, low + std::abs(low) * (std::pow(10, span(random)) - 1), axis.logarithmic};
    const TickRoom room = room_of(static_cast<float>(length(random)));
    double end = -1e9;
    for (const Tick& tick : axis_ticks(axis, range, room)) {
      ASSERT_GE(tick.value, range.low - 1e-6 * (range.high - range.low));
      ASSERT_LE(tick.value, range.high + 1e-6 * (range.high - range.low));
      if (tick.label.empty()) continue;
      const double middle = range.fraction(tick.value) * room.length, half = room.extent(tick.label) / 2.0;
      ASSERT_GE(middle - half, end) << tick.label << " of " << range.low << " to " << range.high;
      end = middle + half;
    }
  }
}

TEST(ChartTicks, LongAxesHaveEnoughLabels) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> exponent(-9, 9), span(0.1, 9);
  for (int i = 0; i < 1000; ++i) {
    const Axis axis{.label = "", .logarithmic = i % 2 == 0};
    const double low = std::pow(10, exponent(random)), high = low * std::pow(10, span(random));
    EXPECT_GE(labels(axis, low, high, 700).size(), 2u) << low << " to " << high;
  }
}

TEST(ChartTicks, RangesArePaddedALittle) {
  const std::vector<double> values{10, 20};
  const AxisRange linear = axis_range(kLinear, values);
  EXPECT_DOUBLE_EQ(linear.low, 9.6);
  EXPECT_DOUBLE_EQ(linear.high, 20.4);
  EXPECT_EQ(axis_range(kLinear, std::vector<double>{0, 1}).low, 0) << "not below 0 without need";

  const std::vector<double> far{1e-20, 1e20};
  const AxisRange logarithmic = axis_range(kLogarithmic, far);
  EXPECT_NEAR(std::log10(logarithmic.low), -20 - 1.0 / 3, 1e-9) << "at most a third of a decade";
  EXPECT_NEAR(std::log10(logarithmic.high), 20 + 1.0 / 3, 1e-9);
  EXPECT_NEAR(std::log10(axis_range(kLogarithmic, std::vector<double>{1, 100}).high), 2.1, 1e-9);
}

TEST(ChartTicks, EqualValuesGetARangeAroundThem) {
  for (const double value : {5.0, -3e-9, 7e250, 1e-250}) {
    const AxisRange range = axis_range(kLinear, std::vector<double>{value, value});
    EXPECT_LT(range.low, value);
    EXPECT_GT(range.high, value);
  }
  const AxisRange zero = axis_range(kLinear, std::vector<double>{0});
  EXPECT_EQ(zero.low, 0);
  EXPECT_EQ(zero.high, 1);
  const AxisRange one = axis_range(kLogarithmic, std::vector<double>{64});
  EXPECT_NEAR(one.fraction(64), 0.5, 1e-9);
  EXPECT_GE(labels(kLogarithmic, one.low, one.high).size(), 2u);
}

TEST(ChartTicks, ValuesWithoutAPlaceDoNotCount) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const AxisRange range = axis_range(kLogarithmic, std::vector<double>{-5, 0, 10, 1000, kInfinity, std::nan("")});
  EXPECT_NEAR(range.low, 10 * std::pow(10, -0.1), 1e-9);
  EXPECT_NEAR(range.high, 1000 * std::pow(10, 0.1), 1e-6);
  EXPECT_EQ(axis_range(kLogarithmic, std::vector<double>{-5}).low, 1);
  EXPECT_EQ(axis_range(kLogarithmic, std::vector<double>{}).high, 10);
}

TEST(ChartTicks, FixedEndsStay) {
  const std::vector<double> values{10, 20};
  Axis axis{.label = "", .low = 0, .high = 50};
  EXPECT_EQ(axis_range(axis, values).low, 0);
  EXPECT_EQ(axis_range(axis, values).high, 50);
  axis.high = -1;
  EXPECT_DOUBLE_EQ(axis_range(axis, values).high, 20.4) << "leaves no range";
  axis = {.label = "", .logarithmic = true, .low = 0, .high = 100};
  EXPECT_GT(axis_range(axis, values).low, 9) << "0 has no place on a logarithmic axis";
  EXPECT_EQ(axis_range(axis, values).high, 100);
}

TEST(ChartTicks, ExtremeRangesHaveTicksToo) {
  constexpr double kMost = std::numeric_limits<double>::max(), kLeast = std::numeric_limits<double>::denorm_min();
  for (const Axis& axis : {kLinear, kLogarithmic})
    for (const std::vector<double>& values :
         {std::vector<double>{-kMost, kMost}, {kLeast, kMost}, {kLeast}, {kMost}, {1, std::nextafter(1, 2)}}) {
      const AxisRange range = axis_range(axis, values);
      EXPECT_TRUE(std::isfinite(range.high - range.low));
      EXPECT_LT(range.low, range.high);
      EXPECT_GE(axis_ticks(axis, range, room_of(600)).size(), 2u) << values[0];
    }
}

TEST(ChartTicks, ValueTextsHaveFourDigits) {
  EXPECT_EQ(value_text(kLinear, 0.0316227766), "0.03162");
  EXPECT_EQ(value_text(kLinear, 16384), "16384");
  EXPECT_EQ(value_text(kLinear, 262144), "262144");
  EXPECT_EQ(value_text(kLinear, 2.5), "2.5");
  EXPECT_EQ(value_text(kLinear, -0.5), "-0.5");
  EXPECT_EQ(value_text(kLinear, 0), "0");
  EXPECT_EQ(value_text(kLinear, 1.23456e-7), "1.235e-7");
  EXPECT_EQ(value_text(kLinear, 1.5e9), "1.5e9");
  EXPECT_EQ(value_text(Axis{.percent = true}, 0.05), "5 %");
  EXPECT_EQ(value_text(kLinear, std::nan("")), "-");
}

}  // namespace
}  // namespace brume
