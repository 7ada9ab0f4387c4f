#include "app/panels/chart_view.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "app/ui/widgets.h"
#include "renderer/analysis/chart_ticks.h"

namespace brume {
namespace {

// ImGui's size of a font is the height of a line, which is so many em in Roboto (1900 + 500 of 2048 units); other sans
// serif fonts differ by a few percent.
constexpr float kLineHeight = 1.172f;

// Of the window's font, so that ticks and legend, 0.93 em of the chart, have exactly its size: ImGui scales the letters
// of any other size from a picture, and they blur.
constexpr float kChartFont = 1 / (0.93f * kLineHeight);

ImU32 packed(Rgb color) { return IM_COL32(color[0], color[1], color[2], 255); }

/// Puts shapes on an ImGui canvas.
class Painter {
 public:
  Painter(ImDrawList& list, ImVec2 origin) : list_(list), origin_(origin) {}

  void operator()(const Line& line) {
    const std::array<float, 2> ends[] = {line.from, line.to};
    stroke(ends, line.color, line.width, line.dashed);
  }
  void operator()(const Polyline& line) { stroke(line.points, line.color, line.width, line.dashed); }
  void operator()(const Rect& rect) { list_.AddRectFilled(at(rect.min), at(rect.max), packed(rect.color)); }
  void operator()(const Disc& disc) {
    if (disc.ring > 0)
      list_.AddCircle(at(disc.center), disc.radius, packed(disc.color), 0, disc.ring);
    else
      list_.AddCircleFilled(at(disc.center), disc.radius, packed(disc.color));
  }
  void operator()(const Text& text) {
    const ImFont& font = *ImGui::GetFont();
    const char *begin = text.text.data(), *end = begin + text.text.size();
    const float size = std::round(text.size * kLineHeight);
    const float width = font.CalcTextSizeA(size, FLT_MAX, 0, begin, end).x;
    const float before = text.anchor == TextAnchor::Start ? 0 : text.anchor == TextAnchor::Middle ? width / 2 : width;
    const float above = font.Ascent * size / font.FontSize;
    // Whole pixels, or the letters blur. Where the text begins, at the height of its top.
    const ImVec2 base = at(text.position);
    const ImVec2 corner = text.rotated ? ImVec2(std::round(base.x - above), std::round(base.y + before))
                                       : ImVec2(std::round(base.x - before), std::round(base.y - above));
    const int first = list_.VtxBuffer.Size;
    // AddText leaves out letters beyond the clip rectangle, where those of a rotated text lie before they are turned.
    const ImVec4 everywhere(-FLT_MAX, -FLT_MAX, FLT_MAX, FLT_MAX);
    font.RenderText(&list_, size, corner, packed(text.color), everywhere, begin, end);
    if (!text.rotated) return;
    for (int i = first; i < list_.VtxBuffer.Size; ++i) {
      ImVec2& p = list_.VtxBuffer[i].pos;
      p = {corner.x + (p.y - corner.y), corner.y - (p.x - corner.x)};
    }
  }

 private:
  ImVec2 at(std::array<float, 2> pixel) const { return {origin_.x + pixel[0], origin_.y + pixel[1]}; }

  void stroke(std::span<const std::array<float, 2>> points, Rgb color, float width, bool dashed) {
    if (points.size() < 2 || !(width > 0)) return;
    path_.clear();
    for (const std::array<float, 2>& point : points) path_.push_back(at(point));
    if (dashed)
      draw_dashes(color, width);
    else
      draw_path(color, width);
  }

  /// In pieces that share an end: one call takes no more than 65536 vertices.
  void draw_path(Rgb color, float width) {
    constexpr std::size_t kPiece = 4096;
    for (std::size_t first = 0; first + 1 < path_.size(); first += kPiece - 1) {
      const std::size_t count = std::min(kPiece, path_.size() - first);
      list_.AddPolyline(path_.data() + first, static_cast<int>(count), packed(color), ImDrawFlags_None, width);
    }
  }

  void draw_dashes(Rgb color, float width) {
    const std::vector<ImVec2> corners = path_;
    const float stroke_length = kDashStroke * width, gap_length = kDashGap * width;
    bool pen_down = true;
    float left = stroke_length;  // of the stroke or gap
    path_.assign(1, corners.front());
    for (std::size_t i = 1; i < corners.size(); ++i) {
      ImVec2 from = corners[i - 1];
      const ImVec2 to = corners[i];
      for (float distance = std::hypot(to.x - from.x, to.y - from.y); distance > left;) {
        from = {from.x + (to.x - from.x) * left / distance, from.y + (to.y - from.y) * left / distance};
        distance -= left;
        if (pen_down) {
          path_.push_back(from);
          draw_path(color, width);
        }
        pen_down = !pen_down;
        left = pen_down ? stroke_length : gap_length;
        path_.assign(1, from);
      }
      left -= std::hypot(to.x - from.x, to.y - from.y);
      if (pen_down) path_.push_back(to);
    }
    if (pen_down) draw_path(color, width);
  }

  ImDrawList& list_;
  ImVec2 origin_;
  std::vector<ImVec2> path_;
};

std::string point_text(const Chart& chart, const NearestPoint& nearest) {
  const Series& series = chart.series[nearest.series];
  const auto value = [](const Axis& axis, const char* name, double v) {
    return (axis.label.empty() ? name : axis.label) + ": " + value_text(axis, v);
  };
  const std::array<double, 2>& point = series.points[nearest.point];
  return (series.name.empty() ? "" : series.name + "\n") + value(chart.x, "x", point[0]) + "\n" +
         value(chart.y, "y", point[1]);
}

}  // namespace

void draw_chart(const Drawing& drawing, ImDrawList& list, ImVec2 origin) {
  Painter painter(list, origin);
  painter(Rect{{0, 0}, {drawing.width, drawing.height}, drawing.background});
  for (const Drawing::Shape& shape : drawing.shapes) std::visit(painter, shape);
}

void chart_view(const char* label, const Chart& chart, ImVec2 size) {
  const float em = ImGui::GetFontSize();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 origin(std::floor(corner.x), std::floor(corner.y)), area(std::max(1.0f, size.x), std::max(1.0f, size.y));
  const ChartLayout layout =
      lay_out(chart, {.width = area.x, .height = area.y, .font = kChartFont * em, .ground = Ground::Dark});
  ImGui::InvisibleButton(label, area);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  draw_chart(layout.drawing, list, origin);
  ui::record_item(label);

  const ImVec2 mouse = ImGui::GetIO().MousePos;
  std::optional<NearestPoint> nearest;
  if (ImGui::IsItemHovered())
    nearest = nearest_point(chart, layout.projection, {mouse.x - origin.x, mouse.y - origin.y}, 1.5f * em);
  if (!nearest) return;
  const Series& series = chart.series[nearest->series];
  const std::array<float, 2> at = layout.projection.to_pixels(series.points[nearest->point]);
  Painter(list, origin)(Disc{at, 0.45f * em, series.color, std::max(1.0f, 0.1f * em)});
  ui::tooltip_on_hover(point_text(chart, *nearest));
}

}  // namespace brume
