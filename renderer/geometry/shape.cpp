#include "renderer/geometry/shape.h"

namespace brume {
namespace {

/// Clips to the ray's span in double, where a grazing or far interval still has its length.
std::span<const Interval> clipped(double begin, double end, const Ray& ray, Arena& arena) {
  const Interval part{static_cast<float>(std::max(begin, static_cast<double>(ray.span.begin))),
                      static_cast<float>(std::min(end, static_cast<double>(ray.span.end)))};
  if (part.empty()) return {};
  const auto out = arena.alloc_span<Interval>(1);
  out[0] = part;
  return out;
}

}  // namespace

std::span<const Interval> BoxShape::intervals(const Ray& ray, Arena& arena) const {
  double begin = -std::numeric_limits<double>::infinity(), end = -begin;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    if (d == 0) {
      // Parallel to the slab: 0 * infinity would be NaN, so the slab is a yes or a no.
      if (o < low_[axis] || o > high_[axis]) return {};
      continue;
    }
    const double t0 = (low_[axis] - o) / d, t1 = (high_[axis] - o) / d;
    begin = std::max(begin, std::min(t0, t1));
    end = std::min(end, std::max(t0, t1));
  }
  return clipped(begin, end, ray, arena);
}

std::span<const Interval> SphereShape::intervals(const Ray& ray, Arena& arena) const {
  const Vec3d d(ray.direction), to_center = center_ - Vec3d(ray.origin);
  const double dd = dot(d, d), middle = dot(to_center, d) / dd;
  // Distance of the centre from the line by vector rejection; the textbook discriminant cancels for far spheres.
  const double remaining = radius_ * radius_ - length_squared(to_center - d * middle);
  if (!(remaining > 0)) return {};
  const double half = std::sqrt(remaining / dd);
  return clipped(middle - half, middle + half, ray, arena);
}

}  // namespace brume
