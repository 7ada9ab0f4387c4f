// Where a line meets a sphere.
#pragma once

#include <optional>

#include "renderer/core/ray.h"

namespace brume {

struct SphereRoots {
  double enter, leave;  ///< along the ray, in lengths of its direction; enter < leave
};

/// Both roots, wherever they lie with regard to the ray's span. In double and from the distance of the centre from the
/// line by vector rejection: the textbook discriminant cancels for spheres that are small or far.
inline std::optional<SphereRoots> sphere_roots(Vec3d center, double radius, const Ray& ray) {
  const Vec3d d(ray.direction), to_center = center - Vec3d(ray.origin);
  const double dd = dot(d, d), middle = dot(to_center, d) / dd;
  const double remaining = radius * radius - length_squared(to_center - d * middle);
  if (!(remaining > 0)) return std::nullopt;
  const double half = std::sqrt(remaining / dd);
  return SphereRoots{middle - half, middle + half};
}

}  // namespace brume
