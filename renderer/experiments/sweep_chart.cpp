#include "renderer/experiments/sweep_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace brume {
namespace {

const Scene& scene_of(const Sweep& s, const SweepRow& r) { return *s.scenes[r.variant]; }

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

const std::vector<SweepAxis>& sweep_axes() {
  using Kind = SweepAxis::Kind;
  static const std::vector<SweepAxis> axes{
      {"cpu_seconds", "CPU time (s)", [](const Sweep&, const SweepRow& r) { return r.cpu_seconds; }, Kind::Cost},
      {"step_size", "step size (world units)",
       [](const Sweep& s, const SweepRow& r) { return static_cast<double>(scene_of(s, r).step_size); }, Kind::Setting},
      {"steps", "steps across the scene",
       [](const Sweep& s, const SweepRow& r) {
         return scene_of(s, r).bounds.empty()
                    ? kNone
                    : scene_of(s, r).bounds.diagonal() / static_cast<double>(scene_of(s, r).step_size);
       },
       Kind::Setting},
      {"bounces", "bounces",
       [](const Sweep& s, const SweepRow& r) { return static_cast<double>(scene_of(s, r).render.bounces); },
       Kind::Setting},
      {"light_samples", "light samples",
       [](const Sweep& s, const SweepRow& r) { return static_cast<double>(scene_of(s, r).light_samples); },
       Kind::Setting},
      {"rmse", "RMSE (radiance)", [](const Sweep&, const SweepRow& r) { return r.errors.rmse; }, Kind::Error},
      {"rmse_net", "net RMSE (radiance)",
       [](const Sweep&, const SweepRow& r) {
         return std::sqrt(std::max(r.errors.rmse * r.errors.rmse - r.reference_variance, 0.0));
       },
       Kind::Error},
      {"relative_mse", "relative MSE", [](const Sweep&, const SweepRow& r) { return r.errors.relative_mse; },
       Kind::Error},
      {"mean_bias", "|mean bias| (radiance)",
       [](const Sweep&, const SweepRow& r) { return std::abs(r.errors.mean_bias); }, Kind::Error},
      {"relative_mean_bias", "|mean bias| / mean",
       [](const Sweep&, const SweepRow& r) { return std::abs(r.errors.relative_mean_bias); }, Kind::Error},
      {"median_of_tiles", "median of tiles (radiance)",
       [](const Sweep&, const SweepRow& r) { return r.errors.median_of_tiles; }, Kind::Error},
      {"seconds_per_sample", "CPU time per sample (s)",
       [](const Sweep&, const SweepRow& r) { return r.cpu_seconds / r.samples_per_pixel; }, Kind::Cost}};
  return axes;
}

const SweepAxis* find_sweep_axis(const std::string& key) {
  const auto& axes = sweep_axes();
  const auto found = std::find_if(axes.begin(), axes.end(), [&](const SweepAxis& a) { return a.key == key; });
  return found == axes.end() ? nullptr : &*found;
}

std::vector<std::string> sweep_axis_keys() {
  std::vector<std::string> keys;
  for (const SweepAxis& a : sweep_axes()) keys.push_back(a.key);
  return keys;
}

std::optional<double> fitted_exponent(const std::vector<std::array<double, 2>>& points) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const auto& [x, y] : points) {
    if (!(x > 0) || !(y > 0)) continue;
    const double lx = std::log(x), ly = std::log(y);
    n += 1, sx += lx, sy += ly, sxx += lx * lx, sxy += lx * ly;
  }
  const double spread = n * sxx - sx * sx;
  if (n < 2 || !(spread > 1e-12 * n * sxx)) return std::nullopt;
  return (n * sxy - sx * sy) / spread;
}

std::optional<double> error_floor(const std::vector<std::array<double, 2>>& points) {
  constexpr std::size_t kFewest = 6;
  if (points.size() < kFewest) return std::nullopt;
  double w = 0, wx = 0, wxx = 0, wy = 0, wxy = 0;
  for (std::size_t i = points.size() / 2; i < points.size(); ++i) {
    const auto& [t, e] = points[i];
    if (!(t > 0) || !(e > 0)) return std::nullopt;
    const double weight = 1 / (e * e * e * e), x = 1 / t, y = e * e;
    w += weight, wx += weight * x, wxx += weight * x * x, wy += weight * y, wxy += weight * x * y;
  }
  const double spread = w * wxx - wx * wx;
  if (!(spread > 0)) return std::nullopt;
  const double floor = std::sqrt(std::max(0.0, (wxx * wy - wx * wxy) / spread));
  constexpr double kFlat = 0.8;
  if (!(floor >= kFlat * points.back()[1])) return std::nullopt;
  return floor;
}

namespace {

/// A dashed line at the floor of each line that has one, over the times of its later half.
void add_floors(Chart& chart) {
  const std::size_t lines = chart.series.size();
  bool named = false;
  for (std::size_t i = 0; i < lines; ++i) {
    const auto floor = error_floor(chart.series[i].points);
    if (!floor) continue;
    const auto& points = chart.series[i].points;
    chart.series.push_back({.name = named ? "" : "floor where a line flattens",
                            .color = chart.series[i].color,
                            .points = {{points[points.size() / 2][0], *floor}, {points.back()[0], *floor}},
                            .line = LineStyle::Dashed,
                            .markers = false});
    named = true;
  }
}

/// "ray_march: n^1.98", of the upper half of the points: below it, what does not depend on the steps counts most.
void name_exponent(Series& series) {
  const auto middle = series.points.begin() + static_cast<std::ptrdiff_t>(series.points.size() / 2);
  auto exponent = fitted_exponent({middle, series.points.end()});
  if (!exponent) exponent = fitted_exponent(series.points);  // too few to have halves
  if (!exponent) return;
  char text[32];
  std::snprintf(text, sizeof text, ": n^%.2f", *exponent);
  series.name += text;
}

/// The line of that name; a new one has the next colour. Colours come again after eight: then in dashes.
Series& series_named(Chart& chart, const std::string& name) {
  const auto found =
      std::find_if(chart.series.begin(), chart.series.end(), [&](const Series& s) { return s.name == name; });
  if (found != chart.series.end()) return *found;
  const std::size_t n = chart.series.size();
  const LineStyle line = n >= 8 ? LineStyle::Dashed : LineStyle::Solid;
  return chart.series.emplace_back(Series{.name = name, .color = series_color(n), .line = line});
}

/// The point from which a guide is drawn: where the first line begins.
std::optional<std::array<double, 2>> first_point(const Chart& chart) {
  for (const Series& s : chart.series)
    for (const auto& p : s.points)
      if (p[0] > 0 && p[1] > 0) return p;
  return std::nullopt;
}

}  // namespace

Chart chart_of(const Sweep& sweep, const SweepAxis& x, const SweepAxis& y, const std::string& title) {
  const bool by_setting = x.kind == SweepAxis::Kind::Setting;
  Chart chart;
  chart.title = title;
  chart.x.label = x.label, chart.y.label = y.label;
  chart.x.whole = x.key == "bounces" || x.key == "light_samples";
  const bool relative = y.key == "relative_mean_bias";
  chart.y.percent = relative;
  bool positive_x = true, positive_y = true;
  for (const SweepRow& row : sweep.rows) {
    if (by_setting && !row.last) continue;
    const SweepVariant& variant = sweep.variants[row.variant];
    const std::string& name = by_setting ? variant.series : variant.name;
    const std::array<double, 2> point{x.value(sweep, row), y.value(sweep, row)};
    positive_x &= point[0] > 0, positive_y &= point[1] > 0;
    series_named(chart, name).points.push_back(point);
  }
  chart.x.logarithmic = positive_x && x.key != "bounces";
  chart.y.logarithmic = positive_y || y.kind == SweepAxis::Kind::Error;  // an error of exactly 0 has no place
  if (by_setting)
    for (Series& s : chart.series) std::sort(s.points.begin(), s.points.end());
  if (x.key == "steps" && y.key == "seconds_per_sample")
    for (Series& s : chart.series) name_exponent(s);
  if (x.key == "cpu_seconds" && y.kind == SweepAxis::Kind::Error)
    if (const auto from = first_point(chart)) {
      const bool squared = y.key == "relative_mse";
      chart.guides.push_back({squared ? "t^-1" : "t^-1/2", squared ? -1.0 : -0.5, *from});
    }
  if (x.key == "cpu_seconds" && y.key.starts_with("rmse")) add_floors(chart);
  if (y.key.starts_with("rmse") && sweep.references.size() == 1 && sweep.references[0].variance > 0)
    chart.levels.push_back({"error of the reference itself", std::sqrt(sweep.references[0].variance), {140, 140, 140}});
  return chart;
}

std::vector<std::size_t> pareto_front(const Sweep& sweep, const SweepAxis& error) {
  std::vector<std::size_t> order(sweep.rows.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sweep.rows[a].cpu_seconds < sweep.rows[b].cpu_seconds; });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) {
    const double e = error.value(sweep, sweep.rows[i]);
    if (!(e < least)) continue;
    least = e;
    front.push_back(i);
  }
  return front;
}

std::optional<std::size_t> best_row(const Sweep& sweep, const SweepAxis& error, std::optional<double> target) {
  const std::vector<std::size_t> front = pareto_front(sweep, error);
  if (front.empty()) return std::nullopt;
  constexpr double kNearlyLeast = 1.1;
  const double enough = target.value_or(kNearlyLeast * error.value(sweep, sweep.rows[front.back()]));
  for (const std::size_t i : front)
    if (error.value(sweep, sweep.rows[i]) <= enough) return i;
  return std::nullopt;
}

void add_front(const Sweep& sweep, const SweepAxis& error, std::optional<double> target, Chart& chart) {
  constexpr Rgb kFront{200, 60, 60};
  Series front{.name = "cheapest for its error", .color = kFront, .line = LineStyle::Dashed, .markers = false};
  const auto point = [&](std::size_t i) {
    return std::array<double, 2>{sweep.rows[i].cpu_seconds, error.value(sweep, sweep.rows[i])};
  };
  for (const std::size_t i : pareto_front(sweep, error)) front.points.push_back(point(i));
  chart.series.push_back(std::move(front));
  if (target) chart.levels.push_back({"target", *target, kFront});
  if (const auto best = best_row(sweep, error, target))
    chart.marks.push_back({sweep.variants[sweep.rows[*best].variant].name, point(*best), kFront});
}

Chart pareto_chart(const Sweep& sweep, const SweepAxis& error) {
  Chart chart;
  const SweepAxis& time = *find_sweep_axis("cpu_seconds");
  chart.x = {.label = time.label, .logarithmic = true};
  chart.y = {.label = error.label, .logarithmic = true, .percent = error.key == "relative_mean_bias"};
  for (const SweepRow& row : sweep.rows) {
    Series& series = series_named(chart, sweep.variants[row.variant].series);
    series.line = LineStyle::None;
    series.points.push_back({time.value(sweep, row), error.value(sweep, row)});
  }
  add_front(sweep, error, {}, chart);
  return chart;
}

std::string csv_of(const Sweep& sweep) {
  std::string csv =
      "variant,integrator,distance_sampling,step_size,bounces,light_samples,samples_per_pixel,cpu_seconds,rmse,"
      "relative_mse,mean_bias,relative_mean_bias,median_of_tiles,reference_rmse\n";
  // Quoted as RFC 4180 says, because names may hold commas.
  const auto quoted = [](const std::string& text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
  };
  for (const SweepRow& row : sweep.rows) {
    const SweepVariant& variant = sweep.variants[row.variant];
    const Scene& scene = scene_of(sweep, row);
    const Node& render = variant.description.child("render");
    const bool distances = render.table().find("distance_sampling");
    const bool marches = render.table().find("step_size");
    std::vector<std::string> cells{quoted(variant.name),
                                   render.kind(),
                                   distances ? render.text("distance_sampling") : "",
                                   marches ? format_value(static_cast<double>(scene.step_size)) : "",
                                   std::to_string(scene.render.bounces),
                                   std::to_string(scene.light_samples),
                                   std::to_string(row.samples_per_pixel)};
    for (const double v :
         {row.cpu_seconds, row.errors.rmse, row.errors.relative_mse, row.errors.mean_bias,
          row.errors.relative_mean_bias, row.errors.median_of_tiles, std::sqrt(row.reference_variance)})
      cells.push_back(format_value(v));
    csv += join(cells, ",") + "\n";
  }
  return csv;
}

}  // namespace brume
