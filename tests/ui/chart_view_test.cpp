// The chart of a panel: what it draws, and what the mouse finds in it.
#include "app/panels/chart_view.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/ui/robot_fixture.h"

namespace brume {
namespace {

constexpr Rgb kRed{221, 51, 17}, kGreen{5, 160, 112};

/// The lines differ from the markers in nothing, so a series without a line is a disc that can be found by its colour.
Chart one_point_chart(double x, double y) {
  Chart chart;
  chart.x = {.label = "samples", .logarithmic = true};
  chart.y = {.label = "error", .logarithmic = true, .percent = true};
  chart.series = {{.name = "decoupled", .color = kRed, .points = {{x, y}}, .line = LineStyle::None}};
  return chart;
}

class ChartViewTest : public RobotFixture {
 protected:
  struct Found {
    int count = 0;
    float x = 0, y = 0;  ///< the mean place, in display coordinates
  };

  /// Pixels of exactly this colour within a rectangle of the picture.
  Found find(Rgb color, float left = 0, float right = 1e6f) const {
    const std::vector<std::uint8_t> pixels = stage_->pixels();
    Found found;
    for (int y = 0; y < stage_->height(); ++y)
      for (int x = std::max(0, static_cast<int>(left)); x < std::min(stage_->width(), static_cast<int>(right)); ++x) {
        const std::uint8_t* p = &pixels[4 * (static_cast<std::size_t>(y) * stage_->width() + x)];
        if (!std::equal(color.begin(), color.end(), p)) continue;
        ++found.count;
        found.x += static_cast<float>(x) + 0.5f;
        found.y += static_cast<float>(y) + 0.5f;
      }
    if (found.count > 0) found.x /= static_cast<float>(found.count), found.y /= static_cast<float>(found.count);
    return found;
  }

  /// Rests the mouse so far right of a place of the display until a tooltip would show.
  void rest_at(const Found& place, float right = 0) {
    const ui::ItemRecord* item = robot().last_drawn("Panel/chart");
    ASSERT_TRUE(item);
    const ImVec2 min = item->rect.min, max = item->rect.max;
    ASSERT_TRUE(done(robot().click_at("Panel/chart", (place.x + right - min.x) / (max.x - min.x),
                                      (place.y - min.y) / (max.y - min.y))));
    robot().frames(40);
  }

  /// What `add` puts on a canvas: its bounding box, and the number of vertices.
  struct Ink {
    ImVec2 min{1e9f, 1e9f}, max{-1e9f, -1e9f};
    int vertices = 0;
  };
  Ink ink_of(const Drawing::Shape& shape, ImVec2 origin) {
    Ink ink;
    show([&] {
      ImDrawList& list = *ImGui::GetWindowDrawList();
      draw_chart({.width = 1, .height = 1, .background = {}, .shapes = {}}, list, origin);
      const int background = list.VtxBuffer.Size;
      draw_chart({.width = 1, .height = 1, .background = {}, .shapes = {shape}}, list, origin);
      ink = {};
      for (int i = background + 4; i < list.VtxBuffer.Size; ++i, ++ink.vertices) {
        const ImVec2 p = list.VtxBuffer[i].pos;
        ink.min = {std::min(ink.min.x, p.x), std::min(ink.min.y, p.y)};
        ink.max = {std::max(ink.max.x, p.x), std::max(ink.max.y, p.y)};
      }
    });
    return ink;
  }
};

TEST_F(ChartViewTest, DrawsSeriesInTheirColoursOnTheDarkGround) {
  Chart chart = one_point_chart(64, 0.05);
  chart.series.push_back({.name = "delta", .color = kGreen, .points = {{10, 0.02}, {100, 0.03}, {300, 0.1}}});
  show([&] { chart_view("chart", chart, {376, 260}); });
  EXPECT_TRUE(robot().visible("Panel/chart"));
  EXPECT_GT(find(kRed).count, 15) << "a disc in the plot and one in the legend";
  EXPECT_GT(find(kGreen).count, 100);
  const Rgb ground = lay_out(chart, {.ground = Ground::Dark}).drawing.background;
  EXPECT_GT(find(ground).count, 376 * 260 / 2);
}

TEST_F(ChartViewTest, TakesTheSizeItIsGiven) {
  const Chart chart = one_point_chart(64, 0.05);
  ImVec2 size{320, 200};
  show([&] { chart_view("chart", chart, size); });
  const ui::ItemRect rect = robot().last_drawn("Panel/chart")->rect;
  EXPECT_EQ(rect.max.x - rect.min.x, 320);
  EXPECT_EQ(rect.max.y - rect.min.y, 200);
  size = {0, -3};
  robot().frames(2);
  EXPECT_TRUE(robot().exists("Panel/chart")) << "as a point, and nothing stops";
}

TEST_F(ChartViewTest, HoveringAPointTellsItsSeriesAndValues) {
  Chart chart = one_point_chart(4096, 0.0316227766);
  show([&] { chart_view("chart", chart, {376, 260}); });
  const float middle = robot().last_drawn("Panel/chart")->rect.center().x;
  const Found disc = find(kRed, 0, middle + 40);  // the legend lies further to the right
  ASSERT_GT(disc.count, 5);
  rest_at(disc);
  EXPECT_EQ(robot().tooltip(), "decoupled\nsamples: 4096\nerror: 3.162 %");
  EXPECT_GT(find(kRed, 0, middle + 40).count, disc.count + 10) << "and it is ringed";

  rest_at(disc, 60);
  EXPECT_EQ(robot().tooltip(), "") << "nothing within reach";
  EXPECT_EQ(find(kRed, 0, middle + 40).count, disc.count);
}

TEST_F(ChartViewTest, TooltipOfTheNearerPointWithoutNamesCallsTheAxesXAndY) {
  Chart chart;
  chart.series = {{.color = kRed, .points = {{1, 2}, {3, 4}}, .line = LineStyle::None}};
  show([&] { chart_view("chart", chart, {376, 260}); });
  const float middle = robot().last_drawn("Panel/chart")->rect.center().x;
  rest_at(find(kRed, middle), -6);
  EXPECT_EQ(robot().tooltip(), "x: 3\ny: 4");
  rest_at(find(kRed, 0, middle), 6);
  EXPECT_EQ(robot().tooltip(), "x: 1\ny: 2");
}

TEST_F(ChartViewTest, EmptyChartHasNoTooltip) {
  show([] { chart_view("chart", Chart{}, {376, 260}); });
  ASSERT_TRUE(done(robot().hover("Panel/chart")));
  EXPECT_EQ(robot().tooltip(), "");
}

TEST_F(ChartViewTest, TextsStandAtTheirAnchor) {
  const ImVec2 origin(200, 200);
  const auto ink = [&](TextAnchor anchor) {
    return ink_of(Text{{10, 20}, anchor, 14, {255, 255, 255}, "HHHHHHHH"}, origin);
  };
  const Ink start = ink(TextAnchor::Start), middle = ink(TextAnchor::Middle), end = ink(TextAnchor::End);
  EXPECT_NEAR(start.min.x, 210, 3);
  EXPECT_NEAR((middle.min.x + middle.max.x) / 2, 210, 2);
  EXPECT_NEAR(end.max.x, 210, 3);
  for (const Ink& each : {start, middle, end}) {
    EXPECT_NEAR(each.max.y, 220, 2) << "H stands on the baseline";
    EXPECT_NEAR(each.max.y - each.min.y, 0.72 * 14, 3);
  }
}

TEST_F(ChartViewTest, RotatedTextReadsUpwardsAndIsWholeAtTheEdge) {
  const Text level{{2, 200}, TextAnchor::Middle, 14, {255, 255, 255}, "HHHHHHHHHHHHHHHHHHHH"};
  Text upright = level;
  upright.rotated = true;
  // At the left edge of the window half of the letters lie outside of it before they are turned.
  const Ink lying = ink_of(level, {200, 0}), standing = ink_of(upright, {20, 0});
  EXPECT_EQ(standing.vertices, lying.vertices) << "no letter is left out";
  EXPECT_NEAR(standing.max.y - standing.min.y, lying.max.x - lying.min.x, 0.01);
  EXPECT_NEAR(standing.max.x - standing.min.x, lying.max.y - lying.min.y, 0.01);
  EXPECT_NEAR((standing.min.y + standing.max.y) / 2, 200, 2);
  EXPECT_NEAR(standing.max.x, 22, 2) << "the baseline is at the right";
}

TEST_F(ChartViewTest, DashesAreFourWidthsOfSeven) {
  bool dashed = false;
  show([&] {
    const Line line{{0.5f, 10.5f}, {350.5f, 10.5f}, kRed, 3, dashed};
    draw_chart({.width = 360, .height = 20, .background = {}, .shapes = {line}}, *ImGui::GetWindowDrawList(),
               {40, 100});
  });
  const int solid_pixels = find(kRed).count;
  ASSERT_GT(solid_pixels, 350);
  dashed = true;
  robot().frames(2);
  EXPECT_NEAR(find(kRed).count, solid_pixels * 4.0 / 7, 0.1 * solid_pixels);  // ends are softened
}

TEST_F(ChartViewTest, LongLinesAndManyMarkersAreDrawnToTheirEnd) {
  Chart chart;
  chart.series = {{.color = kGreen, .points = {}, .line = LineStyle::None}};
  for (int i = 0; i < 20000; ++i) chart.series[0].points.push_back({std::sin(i), std::cos(1.7 * i)});
  Polyline line{.points = {}, .color = kRed, .width = 2};
  for (int i = 0; i <= 100000; ++i)
    line.points.push_back({static_cast<float>(i) * 0.003f, 5});  // 300 pixels to the right
  show([&] {
    chart_view("chart", chart, {376, 200});
    draw_chart({.width = 376, .height = 10, .background = {}, .shapes = {line}}, *ImGui::GetWindowDrawList(),
               {40, 350});
  });
  EXPECT_GT(find(kGreen).count, 10000);
  EXPECT_EQ(find(kRed, 325, 335).count, 20) << "two pixels high at its far end";
}

}  // namespace
}  // namespace brume
