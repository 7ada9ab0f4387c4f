// What a sweep tells: charts, tables, the best.
#pragma once

#include <optional>
#include <string>

#include "renderer/analysis/chart.h"
#include "renderer/experiments/sweep.h"

namespace brume {

/// What stands along an axis of a sweep's chart.
struct SweepAxis {
  std::string key;    ///< "cpu_seconds"
  std::string label;  ///< "CPU time (s)"
  double (*value)(const Sweep& sweep, const SweepRow& row);
  enum class Kind {
    Setting,  ///< of the variant: one value for all its rows
    Cost,
    Error,
  } kind;
};

/// cpu_seconds, step_size, steps (across the scene), bounces, light_samples; rmse, rmse_net (what is left of it when
/// the noise of the reference, which is independent, is taken out: sqrt(mse - variance)), relative_mse, mean_bias (its
/// size), relative_mean_bias (its size), median_of_tiles, seconds_per_sample (of the whole picture).
const std::vector<SweepAxis>& sweep_axes();
const SweepAxis* find_sweep_axis(const std::string& key);
std::vector<std::string> sweep_axis_keys();

/// What an error comes to in the end: sqrt(b) of e^2 = a / t + b, fitted to the later half of the points (weights
/// 1 / e^4). Nothing while the line still falls: where the floor is less than 0.8 of the last error, or points are
/// fewer than six.
/// @param points  (time, error), both above 0, in the order of time
std::optional<double> error_floor(const std::vector<std::array<double, 2>>& points);

/// y against x, both logarithmic where all values are above 0: a line for each variant along its rows, or, where x is
/// a setting, for each series along its variants, which have their last rows. Errors have a guide of slope -1/2 against
/// time, the floor of each line that flattens, and the reference's own error as a level; costs against steps have the
/// exponent fitted to the upper half of each line in its name.
Chart chart_of(const Sweep& sweep, const SweepAxis& x, const SweepAxis& y, const std::string& title);

/// Least-squares slope of log y over log x; nothing for fewer than two points above 0 at different x.
std::optional<double> fitted_exponent(const std::vector<std::array<double, 2>>& points);

/// Rows that no other row beats in both time and error: the cheapest for what they give, cheapest first.
/// @param error  an axis whose values are errors
std::vector<std::size_t> pareto_front(const Sweep& sweep, const SweepAxis& error);

/// The row of the front to choose: the first whose error is at most the target, or without a target within a tenth of
/// the least: who needs no more should not pay for more. Nothing when no row is good enough.
std::optional<std::size_t> best_row(const Sweep& sweep, const SweepAxis& error, std::optional<double> target);

/// All rows as points, error against time: those of one series, a method, in one colour. With the front.
Chart pareto_chart(const Sweep& sweep, const SweepAxis& error);

/// The front as a dashed line and the best row as a mark.
void add_front(const Sweep& sweep, const SweepAxis& error, std::optional<double> target, Chart& chart);

/// All rows, with a line of column names: variant, integrator, distance_sampling, step_size, bounces, light_samples,
/// samples_per_pixel, cpu_seconds and the errors. Numbers have the digits that read back as the same value.
std::string csv_of(const Sweep& sweep);

}  // namespace brume
