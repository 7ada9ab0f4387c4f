// A volume as the march sees it: a shader inside bounds, with coefficients that its density multiplies.
#pragma once

#include <memory>

#include "renderer/geometry/shape.h"
#include "renderer/media/shader.h"

namespace brume {

/// Inside the bounds, per world unit:  sigma_s(x) = sigma_s * density(x),  sigma_t(x) = sigma_t * density(x),
/// emission(x) = emission * (the shader's own emission field, or its density).  Outside: nothing.
/// Immutable; any thread.
struct Medium {
  std::shared_ptr<const Shader> shader;
  std::shared_ptr<const Shape> shape;
  Affine shape_from_scene;
  ShaderTraits traits;  ///< what the shader says of itself, asked once
  Color sigma_s, sigma_t;
  Color emission;  ///< W/(sr m^3)

  bool emits() const { return !is_black(emission); }

  /// Where the ray (scene space) is inside, in order of t.
  std::span<const Interval> intervals(const Ray& ray, Arena& arena) const {
    return shape->intervals({shape_from_scene.point(ray.origin), shape_from_scene.vector(ray.direction), ray.span},
                            arena);
  }
};

}  // namespace brume
