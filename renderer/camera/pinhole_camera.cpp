#include "renderer/camera/pinhole_camera.h"

namespace brume {

PinholeCamera::PinholeCamera(Vec3 position, Vec3 look_at, Vec3 up, float vfov_deg)
    : position_(position),
      forward_(normalize(look_at - position)),
      right_(normalize(cross(forward_, up))),
      up_(cross(right_, forward_)),
      tan_half_(std::tan(vfov_deg * (kPi / 360))) {}

Ray PinholeCamera::ray(float film_x, float film_y, float aspect) const {
  const float x = (2 * film_x - 1) * aspect * tan_half_, y = (1 - 2 * film_y) * tan_half_;
  return {position_, normalize(forward_ + right_ * x + up_ * y)};
}

namespace {

const ParamTable& camera_table() {
  static const ParamTable table{
      "camera",
      "Camera",
      "A pinhole camera.",
      {param::point("position", "Position", 0, -5, 1).says("Where the camera is."),
       param::point("look_at", "Look at", 0, 0, 0).says("The point in the middle of the picture."),
       param::vector("up", "Up", 0, 0, 1).says("The way that is up in the picture."),
       param::number("vfov_deg", "Field of view", 35)
           .between(0.1, 179)
           .slider(5, 120)
           .in("degrees")
           .says("Vertical angle of view.")},
      {}};
  return table;
}

}  // namespace

const Family& camera_family() {
  static const Family family{"camera", "", {&camera_table()}};
  return family;
}

Result<PinholeCamera> make_camera(const Node& node, Vec3d scene_origin) {
  const Vec3d position = node.vec3("position") - scene_origin, look_at = node.vec3("look_at") - scene_origin;
  const Vec3d forward = look_at - position, up = node.vec3("up");
  if (!(length(forward) > 0))
    return bad_input("found the camera's own position, expected a point away from it", {"", 0, 0, "look_at"});
  if (!(length(cross(forward, up)) > 1e-6 * length(forward) * length(up)))
    return bad_input("found " + format_value(node.value("up")) + ", expected a vector not along the line of sight",
                     {"", 0, 0, "up"});
  return PinholeCamera(Vec3(position), Vec3(position + normalize(forward)), Vec3(normalize(up)),
                       static_cast<float>(node.number("vfov_deg")));
}

}  // namespace brume
