// The camera.
#pragma once

#include "renderer/core/ray.h"
#include "renderer/params/node.h"

namespace brume {

/// A pinhole with square pixels. Row 0 of the picture is at the top.
class PinholeCamera {
 public:
  PinholeCamera() = default;
  /// @param vfov_deg  full vertical field of view, in (0, 180).  @param position, look_at in scene space
  PinholeCamera(Vec3 position, Vec3 look_at, Vec3 up, float vfov_deg);

  /// @param film_x, film_y  position on the film in [0,1]: 0,0 is the top left corner.  @param aspect  width / height
  Ray ray(float film_x, float film_y, float aspect) const;

 private:
  Vec3 position_{0, 0, 0};
  Vec3 forward_{0, 1, 0}, right_{1, 0, 0}, up_{0, 0, 1};  // orthonormal
  float tan_half_ = 1;                                    // of the vertical field of view
};

const Family& camera_family();

/// Errors name the key: a camera that looks at itself, or along its own up vector.
Result<PinholeCamera> make_camera(const Node& node, Vec3d scene_origin);

}  // namespace brume
