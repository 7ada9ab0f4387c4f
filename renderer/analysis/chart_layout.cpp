#include "renderer/analysis/chart_layout.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/analysis/chart_labels.h"
#include "renderer/analysis/chart_lines.h"
#include "renderer/analysis/chart_plot.h"
#include "renderer/analysis/chart_style.h"
#include "renderer/analysis/chart_ticks.h"

namespace brume {
namespace {

using Pixel = std::array<float, 2>;

bool has_place_on(const Axis& axis, double value) { return std::isfinite(value) && (!axis.logarithmic || value > 0); }

bool has_place_on(const Chart& chart, const std::array<double, 2>& point) {
  return has_place_on(chart.x, point[0]) && has_place_on(chart.y, point[1]);
}

bool has_data(const Chart& chart) {
  return std::ranges::any_of(chart.series, [&](const Series& series) {
    return std::ranges::any_of(series.points, [&](const auto& point) { return has_place_on(chart, point); });
  });
}

/// What the axes have to show: the points, the marks, and the levels on y.
std::array<AxisRange, 2> ranges(const Chart& chart) {
  std::array<std::vector<double>, 2> values;
  const auto add = [&](const std::array<double, 2>& point) {
    if (!has_place_on(chart, point)) return;
    values[0].push_back(point[0]);
    values[1].push_back(point[1]);
  };
  for (const Series& series : chart.series) std::ranges::for_each(series.points, add);
  for (const Mark& mark : chart.marks) add(mark.at);
  for (const Level& level : chart.levels) values[1].push_back(level.y);
  return {axis_range(chart.x, values[0]), axis_range(chart.y, values[1])};
}

// ---- Legend --------------------------------------------------------------------------------------------------------

struct LegendEntry {
  const Series* series = nullptr;
  std::vector<std::string> lines;  ///< of the name
};

/// A column of samples and names; names too long for it are wrapped, then shortened.
class Legend {
 public:
  Legend(const Chart& chart, const ChartStyle& style, float most_width) : style_(style) {
    const float room = most_width - text_start();
    float widest = 0;
    for (const Series& series : chart.series) {
      if (series.name.empty()) continue;
      entries_.push_back({&series, wrapped(series.name, style.small(), room, 2)});
      for (const std::string& line : entries_.back().lines) widest = std::max(widest, text_width(line, style.small()));
    }
    width_ = entries_.empty() ? 0 : text_start() + widest;
  }

  /// 0 when no series has a name.
  float width() const { return width_; }

  /// Entries for which the height does not suffice are counted in a last line.
  void draw(Pixel corner, float height, Drawing& drawing) const {
    const float line = 1.25f * style_.small(), between = 0.35f * style_.small();
    float y = corner[1];
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const LegendEntry& entry = entries_[i];
      const float needed = line * static_cast<float>(entry.lines.size()) + between;
      const bool last = i + 1 == entries_.size();
      const auto put = [&](const std::string& text, float top, Rgb color) {
        const Pixel at{corner[0] + text_start(), top + 0.5f * line + 0.35f * style_.small()};
        drawing.shapes.emplace_back(Text{at, TextAnchor::Start, style_.small(), color, text});
      };
      if (y + needed + (last ? 0 : line) > corner[1] + height) {
        put("+ " + std::to_string(entries_.size() - i) + " more", y, style_.muted);
        return;
      }
      plot_sample(*entry.series, {corner[0], y + 0.5f * line}, sample(), style_, drawing);
      for (std::size_t row = 0; row < entry.lines.size(); ++row)
        put(entry.lines[row], y + line * static_cast<float>(row), style_.ink);
      y += needed;
    }
  }

 private:
  float sample() const { return 1.9f * style_.font; }
  float text_start() const { return sample() + 0.55f * style_.font; }

  const ChartStyle& style_;
  std::vector<LegendEntry> entries_;
  float width_ = 0;
};

// ---- Around the frame ----------------------------------------------------------------------------------------------

class Layout {
 public:
  Layout(const Chart& chart, const ChartSize& size)
      : chart_(chart),
        style_(chart_style(size)),
        has_data_(has_data(chart)),
        ranges_(ranges(chart)),
        legend_(chart, style_, 0.36f * size.width) {
    result_.drawing = {size.width, size.height, style_.background, {}};
  }

  ChartLayout run() && {
    place_frame();
    draw_heads();
    draw_grid();
    if (has_data_)
      plot(chart_, projection(), style_, result_.drawing);
    else
      draw_no_data();
    draw_frame();
    draw_tick_labels();
    draw_axis_labels();
    const float right = projection().max[0] + style_.font;
    legend_.draw({right, projection().min[1]}, projection().max[1] - projection().min[1], result_.drawing);
    return std::move(result_);
  }

 private:
  const Projection& projection() const { return result_.projection; }
  float width() const { return result_.drawing.width; }
  float height() const { return result_.drawing.height; }
  float edge() const { return 0.9f * style_.font; }  // kept free at the edges of the drawing
  float tick_mark() const { return 0.3f * style_.font; }
  float tick_gap() const { return 0.45f * style_.font; }  // from a tick's end to its label

  void add(Drawing::Shape shape) { result_.drawing.shapes.emplace_back(std::move(shape)); }
  void add_line(Pixel from, Pixel to, Rgb color) { add(Line{from, to, color, style_.hairline(), false}); }

  // --- Margins, each from what stands in it.

  float top_margin() const {
    float top = edge();
    if (!chart_.title.empty()) top += 1.3f * style_.title();
    if (!chart_.subtitle.empty()) top += 1.4f * style_.font;
    return top > edge() ? top + 0.6f * style_.font : top;
  }

  float bottom_margin() const {
    const float numbers = has_data_ ? tick_mark() + tick_gap() + style_.small() : 0;
    return edge() + numbers + (chart_.x.label.empty() ? 0 : 1.7f * style_.font);
  }

  float left_margin() const {
    float widest = 0;
    for (const Tick& tick : y_ticks_) widest = std::max(widest, text_width(tick.label, style_.small()));
    const float numbers = widest > 0 ? tick_mark() + tick_gap() + widest : 0;
    return edge() + numbers + (chart_.y.label.empty() ? 0 : 1.7f * style_.font);
  }

  float right_margin() const { return edge() + (legend_.width() > 0 ? style_.font + legend_.width() : 0); }

  void place_frame() {
    // Middles of pixels, so that hairlines are sharp; a frame of at least a pixel however small the drawing is.
    const auto snap = [](float v) { return std::floor(v) + 0.5f; };
    const float top = snap(top_margin()), bottom = std::max(top + 1, snap(height() - bottom_margin()));
    if (has_data_)
      y_ticks_ = axis_ticks(chart_.y, ranges_[1],
                            {.length = bottom - top,
                             .gap = 0.7f * style_.font,
                             .least_distance = std::max(2.2f * style_.font, (bottom - top) / 11),
                             .extent = [&](const std::string&) { return style_.small(); }});
    const float left = snap(left_margin());
    float right = std::max(left + 1, snap(width() - right_margin()));
    place_x_ticks(right - left);
    // The last label is centred below its tick and may stick out.
    for (const Tick& tick : x_ticks_) {
      const float end = left + static_cast<float>(ranges_[0].fraction(tick.value)) * (right - left) +
                        text_width(tick.label, style_.small()) / 2;
      if (!tick.label.empty() && end > width() - 0.3f * style_.font)
        right = std::max(left + 1, snap(right - (end - width() + 0.3f * style_.font)));
    }
    place_x_ticks(right - left);
    result_.projection = {.min = {left, top},
                          .max = {right, bottom},
                          .low = {ranges_[0].low, ranges_[1].low},
                          .high = {ranges_[0].high, ranges_[1].high},
                          .logarithmic = {ranges_[0].logarithmic, ranges_[1].logarithmic}};
  }

  void place_x_ticks(float length) {
    if (!has_data_) return;
    x_ticks_ = axis_ticks(chart_.x, ranges_[0],
                          {.length = length,
                           .gap = 0.9f * style_.font,
                           .least_distance = std::max(3 * style_.font, length / 12),
                           .extent = [&](const std::string& label) { return text_width(label, style_.small()); }});
  }

  // --- Lines.

  /// Of a tick, in the middle of a pixel.
  float tick_pixel(std::size_t axis, const Tick& tick) const {
    const auto fraction = static_cast<float>(ranges_[axis].fraction(tick.value));
    const Pixel &min = projection().min, &max = projection().max;
    const float at = axis == 0 ? min[0] + fraction * (max[0] - min[0]) : max[1] - fraction * (max[1] - min[1]);
    return std::floor(at) + 0.5f;
  }

  void draw_grid() {
    const Pixel &min = projection().min, &max = projection().max;
    for (const bool minor : {true, false}) {
      const Rgb color = minor ? style_.minor_grid : style_.grid;
      for (const Tick& tick : x_ticks_)
        if (tick.minor == minor) add_line({tick_pixel(0, tick), min[1]}, {tick_pixel(0, tick), max[1]}, color);
      for (const Tick& tick : y_ticks_)
        if (tick.minor == minor) add_line({min[0], tick_pixel(1, tick)}, {max[0], tick_pixel(1, tick)}, color);
    }
  }

  void draw_frame() {
    const Pixel &min = projection().min, &max = projection().max;
    // Corners are drawn twice so that they are closed on any canvas.
    const float h = style_.hairline() / 2;
    for (const float y : {min[1], max[1]}) add_line({min[0] - h, y}, {max[0] + h, y}, style_.frame);
    for (const float x : {min[0], max[0]}) add_line({x, min[1] - h}, {x, max[1] + h}, style_.frame);
  }

  // --- Texts.

  void draw_heads() {
    const float room = width() - 2 * edge();
    float y = edge();
    if (!chart_.title.empty()) {
      y += 0.95f * style_.title();
      add(Text{
          {edge(), y}, TextAnchor::Start, style_.title(), style_.ink, shortened(chart_.title, style_.title(), room)});
      y += 0.35f * style_.title();
    }
    if (!chart_.subtitle.empty())
      add(Text{{edge(), y + style_.font},
               TextAnchor::Start,
               style_.font,
               style_.muted,
               shortened(chart_.subtitle, style_.font, room)});
  }

  void draw_tick_labels() {
    const float size = style_.small();
    for (const Tick& tick : x_ticks_) {
      if (tick.label.empty()) continue;
      const float x = tick_pixel(0, tick), y = projection().max[1];
      add_line({x, y}, {x, y + tick_mark()}, style_.frame);
      const Pixel at{x, y + tick_mark() + tick_gap() + 0.72f * size};
      add(Text{at, TextAnchor::Middle, size, style_.muted, tick.label});
    }
    for (const Tick& tick : y_ticks_) {
      if (tick.label.empty()) continue;
      const float x = projection().min[0], y = tick_pixel(1, tick);
      add_line({x - tick_mark(), y}, {x, y}, style_.frame);
      const Pixel at{x - tick_mark() - tick_gap(), y + 0.35f * size};
      add(Text{at, TextAnchor::End, size, style_.muted, tick.label});
    }
  }

  void draw_axis_labels() {
    const Pixel &min = projection().min, &max = projection().max;
    const auto label = [&](const Axis& axis, Pixel at, float room, bool rotated) {
      const std::string text = shortened(axis.label, style_.font, room);
      if (!text.empty()) add(Text{at, TextAnchor::Middle, style_.font, style_.ink, text, rotated});
    };
    // Centred below and beside the frame, or the drawing where the frame is too short for them.
    const auto middle = [](float low, float high, float total, float needed) {
      return needed <= high - low
                 ? (low + high) / 2
                 : std::clamp((low + high) / 2, std::min(needed, total) / 2, total - std::min(needed, total) / 2);
    };
    const float wide = width() - edge(), tall = height() - edge();
    const float x = middle(min[0], max[0], width(), std::min(wide, text_width(chart_.x.label, style_.font)));
    const float y = middle(min[1], max[1], height(), std::min(tall, text_width(chart_.y.label, style_.font)));
    label(chart_.x, {x, height() - edge() - 0.15f * style_.font}, wide, false);
    label(chart_.y, {edge() + 0.75f * style_.font, y}, tall, true);
  }

  void draw_no_data() {
    const Pixel &min = projection().min, &max = projection().max;
    add(Text{{(min[0] + max[0]) / 2, (min[1] + max[1]) / 2 + 0.35f * style_.font},
             TextAnchor::Middle,
             style_.font,
             style_.muted,
             "no data yet"});
  }

  const Chart& chart_;
  ChartStyle style_;
  bool has_data_;
  std::array<AxisRange, 2> ranges_;
  Legend legend_;
  std::vector<Tick> x_ticks_, y_ticks_;
  ChartLayout result_;
};

}  // namespace

std::array<float, 2> Projection::to_pixels(std::array<double, 2> point) const {
  const std::array<double, 2> pixel = to_far_pixels(*this, point);
  return {static_cast<float>(pixel[0]), static_cast<float>(pixel[1])};
}

std::array<double, 2> Projection::to_data(std::array<float, 2> pixel) const {
  const double x = static_cast<double>(pixel[0] - min[0]) / static_cast<double>(max[0] - min[0]);
  const double y = static_cast<double>(max[1] - pixel[1]) / static_cast<double>(max[1] - min[1]);
  return {AxisRange{low[0], high[0], logarithmic[0]}.value(x), AxisRange{low[1], high[1], logarithmic[1]}.value(y)};
}

bool Projection::contains(std::array<float, 2> pixel) const {
  return pixel[0] >= min[0] && pixel[0] <= max[0] && pixel[1] >= min[1] && pixel[1] <= max[1];
}

bool Projection::has_place(std::array<double, 2> point) const {
  for (std::size_t i = 0; i < 2; ++i)
    if (!std::isfinite(point[i]) || (logarithmic[i] && point[i] <= 0)) return false;
  return true;
}

ChartLayout lay_out(const Chart& chart, const ChartSize& size) {
  ChartSize valid = size;
  valid.width = std::max(1.0f, size.width);
  valid.height = std::max(1.0f, size.height);
  return Layout(chart, valid).run();
}

std::optional<NearestPoint> nearest_point(const Chart& chart, const Projection& projection, std::array<float, 2> pixel,
                                          float reach) {
  std::optional<NearestPoint> nearest;
  float least = reach;
  for (std::size_t series = 0; series < chart.series.size(); ++series)
    for (std::size_t point = 0; point < chart.series[series].points.size(); ++point) {
      const std::array<double, 2>& data = chart.series[series].points[point];
      if (!projection.has_place(data)) continue;
      const Pixel at = projection.to_pixels(data);
      const float distance = std::hypot(at[0] - pixel[0], at[1] - pixel[1]);
      if (!projection.contains(at) || !(distance <= least)) continue;
      least = distance;
      nearest = {series, point};
    }
  return nearest;
}

}  // namespace brume
