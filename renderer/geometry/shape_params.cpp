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

const ParamTable& mesh_table() {
  static const ParamTable table{
      "mesh", "Mesh", "The inside of a closed mesh, before the volume's transform.", {mesh_file_param()}, {}};
  return table;
}

}  // namespace

Param mesh_file_param() {
  return param::file("file", "Mesh").must_be_given().says("A Wavefront (.obj) or Stanford (.ply) file.");
}

Result<std::shared_ptr<const Mesh>> load_mesh(const Node& node, FileCache<Mesh>& meshes) {
  const std::string& file = node.text("file");
  if (file.empty()) return bad_input("found no file name, expected a mesh in .obj or .ply", {"", 0, 0, "file"});
  auto mesh = meshes.load(file, Mesh::read);
  if (!mesh) return under("file", mesh.error());
  return mesh;
}

const Family& shape_family() {
  static const Family family{"shape", "type", {&box_table(), &sphere_table(), &mesh_table()}};
  return family;
}

Result<std::shared_ptr<const Shape>> make_shape(const Node& node, FileCache<Mesh>& meshes) {
  using Made = std::shared_ptr<const Shape>;
  if (&node.table() == &sphere_table())
    return Made(std::make_shared<SphereShape>(node.vec3("center"), node.number("radius")));
  if (&node.table() == &mesh_table()) {
    const auto mesh = load_mesh(node, meshes);
    if (!mesh) return mesh.error();
    if (const std::size_t open = (*mesh)->open_edges; open > 0)
      return bad_input("found " + std::to_string(open) + " open edges in " + node.text("file") +
                           ", expected a closed mesh, which has an inside",
                       {"", 0, 0, "file"});
    return Made(std::make_shared<MeshShape>(*mesh));
  }
  const Vec3d low = node.vec3("min"), high = node.vec3("max");
  if (!(low.x < high.x && low.y < high.y && low.z < high.z))
    return bad_input("found max " + format_value(node.value("max")) + ", expected every component above min " +
                         format_value(node.value("min")),
                     {"", 0, 0, "max"});
  return Made(std::make_shared<BoxShape>(low, high));
}

}  // namespace brume
