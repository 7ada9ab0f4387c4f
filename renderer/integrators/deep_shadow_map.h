// Transmittance towards a light, tabulated.
#pragma once

#include <memory>
#include <vector>

#include "renderer/scene/scene.h"

namespace brume {

/// Optical depth from a light to points in the scene: for a grid of rays from the light (over all directions for a
/// point or spot light, over a plane for parallel light), at equal distances along each. In between it is interpolated
/// linearly. Lokovic & Veach 2000, "Deep Shadow Maps", without their compression. Immutable; any thread.
class DeepShadowMap {
 public:
  /// Null for a light that cannot be projected: one with a surface, an environment, a sun with a size.
  static std::unique_ptr<const DeepShadowMap> make(const Scene& scene, const Light& light);

  /// From the light to x, per channel.
  Color transmittance(Vec3 x) const;

  /// Processor time that making it took.
  double cpu_seconds() const { return cpu_seconds_; }

 private:
  DeepShadowMap(const Scene& scene, const LightPoint& point, int resolution);

  /// Where x lies in the map: column and row in [0, resolution), distance along its ray in world units.
  struct Place {
    float u, v, distance;
  };
  Place place_of(Vec3 x) const;
  Ray ray_of(float u, float v) const;

  LightPoint point_;
  Frame frame_;   // of parallel light: n is towards the light
  Vec3 center_;   // of the scene's bounds
  float radius_;  // of a sphere round them
  int resolution_;
  float near_, far_;        // range of distances
  std::vector<Color> tau_;  // [row][column][knot]
  double cpu_seconds_ = 0;
};

}  // namespace brume
