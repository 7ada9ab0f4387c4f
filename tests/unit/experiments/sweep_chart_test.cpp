#include "renderer/experiments/sweep_chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/support/scenes.h"

namespace brume {
namespace {

/// A sweep whose numbers are made up: `errors[v]` after 1, 2, 4, ... samples that cost `cost[v]` each.
Sweep made_up(const std::vector<double>& cost, const std::vector<std::vector<double>>& errors) {
  Sweep sweep;
  sweep.references.resize(1);
  for (std::size_t v = 0; v < cost.size(); ++v) {
    Node scene = empty_scene();
    set(scene, "render.step_size", std::to_string(0.1 * double(v + 1)));
    sweep.variants.push_back({"variant " + std::to_string(v), v < 2 ? "first" : "second", scene});
    sweep.scenes.push_back(committed(scene));
    for (std::size_t i = 0; i < errors[v].size(); ++i)
      sweep.rows.push_back({v, 1 << i, cost[v] * (1 << i), {.rmse = errors[v][i]}, 0, i + 1 == errors[v].size()});
  }
  return sweep;
}

const SweepAxis& axis(const char* key) { return *find_sweep_axis(key); }

TEST(SweepChart, TheFrontHoldsWhatNothingBeatsInTimeAndError) {
  // Times 1 2 4, 0.5 1 2, 3 6 12.
  const Sweep sweep = made_up({1, 0.5, 3}, {{0.5, 0.4, 0.1}, {0.9, 0.6, 0.45}, {0.2, 0.15, 0.05}});
  std::vector<std::string> front;
  for (const std::size_t i : pareto_front(sweep, axis("rmse")))
    front.push_back(std::to_string(sweep.rows[i].variant) + "@" + std::to_string(sweep.rows[i].samples_per_pixel));
  EXPECT_EQ(front, (std::vector<std::string>{"1@1", "0@1", "0@2", "2@1", "0@4", "2@4"}));
}

TEST(SweepChart, TheBestIsTheCheapestThatIsGoodEnough) {
  const Sweep sweep = made_up({1, 0.5, 3}, {{0.5, 0.4, 0.1}, {0.9, 0.6, 0.45}, {0.2, 0.15, 0.098}});
  const auto best = [&](std::optional<double> target) -> std::string {
    const auto row = best_row(sweep, axis("rmse"), target);
    return row ? std::to_string(sweep.rows[*row].variant) + "@" + std::to_string(sweep.rows[*row].samples_per_pixel)
               : "none";
  };
  EXPECT_EQ(best(0.45), "0@2");
  EXPECT_EQ(best(0.2), "2@1");
  EXPECT_EQ(best(0.01), "none");
  EXPECT_EQ(best(std::nullopt), "0@4") << "0.1 is within a tenth of 0.098, for a third of the time";
}

TEST(SweepChart, LinesAlongTimeAreVariantsAndAlongASettingSeries) {
  const Sweep sweep = made_up({1, 2, 4}, {{0.5, 0.4}, {0.3, 0.2}, {0.6, 0.1}});
  const Chart time = chart_of(sweep, axis("cpu_seconds"), axis("rmse"), "title");
  ASSERT_EQ(time.series.size(), 3u);
  EXPECT_EQ(time.series[1].name, "variant 1");
  EXPECT_EQ(time.series[1].points, (std::vector<std::array<double, 2>>{{2, 0.3}, {4, 0.2}}));
  ASSERT_EQ(time.guides.size(), 1u);
  EXPECT_EQ(time.guides[0].slope, -0.5);
  const Chart step = chart_of(sweep, axis("step_size"), axis("rmse"), "title");
  ASSERT_EQ(step.series.size(), 2u);
  EXPECT_EQ(step.series[0].name, "first");
  ASSERT_EQ(step.series[0].points.size(), 2u) << "the last row of each variant";
  EXPECT_NEAR(step.series[0].points[0][0], 0.1, 1e-7);
  EXPECT_EQ(step.series[0].points[0][1], 0.4);
  EXPECT_EQ(step.series[0].points[1][1], 0.2);
  EXPECT_TRUE(step.guides.empty());
}

TEST(SweepChart, ExponentsAreFittedByLeastSquares) {
  std::vector<std::array<double, 2>> points;
  for (const double x : {1.0, 2.0, 5.0, 11.0}) points.push_back({x, 7 * std::pow(x, 1.9)});
  EXPECT_NEAR(*fitted_exponent(points), 1.9, 1e-12);
  points.push_back({0, 3});
  EXPECT_NEAR(*fitted_exponent(points), 1.9, 1e-12) << "no logarithm";
  EXPECT_FALSE(fitted_exponent({{2, 1}, {2, 3}}));
  EXPECT_FALSE(fitted_exponent({{2, 1}}));
}

TEST(SweepChart, CostsAgainstStepsSayTheirExponent) {
  // Steps 0.1, 0.2 of one series: half as many steps in the second, a quarter of the cost.
  const Sweep sweep = made_up({4, 1}, {{0.5}, {0.5}});
  const Chart chart = chart_of(sweep, axis("step_size"), axis("seconds_per_sample"), "");
  EXPECT_EQ(chart.series[0].name, "first") << "only against the number of steps";
  Sweep with_volume = sweep;
  for (std::size_t v = 0; v < 2; ++v) {
    Node scene = with_volume.variants[v].description;
    add_volume(scene, "homogeneous");
    with_volume.scenes[v] = committed(scene);
  }
  EXPECT_EQ(chart_of(with_volume, axis("steps"), axis("seconds_per_sample"), "").series[0].name, "first: n^2.00");
}

TEST(SweepChart, TheReferencesNoiseIsTakenOutAndShown) {
  Sweep sweep = made_up({1}, {{0.5, 0.3}});
  sweep.references[0].variance = 0.16;
  for (SweepRow& row : sweep.rows) row.reference_variance = 0.16;
  EXPECT_NEAR(axis("rmse_net").value(sweep, sweep.rows[0]), 0.3, 1e-12);
  EXPECT_EQ(axis("rmse_net").value(sweep, sweep.rows[1]), 0) << "less than the noise: nothing is left";
  const Chart chart = chart_of(sweep, axis("cpu_seconds"), axis("rmse"), "");
  ASSERT_EQ(chart.levels.size(), 1u);
  EXPECT_NEAR(chart.levels[0].y, 0.4, 1e-12);
}

TEST(SweepChart, ALineThatFlattensHasAFloor) {
  const auto line = [](const std::function<double(double)>& error) {
    std::vector<std::array<double, 2>> points;
    for (double t = 0.1; t < 200; t *= 1.6) points.push_back({t, error(t)});
    return points;
  };
  const auto flat = line([](double t) { return std::sqrt(0.04 / t + 0.1 * 0.1); });
  EXPECT_NEAR(*error_floor(flat), 0.1, 1e-9);
  EXPECT_FALSE(error_floor(line([](double t) { return 0.2 / std::sqrt(t); }))) << "pure noise";
  EXPECT_FALSE(error_floor(line([](double t) { return 0.2 / t; }))) << "noise of a sequence";
  EXPECT_FALSE(error_floor({flat.begin(), flat.begin() + 5})) << "too few";
  EXPECT_FALSE(error_floor({flat.begin(), flat.begin() + 8})) << "still falling";

  Sweep sweep = made_up({1}, {{0.5, 0.4, 0.3, 0.26, 0.25, 0.25, 0.25, 0.25}});
  const Chart chart = chart_of(sweep, axis("cpu_seconds"), axis("rmse"), "");
  ASSERT_EQ(chart.series.size(), 2u);
  EXPECT_EQ(chart.series[1].color, chart.series[0].color);
  EXPECT_EQ(chart.series[1].line, LineStyle::Dashed);
  EXPECT_NEAR(chart.series[1].points[0][1], 0.25, 0.005);
}

TEST(SweepChart, NumbersOfTheChartAreThoseOfTheTable) {
  const Sweep sweep = made_up({0.1, 0.7}, {{1.0 / 3, 0.25}, {0.7, 2.0 / 7}});
  std::istringstream csv(csv_of(sweep));
  std::string line;
  std::getline(csv, line);
  EXPECT_TRUE(
      line.starts_with("variant,integrator,distance_sampling,step_size,bounces,light_samples,samples_per_pixel,"
                       "cpu_seconds,rmse,relative_mse,mean_bias"))
      << line;
  const Chart chart = chart_of(sweep, axis("cpu_seconds"), axis("rmse"), "");
  for (const Series& series : chart.series)
    for (const auto& [x, y] : series.points) {
      ASSERT_TRUE(std::getline(csv, line));
      std::vector<std::string> cells;
      std::istringstream cell_stream(line);
      for (std::string cell; std::getline(cell_stream, cell, ',');) cells.push_back(cell);
      EXPECT_EQ(cells[0], "\"" + series.name + "\"");
      EXPECT_EQ(std::stod(cells[7]), x);
      EXPECT_EQ(std::stod(cells[8]), y);
    }
  EXPECT_FALSE(std::getline(csv, line));
}

}  // namespace
}  // namespace brume
