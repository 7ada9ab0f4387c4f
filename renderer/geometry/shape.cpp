#include "renderer/geometry/shape.h"

#include "renderer/geometry/ray_scene.h"
#include "renderer/geometry/sphere_roots.h"

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
      if (o < box_.low[axis] || o > box_.high[axis]) return {};
      continue;
    }
    const double inverse = 1 / d, t0 = (box_.low[axis] - o) * inverse, t1 = (box_.high[axis] - o) * inverse;
    begin = std::max(begin, std::min(t0, t1));
    end = std::min(end, std::max(t0, t1));
  }
  return clipped(begin, end, ray, arena);
}

std::span<const Interval> SphereShape::intervals(const Ray& ray, Arena& arena) const {
  const auto roots = sphere_roots(center_, radius_, ray);
  return roots ? clipped(roots->enter, roots->leave, ray, arena) : std::span<const Interval>{};
}

std::span<const Interval> MeshShape::intervals(const Ray& ray, Arena& arena) const {
  // To the very end, whatever the span: how often the surface winds round the ray's begin is how much oftener the ray
  // comes out than goes in.
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto crossings = mesh_->rays->crossings({ray.origin, ray.direction, {ray.span.begin, kInfinity}}, arena);
  if (crossings.empty()) return {};
  int winding = 0;
  for (const MeshCrossing& c : crossings) winding += c.entering ? -1 : 1;
  // A ray that grazes an edge may be hit there but once, so a begin outside the box is outside.
  const Vec3d begin(ray.at(ray.span.begin));
  if (min(begin, bounds_.low) != bounds_.low || max(begin, bounds_.high) != bounds_.high) winding = 0;

  const auto out = arena.alloc_span<Interval>(crossings.size());
  std::size_t count = 0;
  float from = ray.span.begin;
  for (const MeshCrossing& c : crossings) {
    if (winding > 0)
      if (const Interval part{from, std::min(c.t, ray.span.end)}; !part.empty()) out[count++] = part;
    winding += c.entering ? 1 : -1;
    from = c.t;
  }
  return out.first(count);
}

}  // namespace brume
