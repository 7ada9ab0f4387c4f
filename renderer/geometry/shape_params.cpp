#include "renderer/geometry/shape_params.h"

namespace brume {
namespace {

const ParamTable& box_table() {
  static const ParamTable table{
      "box",
      "Box",
      "An axis-aligned box, before the volume's transform.",
      {param::point("min", "Low corner", -1, -1, -1).says("Corner with the smallest coordinates."),
       param::point("max", "High corner", 1, 1, 1).says("Corner with the largest coordinates.")},
      {}};
  return table;
}

const ParamTable& sphere_table() {
  static const ParamTable table{
      "sphere",
      "Sphere",
      "A ball, before the volume's transform.",
      {param::point("center", "Centre", 0, 0, 0).says("Centre of the ball."), param::number("radius", "Radius", 1)
                                                                                  .more_than(0)
                                                                                  .log_slider(0.01, 100)
                                                                                  .in("world units")
                                                                                  .says("Radius of the ball.")},
      {}};
  return table;
}

}  // namespace

const Family& shape_family() {
  static const Family family{"shape", "type", {&box_table(), &sphere_table()}};
  return family;
}

Result<std::unique_ptr<const Shape>> make_shape(const Node& node) {
  if (&node.table() == &sphere_table())
    return std::unique_ptr<const Shape>(std::make_unique<SphereShape>(node.vec3("center"), node.number("radius")));
  const Vec3d low = node.vec3("min"), high = node.vec3("max");
  if (!(low.x < high.x && low.y < high.y && low.z < high.z))
    return bad_input("found max " + format_value(node.value("max")) + ", expected every component above min " +
                         format_value(node.value("min")),
                     {"", 0, 0, "max"});
  return std::unique_ptr<const Shape>(std::make_unique<BoxShape>(low, high));
}

}  // namespace brume
