#include "renderer/analysis/chart_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace brume {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const ChartSize kSizes[] = {{}, {.width = 420, .height = 260}, {.width = 420, .height = 260, .font = 11}};

/// Errors of five methods that fall as N^-1/2, one of them only down to its bias.
Chart error_chart() {
  Chart chart{.title = "Error", .subtitle = "of a cloud"};
  chart.x = {.label = "samples per pixel", .logarithmic = true};
  chart.y = {.label = "relative error", .logarithmic = true};
  for (std::size_t s = 0; s < 5; ++s) {
    Series series{.name = "method " + std::to_string(s), .color = series_color(s)};
    for (int k = 0; k <= 10; ++k) {
      const double n = std::pow(2, k), error = std::pow(0.6, static_cast<double>(s)) / std::sqrt(n);
      series.points.push_back({n, s == 1 ? std::hypot(error, 0.05) : error});
    }
    chart.series.push_back(series);
  }
  chart.guides = {{"N^-1/2", -0.5, {10, 1}}};
  chart.levels = {{"target", 0.01, {200, 0, 0}}};
  chart.marks = {{"winner", chart.series[4].points.back(), {0, 0, 0}}};
  return chart;
}

Chart chart_of(std::vector<std::array<double, 2>> points) {
  Chart chart;
  chart.series = {{.name = "series", .color = {1, 2, 3}, .points = std::move(points)}};
  return chart;
}

template <class T> std::vector<T> shapes_of(const Drawing& drawing) {
  std::vector<T> result;
  for (const Drawing::Shape& shape : drawing.shapes)
    if (const T* found = std::get_if<T>(&shape)) result.push_back(*found);
  return result;
}

template <class T> std::vector<T> shapes_of(const Drawing& drawing, Rgb color) {
  std::vector<T> result = shapes_of<T>(drawing);
  std::erase_if(result, [&](const T& shape) { return shape.color != color; });
  return result;
}

/// Markers of the series of chart_of(); the legend's is not among them.
std::vector<Disc> markers_in_frame(const ChartLayout& layout, Rgb color = {1, 2, 3}) {
  std::vector<Disc> discs = shapes_of<Disc>(layout.drawing, color);
  std::erase_if(discs, [&](const Disc& disc) { return !layout.projection.contains(disc.center); });
  return discs;
}

std::optional<Text> text_of(const Drawing& drawing, const std::string& words) {
  for (const Text& text : shapes_of<Text>(drawing))
    if (text.text == words) return text;
  return std::nullopt;
}

struct Area {
  float left, top, right, bottom;
};

/// By the rule of the layout, 0.56 em a character; from the height of a digit down to the baseline.
Area area_of(const Text& text) {
  const auto characters = std::ranges::count_if(text.text, [](char c) { return (c & 0xC0) != 0x80; });
  const float width = 0.56f * text.size * static_cast<float>(characters), height = 0.72f * text.size;
  const float before = text.anchor == TextAnchor::Start ? 0 : text.anchor == TextAnchor::End ? width : width / 2;
  const auto [x, y] = text.position;
  if (text.rotated) return {x - height, y + before - width, x, y + before};
  return {x - before, y - height, x - before + width, y};
}

TEST(ChartLayout, TextsLieInTheDrawingAndOverlapNoOther) {
  for (const ChartSize& size : kSizes) {
    const std::vector<Text> texts = shapes_of<Text>(lay_out(error_chart(), size).drawing);
    ASSERT_GT(texts.size(), 15u);
    for (const Text& text : texts) {
      const Area a = area_of(text);
      EXPECT_GE(std::min(a.left, a.top), 0) << text.text;
      EXPECT_LE(a.right, size.width) << text.text;
      EXPECT_LE(a.bottom, size.height) << text.text;
      for (const Text& other : texts) {
        const Area b = area_of(other);
        if (&other == &text) continue;
        EXPECT_FALSE(a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom)
            << text.text << " and " << other.text << " at " << size.width;
      }
    }
  }
}

TEST(ChartLayout, TickLabelsAreWellApart) {
  for (const ChartSize& size : kSizes) {
    for (const double high : {0.5, 1.0, 7.0, 30.0, 12000.0, 90000.0, 2e6}) {
      const ChartLayout layout = lay_out(chart_of({{1000, 0}, {1000 + high, high}}), size);
      std::vector<Area> below, beside;
      for (const Text& text : shapes_of<Text>(layout.drawing)) {
        if (text.position[1] > layout.projection.max[1] && text.anchor == TextAnchor::Middle)
          below.push_back(area_of(text));
        if (text.position[0] < layout.projection.min[0] && text.anchor == TextAnchor::End)
          beside.push_back(area_of(text));
      }
      ASSERT_GE(std::min(below.size(), beside.size()), 2u);
      for (std::size_t i = 1; i < below.size(); ++i) EXPECT_GE(below[i].left - below[i - 1].right, 0.8f * size.font);
      for (std::size_t i = 1; i < beside.size(); ++i)
        EXPECT_GE(beside[i - 1].bottom - beside[i].bottom, 2 * size.font) << "rising, and no list";
    }
  }
}

TEST(ChartLayout, MarkersLieAtTheProjectionOfTheirPoints) {
  for (const ChartSize& size : kSizes) {
    const Chart chart = error_chart();
    const ChartLayout layout = lay_out(chart, size);
    for (const Series& series : chart.series) {
      const std::vector<Disc> discs = markers_in_frame(layout, series.color);
      ASSERT_EQ(discs.size(), series.points.size());
      for (std::size_t i = 0; i < discs.size(); ++i)
        EXPECT_EQ(discs[i].center, layout.projection.to_pixels(series.points[i]));
    }
  }
}

TEST(ChartLayout, ProjectionGoesBackToTheData) {
  for (const bool logarithmic : {false, true}) {
    Chart chart = error_chart();
    chart.x.logarithmic = logarithmic;
    const Projection projection = lay_out(chart).projection;
    for (const std::array<double, 2> point : {std::array{1.0, 0.01}, {700.0, 0.5}, {33.0, 0.1}}) {
      const std::array<double, 2> back = projection.to_data(projection.to_pixels(point));
      EXPECT_NEAR(back[0], point[0], 0.01 * point[0]);  // a float pixel has 1e-4 of a pixel
      EXPECT_NEAR(back[1], point[1], 0.001 * point[1]);
    }
    EXPECT_NEAR(projection.to_data(projection.max)[0], projection.high[0], 1e-6 * projection.high[0]);
    EXPECT_NEAR(projection.to_data(projection.max)[1], projection.low[1], 1e-6);
  }
}

TEST(ChartLayout, LegendStaysOutsideTheFrameAndShowsTheStyles) {
  Chart chart = error_chart();
  chart.series[2].line = LineStyle::Dashed;
  chart.series[3].line = LineStyle::None;
  chart.series[4].markers = false;
  for (const ChartSize& size : kSizes) {
    const ChartLayout layout = lay_out(chart, size);
    const float right = layout.projection.max[0];
    for (const Series& series : chart.series) {
      const auto name = text_of(layout.drawing, series.name);
      ASSERT_TRUE(name);
      EXPECT_GT(name->position[0], right);
      std::vector<Line> samples = shapes_of<Line>(layout.drawing, series.color);
      EXPECT_EQ(samples.size(), series.line == LineStyle::None ? 0u : 1u);
      for (const Line& sample : samples) {
        EXPECT_GT(sample.from[0], right);
        EXPECT_LT(sample.to[0], name->position[0]);
        EXPECT_EQ(sample.dashed, series.line == LineStyle::Dashed);
      }
      const auto discs = shapes_of<Disc>(layout.drawing, series.color);
      EXPECT_EQ(std::ranges::count_if(discs, [&](const Disc& d) { return d.center[0] > right; }), series.markers);
    }
  }
}

TEST(ChartLayout, LongLegendsAreCutAndCounted) {
  Chart chart = chart_of({{0, 0}, {1, 1}});
  chart.series[0].name = "a name that is much too long for any legend of a chart of this little width, and then some";
  for (int i = 0; i < 60; ++i)
    chart.series.push_back({.name = std::to_string(i), .color = series_color(3), .points = {}});
  const ChartLayout layout = lay_out(chart, {.width = 420, .height = 260});
  EXPECT_GT(layout.projection.max[0] - layout.projection.min[0], 150) << "the frame keeps its room";
  const std::vector<Text> texts = shapes_of<Text>(layout.drawing);
  EXPECT_TRUE(std::ranges::any_of(texts, [](const Text& t) { return t.text.ends_with("…"); }));
  EXPECT_TRUE(texts.back().text.starts_with("+ ") && texts.back().text.ends_with(" more")) << texts.back().text;
  for (const Text& text : texts) EXPECT_LE(area_of(text).bottom, 260) << text.text;
}

TEST(ChartLayout, LinesAreCutAtTheFrame) {
  Chart chart = chart_of({{-10, -10}, {20, 20}, {20, 0.5}, {-5, 0.5}, {0.5, kInfinity}, {0.5, 0.1}, {0.5, 0.9}});
  chart.x = {.low = 0, .high = 1};
  chart.y = {.low = 0, .high = 1};
  const ChartLayout layout = lay_out(chart);
  const std::vector<Polyline> lines = shapes_of<Polyline>(layout.drawing);
  ASSERT_EQ(lines.size(), 3u) << "the diagonal, the way back, and the rest after the point at infinity";
  for (const Polyline& line : lines)
    for (const std::array<float, 2>& point : line.points) EXPECT_TRUE(layout.projection.contains(point));
  const auto& [min, max] = std::pair(layout.projection.min, layout.projection.max);
  EXPECT_NEAR(lines[0].points.front()[0], min[0], 1e-3);
  EXPECT_NEAR(lines[0].points.front()[1], max[1], 1e-3);
  EXPECT_NEAR(lines[0].points.back()[0], max[0], 1e-3);
  EXPECT_NEAR(lines[0].points.back()[1], min[1], 1e-3);
  EXPECT_NEAR(lines[1].points.front()[1], (min[1] + max[1]) / 2, 1e-3);
  EXPECT_EQ(markers_in_frame(layout).size(), 2u);
  EXPECT_EQ(shapes_of<Disc>(layout.drawing, {1, 2, 3}).size(), 3u) << "and that of the legend, none outside";
}

TEST(ChartLayout, LinesThatLeaveAndComeBackAreTwo) {
  Chart chart = chart_of({{0.2, 0.5}, {0.5, 5}, {0.8, 0.5}});
  chart.y = {.low = 0, .high = 1};
  const ChartLayout layout = lay_out(chart);
  const std::vector<Polyline> lines = shapes_of<Polyline>(layout.drawing);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NEAR(lines[0].points.back()[1], layout.projection.min[1], 1e-3);
  EXPECT_NEAR(lines[1].points.front()[1], layout.projection.min[1], 1e-3);
  EXPECT_GT(lines[1].points.front()[0], lines[0].points.back()[0] + 100) << "with nothing along the edge between";
}

TEST(ChartLayout, PointsWithoutAPlaceAreLeftOut) {
  Chart chart = chart_of({{1, 1}, {10, 0}, {100, -1}, {0, 5}, {std::nan(""), 1}, {1, kInfinity}, {1000, 10}});
  chart.x.logarithmic = chart.y.logarithmic = true;
  const ChartLayout layout = lay_out(chart);
  EXPECT_EQ(markers_in_frame(layout).size(), 2u);
  EXPECT_TRUE(shapes_of<Polyline>(layout.drawing).empty()) << "no line leads across what is missing";
  EXPECT_NEAR(layout.projection.low[0], 1, 0.5);
  EXPECT_NEAR(layout.projection.high[1], 10, 2);
}

TEST(ChartLayout, EmptyChartSaysSoInItsFrame) {
  for (Chart chart : {Chart{}, chart_of({}), chart_of({{std::nan(""), 1}})}) {
    chart.x.label = "samples";
    const ChartLayout layout = lay_out(chart);
    const auto words = text_of(layout.drawing, "no data yet");
    ASSERT_TRUE(words);
    EXPECT_TRUE(layout.projection.contains(words->position));
    EXPECT_TRUE(text_of(layout.drawing, "samples"));
    EXPECT_FALSE(text_of(layout.drawing, "0")) << "numbers would pretend to a scale";
  }
  EXPECT_FALSE(text_of(lay_out(chart_of({{1, 1}})).drawing, "no data yet"));
}

TEST(ChartLayout, OnePointLiesInTheMiddle) {
  Chart chart = chart_of({{64, 0.05}});
  for (const bool logarithmic : {true, false}) {
    chart.x.logarithmic = chart.y.logarithmic = logarithmic;
    const ChartLayout layout = lay_out(chart);
    const std::vector<Disc> discs = markers_in_frame(layout);
    ASSERT_EQ(discs.size(), 1u);
    EXPECT_NEAR(discs[0].center[0], (layout.projection.min[0] + layout.projection.max[0]) / 2, 0.01);
    EXPECT_NEAR(discs[0].center[1], (layout.projection.min[1] + layout.projection.max[1]) / 2, 0.01);
  }
}

TEST(ChartLayout, GuideHasItsSlopeAndStaysInTheFrame) {
  Chart chart = error_chart();
  chart.series.resize(1);
  chart.levels.clear();
  chart.marks.clear();
  const ChartLayout with = lay_out(chart);
  chart.guides.clear();
  const std::vector<Line> without = shapes_of<Line>(lay_out(chart).drawing);
  std::vector<Line> lines = shapes_of<Line>(with.drawing);
  ASSERT_EQ(lines.size(), without.size() + 1);
  std::erase_if(lines, [](const Line& line) { return line.from[0] == line.to[0] || line.from[1] == line.to[1]; });
  ASSERT_EQ(lines.size(), 1u) << "the only one that is neither level nor upright";
  const auto from = with.projection.to_data(lines[0].from), to = with.projection.to_data(lines[0].to);
  EXPECT_NEAR(std::log(to[1] / from[1]) / std::log(to[0] / from[0]), -0.5, 1e-4);
  EXPECT_NEAR(from[1], std::sqrt(10 / from[0]), 1e-3 * from[1]) << "through (10, 1)";
  for (const auto& end : {lines[0].from, lines[0].to})
    EXPECT_TRUE(with.projection.contains({std::round(end[0] * 100) / 100, std::round(end[1] * 100) / 100}));
  EXPECT_TRUE(text_of(with.drawing, "N^-1/2"));

  chart = error_chart();
  chart.x.logarithmic = false;
  EXPECT_FALSE(text_of(lay_out(chart).drawing, "N^-1/2")) << "a power is no straight line there";
}

TEST(ChartLayout, LevelsCrossTheFrameDashedWithTheirLabelInside) {
  const Chart chart = error_chart();
  const ChartLayout layout = lay_out(chart);
  const std::vector<Line> lines = shapes_of<Line>(layout.drawing, {200, 0, 0});
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].dashed);
  EXPECT_EQ(lines[0].from[0], layout.projection.min[0]);
  EXPECT_EQ(lines[0].to[0], layout.projection.max[0]);
  EXPECT_EQ(lines[0].from[1], layout.projection.to_pixels({1, 0.01})[1]);
  const auto label = text_of(layout.drawing, "target");
  ASSERT_TRUE(label);
  EXPECT_EQ(label->color, (Rgb{200, 0, 0}));
  EXPECT_TRUE(layout.projection.contains(label->position));
  EXPECT_NEAR(label->position[1], lines[0].from[1], 20);

  Chart alone = chart_of({{0, 0}, {1, 1}});
  alone.levels = {{"far above", 7, {200, 0, 0}}};
  const ChartLayout second = lay_out(alone);
  EXPECT_GT(second.projection.high[1], 7) << "levels belong to the range";
  EXPECT_GT(text_of(second.drawing, "far above")->position[0], 0.7f * second.projection.max[0]) << "at the right";
}

TEST(ChartLayout, LabelsKeepOffTheLinesWhereThereIsRoom) {
  Chart chart = chart_of({{0, 0}, {1, 1}});
  chart.levels = {{"a level", 0.97, {200, 0, 0}}};
  chart.marks = {{"start", {0, 0}, {0, 0, 0}}};
  const ChartLayout layout = lay_out(chart);
  const std::vector<Polyline> lines = shapes_of<Polyline>(layout.drawing);
  ASSERT_EQ(lines.size(), 1u);
  for (const char* words : {"a level", "start"}) {
    const Area area = area_of(*text_of(layout.drawing, words));
    for (int i = 0; i <= 1000; ++i) {
      const float part = static_cast<float>(i) / 1000;
      const auto &a = lines[0].points.front(), &b = lines[0].points.back();
      const float x = a[0] + part * (b[0] - a[0]), y = a[1] + part * (b[1] - a[1]);
      ASSERT_FALSE(x > area.left && x < area.right && y > area.top && y < area.bottom) << words;
    }
  }
}

TEST(ChartLayout, MarksRingTheirPoint) {
  const ChartLayout layout = lay_out(error_chart());
  std::vector<Disc> rings = shapes_of<Disc>(layout.drawing);
  std::erase_if(rings, [](const Disc& disc) { return disc.ring == 0; });
  ASSERT_EQ(rings.size(), 1u);
  EXPECT_EQ(rings[0].center, layout.projection.to_pixels(error_chart().marks[0].at));
  const auto label = text_of(layout.drawing, "winner");
  ASSERT_TRUE(label);
  EXPECT_LT(std::hypot(label->position[0] - rings[0].center[0], label->position[1] - rings[0].center[1]), 60);
}

TEST(ChartLayout, ManyPointsBecomeWhatPixelsShow) {
  std::vector<std::array<double, 2>> points;
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  for (int i = 0; i < 300000; ++i) points.push_back({static_cast<double>(i), noise(random)});
  points[123456][1] = 50;
  points[234567][1] = -50;
  Chart chart = chart_of(points);
  chart.series[0].markers = false;
  const ChartLayout layout = lay_out(chart);
  const std::vector<Polyline> lines = shapes_of<Polyline>(layout.drawing);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_LT(lines[0].points.size(), 4u * 960);
  for (const std::size_t peak : {std::size_t{123456}, std::size_t{234567}})
    EXPECT_TRUE(std::ranges::count(lines[0].points, layout.projection.to_pixels(points[peak]))) << "peaks stay";
  EXPECT_EQ(lines[0].points.front(), layout.projection.to_pixels(points.front()));
  EXPECT_EQ(lines[0].points.back(), layout.projection.to_pixels(points.back()));
}

TEST(ChartLayout, NearestPointIsWithinReachOrNone) {
  Chart chart = chart_of({{0, 0}, {0.5, 0.5}, {1, 1}, {0.5, 40}, {std::nan(""), 0}});
  chart.y = {.low = 0, .high = 1};
  chart.series.push_back({.name = "upper", .color = {9, 9, 9}, .points = {{0.25, 1}, {1, 1}}});
  const Projection projection = lay_out(chart).projection;
  const auto at = [&](double x, double y, float right) {
    const std::array<float, 2> pixel = projection.to_pixels({x, y});
    return nearest_point(chart, projection, {pixel[0] + right, pixel[1]}, 10);
  };
  ASSERT_TRUE(at(0.5, 0.5, 9.9f));
  EXPECT_EQ(at(0.5, 0.5, 9.9f)->series, 0u);
  EXPECT_EQ(at(0.5, 0.5, 9.9f)->point, 1u);
  EXPECT_FALSE(at(0.5, 0.5, 10.1f));
  EXPECT_EQ(at(1, 1, 0)->series, 1u) << "the series that covers the other";
  EXPECT_EQ(at(1, 1, 0)->point, 1u);
  EXPECT_FALSE(at(0.5, 40, 0)) << "outside the frame";
  EXPECT_FALSE(nearest_point(Chart{}, projection, {0, 0}, 10));
}

TEST(ChartLayout, TinyAndOddSizesStayFinite) {
  for (const float extent : {0.0f, 1.0f, 20.0f, 100.0f, -5.0f})
    for (const ChartSize& size : {ChartSize{.width = extent, .height = extent}, ChartSize{.width = extent},
                                  ChartSize{.height = extent}, ChartSize{.width = extent, .font = 0}}) {
      const ChartLayout layout = lay_out(error_chart(), size);
      EXPECT_LT(layout.projection.min[0], layout.projection.max[0]);
      EXPECT_LT(layout.projection.min[1], layout.projection.max[1]);
      for (const Polyline& line : shapes_of<Polyline>(layout.drawing))
        for (const auto& point : line.points) ASSERT_TRUE(std::isfinite(point[0]) && std::isfinite(point[1]));
      for (const Text& text : shapes_of<Text>(layout.drawing))
        ASSERT_TRUE(std::isfinite(text.position[0]) && std::isfinite(text.position[1])) << text.text;
    }
}

TEST(ChartLayout, GroundsDifferInInkOnly) {
  const Drawing light = lay_out(error_chart()).drawing, dark = lay_out(error_chart(), {.ground = Ground::Dark}).drawing;
  EXPECT_GT(light.background[0], 200);
  EXPECT_LT(dark.background[0], 60);
  ASSERT_EQ(light.shapes.size(), dark.shapes.size());
  EXPECT_LT(text_of(light, "Error")->color[0], 60);
  EXPECT_GT(text_of(dark, "Error")->color[0], 200);
  EXPECT_EQ(text_of(light, "Error")->position, text_of(dark, "Error")->position);
}

}  // namespace
}  // namespace brume
