#include "renderer/analysis/chart_plot.h"

#include <cmath>
#include <optional>

#include "renderer/analysis/chart_labels.h"
#include "renderer/analysis/chart_lines.h"

namespace brume {
namespace {

using Pixel = std::array<float, 2>;

class Plotter {
 public:
  Plotter(const Chart& chart, const Projection& projection, const ChartStyle& style, Drawing& drawing)
      : chart_(chart), projection_(projection), style_(style), drawing_(drawing), space_(inside(projection)) {}

  void draw() {
    for (const Guide& guide : chart_.guides) draw_guide(guide);
    for (const Level& level : chart_.levels) draw_level(level);
    for (const Series& series : chart_.series) draw_line(series);
    for (const Series& series : chart_.series) draw_markers(series);
    for (const Mark& mark : chart_.marks) draw_mark(mark);
    // Labels come last: only now is it known what they must not cover.
    for (const Mark& mark : chart_.marks) label_mark(mark);
    for (const Level& level : chart_.levels) label_level(level);
    for (const Guide& guide : chart_.guides) label_guide(guide);
  }

 private:
  static Box inside(const Projection& p) {
    return {{static_cast<double>(p.min[0]), static_cast<double>(p.min[1])},
            {static_cast<double>(p.max[0]), static_cast<double>(p.max[1])}};
  }

  static Pixel pixel(std::array<double, 2> p) { return {static_cast<float>(p[0]), static_cast<float>(p[1])}; }

  // --- Lines.

  void draw_guide(const Guide& guide) {
    if (const auto line = guide_line(guide))
      drawing_.shapes.emplace_back(Line{pixel(line->from), pixel(line->to), style_.guide, style_.hairline(), false});
  }

  std::optional<Segment> guide_line(const Guide& guide) const {
    if (!projection_.logarithmic[0] || !projection_.logarithmic[1] || !projection_.has_place(guide.through) ||
        !std::isfinite(guide.slope))
      return std::nullopt;
    // In pixels, along decades of x; the power itself could overflow far outside of the frame.
    const auto at = to_far_pixels(projection_, guide.through);
    const double decades_x = std::log10(projection_.high[0]) - std::log10(projection_.low[0]);
    const double decades_y = std::log10(projection_.high[1]) - std::log10(projection_.low[1]);
    const Box frame = inside(projection_);
    const double dx = (frame.max[0] - frame.min[0]) / decades_x,
                 dy = -guide.slope * (frame.max[1] - frame.min[1]) / decades_y;
    const double before = (frame.min[0] - at[0]) / dx, after = (frame.max[0] - at[0]) / dx;
    return clipped({{at[0] + before * dx, at[1] + before * dy}, {at[0] + after * dx, at[1] + after * dy}}, frame.min,
                   frame.max);
  }

  void draw_level(const Level& level) {
    const std::optional<float> y = level_y(level);
    if (!y) return;
    const Pixel from{projection_.min[0], *y}, to{projection_.max[0], *y};
    drawing_.shapes.emplace_back(Line{from, to, level.color, 0.8f * style_.line(), true});
  }

  std::optional<float> level_y(const Level& level) const {
    const std::array<double, 2> at{projection_.low[0], level.y};
    if (!projection_.has_place(at)) return std::nullopt;
    const Pixel p = projection_.to_pixels(at);
    if (!(p[1] >= projection_.min[1] && p[1] <= projection_.max[1])) return std::nullopt;
    return p[1];
  }

  // --- Series.

  void draw_line(const Series& series) {
    if (series.line == LineStyle::None) return;
    for (PixelLine& piece : lines_in_frame(series.points, projection_)) {
      for (std::size_t i = 1; i < piece.size(); ++i)
        space_.avoid(Segment{{static_cast<double>(piece[i - 1][0]), static_cast<double>(piece[i - 1][1])},
                             {static_cast<double>(piece[i][0]), static_cast<double>(piece[i][1])}});
      drawing_.shapes.emplace_back(
          Polyline{std::move(piece), series.color, style_.line(), series.line == LineStyle::Dashed});
    }
  }

  void draw_markers(const Series& series) {
    constexpr float kSame = 0.25f;  // pixels: a marker this close to the one before it shows nothing new
    std::optional<Pixel> previous;
    if (!series.markers) return;
    for (const std::array<double, 2>& point : series.points) {
      if (!projection_.has_place(point)) continue;
      const Pixel at = projection_.to_pixels(point);
      if (!projection_.contains(at)) continue;
      if (previous && std::hypot(at[0] - (*previous)[0], at[1] - (*previous)[1]) < kSame) continue;
      previous = at;
      avoid_around(at, style_.marker());
      drawing_.shapes.emplace_back(Disc{at, style_.marker(), series.color});
    }
  }

  void avoid_around(Pixel at, float radius) {
    const double x = static_cast<double>(at[0]), y = static_cast<double>(at[1]), r = static_cast<double>(radius);
    space_.avoid(Segment{{x - r, y - r}, {x + r, y + r}});
    space_.avoid(Segment{{x - r, y + r}, {x + r, y - r}});
  }

  // --- Marks and labels.

  std::optional<Pixel> mark_place(const Mark& mark) const {
    if (!projection_.has_place(mark.at)) return std::nullopt;
    const Pixel at = projection_.to_pixels(mark.at);
    return projection_.contains(at) ? std::optional(at) : std::nullopt;
  }

  float mark_radius() const { return 2.1f * style_.marker(); }

  void draw_mark(const Mark& mark) {
    const std::optional<Pixel> at = mark_place(mark);
    if (!at) return;
    avoid_around(*at, mark_radius());
    drawing_.shapes.emplace_back(Disc{*at, mark_radius(), mark.color, style_.line()});
  }

  /// The box of a label whose middle lies at this place.
  Box box_around(const std::string& label, double x, double y) const {
    const double half = static_cast<double>(text_width(label, style_.small())) / 2;
    const double height = static_cast<double>(0.6f * style_.small());
    return {{x - half, y - height}, {x + half, y + height}};
  }

  void put_label(const std::string& label, std::span<const Box> places, Rgb color) {
    const Box& place = places[space_.take(places)];
    const Pixel middle = pixel({(place.min[0] + place.max[0]) / 2, (place.min[1] + place.max[1]) / 2});
    drawing_.shapes.emplace_back(
        Text{{middle[0], middle[1] + 0.35f * style_.small()}, TextAnchor::Middle, style_.small(), color, label});
  }

  void label_mark(const Mark& mark) {
    const std::optional<Pixel> at = mark_place(mark);
    if (!at || mark.label.empty()) return;
    const double x = static_cast<double>((*at)[0]), y = static_cast<double>((*at)[1]);
    const double beside =
        static_cast<double>(mark_radius() + 0.4f * style_.font + text_width(mark.label, style_.small()) / 2);
    const double above = static_cast<double>(mark_radius() + 0.8f * style_.font);
    // Beside, above and below, then the corners, from the near to the far.
    std::vector<Box> places{box_around(mark.label, x + beside, y), box_around(mark.label, x, y - above),
                            box_around(mark.label, x, y + above), box_around(mark.label, x - beside, y)};
    for (const double out : {1.0, 1.5})
      for (const double part : {0.5, 1.0, 1.5, 0.0})
        for (const double right : {out, -out})
          for (const double down : {-part, part})
            places.push_back(box_around(mark.label, x + right * beside, y + down * above));
    put_label(mark.label, places, style_.ink);
  }

  void label_level(const Level& level) {
    const std::optional<float> y = level_y(level);
    if (!y || level.label.empty()) return;
    const double margin = static_cast<double>(0.5f * style_.font + text_width(level.label, style_.small()) / 2);
    const double right = static_cast<double>(projection_.max[0]) - margin;
    const double left = static_cast<double>(projection_.min[0]) + margin;
    const double offset = static_cast<double>(0.75f * style_.font), middle = static_cast<double>(*y);
    // At the right, unless lines are in the way there and the left is free.
    const std::array<Box, 4> places{
        box_around(level.label, right, middle - offset), box_around(level.label, right, middle + offset),
        box_around(level.label, left, middle - offset), box_around(level.label, left, middle + offset)};
    put_label(level.label, places, level.color);
  }

  void label_guide(const Guide& guide) {
    const std::optional<Segment> line = guide_line(guide);
    if (!line || guide.label.empty()) return;
    const double half = static_cast<double>(text_width(guide.label, style_.small())) / 2;
    const double along_x = line->to[0] - line->from[0], along_y = line->to[1] - line->from[1];
    const double length = std::hypot(along_x, along_y);
    if (length < 1) return;
    // Far enough from the line that no corner of the box touches it.
    const double height = static_cast<double>(0.6f * style_.small());
    const double distance = half * std::abs(along_y) / length + height * std::abs(along_x) / length + 2;
    std::vector<Box> places;
    const double right = -along_y / length * distance, down = along_x / length * distance;  // a normal of the line
    for (const double part : {0.9, 0.8, 0.95, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1})
      for (const double side : {-1.0, 1.0})
        places.push_back(box_around(guide.label, line->from[0] + part * along_x + side * right,
                                    line->from[1] + part * along_y + side * down));
    put_label(guide.label, places, style_.muted);
  }

  const Chart& chart_;
  const Projection& projection_;
  const ChartStyle& style_;
  Drawing& drawing_;
  LabelSpace space_;
};

}  // namespace

void plot(const Chart& chart, const Projection& projection, const ChartStyle& style, Drawing& drawing) {
  Plotter(chart, projection, style, drawing).draw();
}

void plot_sample(const Series& series, std::array<float, 2> from, float length, const ChartStyle& style,
                 Drawing& drawing) {
  const bool dashed = series.line == LineStyle::Dashed;
  if (series.line != LineStyle::None)
    drawing.shapes.emplace_back(Line{from, {from[0] + length, from[1]}, series.color, style.line(), dashed});
  if (series.markers) drawing.shapes.emplace_back(Disc{{from[0] + length / 2, from[1]}, style.marker(), series.color});
}

}  // namespace brume
