#include "renderer/geometry/transform_params.h"

namespace brume {

const Family& transform_family() {
  static const ParamTable table{
      "transform",
      "Transform",
      "From its own space to the world: scaled, then rotated about x, y, z, then moved.",
      {param::vector("translate", "Move", 0, 0, 0).in("world units").slider(-10, 10).says("Shift in world space."),
       param::vector("rotate_deg", "Rotate", 0, 0, 0)
           .slider(-180, 180)
           .in("degrees")
           .says("Turns about x, then y, then z."),
       param::vector("scale", "Scale", 1, 1, 1)
           .slider(0.1, 10)
           .says("Stretch along each axis; negative mirrors, 0 is refused."),
       param::matrix("matrix", "Matrix").says("A 4x4 affine matrix by rows that replaces the three above when given.")},
      {}};
  static const Family family{"transform", "", {&table}};
  return family;
}

Result<Affined> world_from_local(const Node& transform) {
  const auto wrong = [](const char* key, const std::string& message) { return bad_input(message, {"", 0, 0, key}); };
  if (const Numbers& m = transform.numbers("matrix"); !m.empty()) {
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
      return wrong("matrix", "found a last row other than 0, 0, 0, 1, expected an affine matrix by rows");
    Affined affine;
    for (int i = 0; i < 3; ++i) {
      const double* row = &m[static_cast<std::size_t>(4 * i)];
      affine.row[i] = {row[0], row[1], row[2]};
      affine.offset[i] = row[3];
    }
    if (!inverse(affine)) return wrong("matrix", "found a matrix that flattens space, expected an invertible one");
    return affine;
  }
  const Affined affine = translation(transform.vec3("translate")) * rotation_deg(transform.vec3("rotate_deg")) *
                         scaling(transform.vec3("scale"));
  if (!inverse(affine))
    return wrong("scale", "found " + format_value(transform.value("scale")) + ", expected no component to be 0");
  return affine;
}

Result<Vec3d> direction_of(const Node& node, const char* key) {
  const Vec3d d = node.vec3(key);
  if (!(length(d) > 0)) return bad_input("found [0, 0, 0], expected a direction", {"", 0, 0, key});
  return normalize(d);
}

}  // namespace brume
