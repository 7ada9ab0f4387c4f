#include "renderer/media/majorants.h"

#include <algorithm>

namespace brume {
namespace {

float max_emission_floor(std::span<const Medium> media, double diagonal) {
  const bool glows = std::any_of(media.begin(), media.end(), [](const Medium& m) { return m.emits(); });
  return glows ? static_cast<float>(4 / diagonal) : 0;
}

}  // namespace

Majorants::Majorants(std::span<const Medium> media, const Bounds3& bounds, int cells) {
  if (bounds.empty()) return;
  // A little larger than the media: rounding must not put a point of theirs outside.
  const Vec3d margin(1e-5 * (bounds.diagonal() + length(bounds.center())));
  const Bounds3 box{bounds.low - margin, bounds.high + margin};
  const Vec3d extent = box.extent();
  const double longest = std::max({extent.x, extent.y, extent.z});
  for (int k = 0; k < 3; ++k) {
    extent_[k] = std::clamp(static_cast<int>(std::ceil(cells * extent[k] / longest)), 1, cells);
    cell_size_[k] = static_cast<float>(extent[k] / extent_[k]);
  }
  low_ = Vec3(box.low);
  values_.resize(static_cast<std::size_t>(extent_[0]) * static_cast<std::size_t>(extent_[1]) *
                 static_cast<std::size_t>(extent_[2]));
  const float floor = max_emission_floor(media, bounds.diagonal());
  const Vec3d size(cell_size_), slack = margin;
  for (int x = 0; x < extent_[0]; ++x)
    for (int y = 0; y < extent_[1]; ++y)
      for (int z = 0; z < extent_[2]; ++z) {
        const Vec3d low = box.low + Vec3d(size.x * x, size.y * y, size.z * z);
        const Bounds3 part{low - slack, low + size + slack};
        Color sum;
        for (const Medium& m : media)
          if (!is_black(m.sigma_t)) sum += m.sigma_t * m.shader->max_density(part);
        for (int c = 0; c < 3; ++c) cell(x, y, z)[c] = std::max(sum[c], floor) * 1.00001f;
      }
}

Color& Majorants::cell(int x, int y, int z) {
  return values_[static_cast<std::size_t>((x * extent_[1] + y) * extent_[2] + z)];
}

std::span<const MajorantStretch> Majorants::along(const Ray& ray, Arena& arena) const {
  if (values_.empty()) return {};
  // Amanatides & Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing".
  double begin = static_cast<double>(ray.span.begin), end = static_cast<double>(ray.span.end);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  double next[3], step_t[3];
  int step[3], place[3];
  for (int k = 0; k < 3; ++k) {
    const double o = static_cast<double>(ray.origin[k]), d = static_cast<double>(ray.direction[k]);
    const double low = static_cast<double>(low_[k]), size = static_cast<double>(cell_size_[k]);
    const double high = low + size * extent_[k];
    if (d == 0) {
      if (o < low || o > high) return {};
      continue;
    }
    begin = std::max(begin, std::min((low - o) / d, (high - o) / d));
    end = std::min(end, std::max((low - o) / d, (high - o) / d));
  }
  if (!(begin < end)) return {};
  for (int k = 0; k < 3; ++k) {
    const double o = static_cast<double>(ray.origin[k]), d = static_cast<double>(ray.direction[k]);
    const double low = static_cast<double>(low_[k]), size = static_cast<double>(cell_size_[k]);
    place[k] = std::clamp(static_cast<int>(std::floor((o + begin * d - low) / size)), 0, extent_[k] - 1);
    step[k] = d > 0 ? 1 : d < 0 ? -1 : 0;
    next[k] = d == 0 ? kNever : (low + size * (place[k] + (d > 0 ? 1 : 0)) - o) / d;
    step_t[k] = d == 0 ? kNever : size / std::abs(d);
  }
  const auto most = static_cast<std::size_t>(extent_[0] + extent_[1] + extent_[2] + 1);
  const auto stretches = arena.alloc_span<MajorantStretch>(most);
  std::size_t n = 0;
  double at = begin;
  while (at < end && n < most) {
    const int k = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    const double leave = std::min(next[k], end);
    const Color value = values_[static_cast<std::size_t>((place[0] * extent_[1] + place[1]) * extent_[2] + place[2])];
    const Interval span{static_cast<float>(at), static_cast<float>(leave)};
    if (!span.empty()) {
      if (n > 0 && stretches[n - 1].majorant == value)
        stretches[n - 1].span.end = span.end;
      else
        stretches[n++] = {span, value};
    }
    at = std::max(at, leave);
    if (leave >= end) break;
    place[k] += step[k];
    if (place[k] < 0 || place[k] >= extent_[k]) break;
    next[k] += step_t[k];
  }
  return stretches.first(n);
}

}  // namespace brume
