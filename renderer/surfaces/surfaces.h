// All surfaces of a scene, as rays meet them.
#pragma once

#include <vector>

#include "renderer/geometry/ray_scene.h"
#include "renderer/surfaces/registry.h"

namespace brume {

/// Where a ray ends.
struct SurfaceHit {
  float t;        ///< world units
  Vec3 position;  ///< so far on the near side that rays which begin here do not meet the surface again
  Vec3 normal;    ///< unit, towards where the ray comes from
  Color albedo;   ///< of the diffuse reflection
  Color emitted;  ///< towards the ray's origin, W/(sr m^2)
};

/// Immutable; any thread. Made only when there is a surface: only then Embree is started.
class Surfaces {
 public:
  /// @param surfaces  at least one.  Errors: Embree out of memory.
  static Result<std::unique_ptr<const Surfaces>> make(const std::vector<MadeSurface>& surfaces);

  /// The nearest hit inside ray.span.
  std::optional<SurfaceHit> intersect(const Ray& ray) const;
  /// Whether anything stands in the way inside ray.span.
  bool occluded(const Ray& ray) const { return rays_->occluded(ray); }

 private:
  std::shared_ptr<const RayScene> rays_;
  std::vector<Material> materials_;
};

}  // namespace brume
