#include "renderer/analysis/chart_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/analysis/chart_ticks.h"

namespace brume {
namespace {

std::array<double, 2> widened(std::array<float, 2> pixel) {
  return {static_cast<double>(pixel[0]), static_cast<double>(pixel[1])};
}
std::array<float, 2> narrowed(std::array<double, 2> pixel) {
  return {static_cast<float>(pixel[0]), static_cast<float>(pixel[1])};
}

/// M4 for every run of points in one column of pixels.
PixelLine thinned(const PixelLine& line) {
  PixelLine result;
  const auto column = [&](std::size_t i) { return std::floor(line[i][0]); };
  for (std::size_t first = 0, end = 0; first < line.size(); first = end) {
    end = first + 1;
    while (end < line.size() && column(end) == column(first)) ++end;
    std::size_t low = first, high = first;
    for (std::size_t i = first; i < end; ++i) {
      if (line[i][1] < line[low][1]) low = i;
      if (line[i][1] > line[high][1]) high = i;
    }
    std::array<std::size_t, 4> kept{first, std::min(low, high), std::max(low, high), end - 1};
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (i == 0 || kept[i] != kept[i - 1]) result.push_back(line[kept[i]]);
  }
  return result;
}

}  // namespace

std::optional<Segment> clipped(const Segment& segment, std::array<double, 2> min, std::array<double, 2> max) {
  double enter = 0, leave = 1;
  std::array<double, 2> along{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double from = segment.from[axis];
    along[axis] = segment.to[axis] - from;
    if (!std::isfinite(from) || !std::isfinite(along[axis])) return std::nullopt;
    if (along[axis] == 0) {
      if (from < min[axis] || from > max[axis]) return std::nullopt;
      continue;
    }
    double near = (min[axis] - from) / along[axis], far = (max[axis] - from) / along[axis];
    if (near > far) std::swap(near, far);
    enter = std::max(enter, near);
    leave = std::min(leave, far);
  }
  if (enter > leave) return std::nullopt;
  Segment inside = segment;
  // Ends that need no cut keep their exact place, so neighbours still meet.
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (leave < 1) inside.to[axis] = segment.from[axis] + leave * along[axis];
    if (enter > 0) inside.from[axis] = segment.from[axis] + enter * along[axis];
  }
  return inside;
}

std::array<double, 2> to_far_pixels(const Projection& projection, std::array<double, 2> point) {
  std::array<double, 2> fraction{};
  for (std::size_t i = 0; i < 2; ++i)
    fraction[i] = AxisRange{projection.low[i], projection.high[i], projection.logarithmic[i]}.fraction(point[i]);
  const std::array<double, 2> min = widened(projection.min), max = widened(projection.max);
  return {min[0] + fraction[0] * (max[0] - min[0]), max[1] - fraction[1] * (max[1] - min[1])};
}

std::vector<PixelLine> lines_in_frame(std::span<const std::array<double, 2>> points, const Projection& projection) {
  std::vector<PixelLine> pieces;
  PixelLine piece;
  const auto finish = [&] {
    if (piece.size() >= 2) pieces.push_back(thinned(piece));
    piece.clear();
  };
  std::optional<std::array<double, 2>> previous;
  for (const std::array<double, 2>& point : points) {
    if (!projection.has_place(point)) {
      finish();
      previous.reset();
      continue;
    }
    const std::array<double, 2> pixel = to_far_pixels(projection, point);
    if (previous) {
      const auto inside = clipped({*previous, pixel}, widened(projection.min), widened(projection.max));
      if (!inside || inside->from != *previous) finish();
      if (inside) {
        if (piece.empty()) piece.push_back(narrowed(inside->from));
        piece.push_back(narrowed(inside->to));
      }
    }
    previous = pixel;
  }
  finish();
  return pieces;
}

}  // namespace brume
