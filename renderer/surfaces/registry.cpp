#include "renderer/surfaces/registry.h"

#include "renderer/geometry/shape_params.h"
#include "renderer/geometry/transform_params.h"

namespace brume {
namespace {

ParamTable surface_table(std::string key, std::string label, std::string doc, std::vector<Param> own,
                         std::vector<Slot> slots) {
  ParamTable table{std::move(key), std::move(label), std::move(doc), {}, std::move(slots)};
  table.params.push_back(param::text("name", "Name").says("Name by which --set and the panels address the surface."));
  table.params.push_back(param::flag("enabled", "On", true).says("Whether the surface is there."));
  for (Param& p : own) table.params.push_back(std::move(p));
  table.slots.push_back({"material", "Material", "What the surface does with light.", &material_family()});
  return table;
}

const ParamTable& plane_table() {
  static const ParamTable table =
      surface_table("plane", "Ground plane", "A plane without end.",
                    {param::point("point", "Point", 0, 0, 0).says("Any point of the plane."),
                     param::vector("normal", "Normal", 0, 0, 1).says("The way its front faces; any length.")},
                    {});
  return table;
}

const ParamTable& sphere_table() {
  static const ParamTable table = surface_table(
      "sphere", "Sphere", "A ball.",
      {param::point("center", "Centre", 0, 0, 0).says("The middle of the sphere."),
       param::number("radius", "Radius", 0.5).more_than(0).log_slider(0.01, 100).in("world units").says("Its radius.")},
      {});
  return table;
}

const ParamTable& mesh_table() {
  static const ParamTable table =
      surface_table("mesh", "Mesh", "Triangles from a file.", {mesh_file_param()},
                    {{"transform", "Transform", "Where the mesh stands.", &transform_family()}});
  return table;
}

Result<std::shared_ptr<const Surface>> make_geometry(const Node& node, Vec3d origin, FileCache<Mesh>& meshes) {
  using Made = std::shared_ptr<const Surface>;
  if (&node.table() == &sphere_table())
    return Made(std::make_shared<SphereSurface>(node.vec3("center") - origin, node.number("radius")));
  if (&node.table() == &plane_table()) {
    const auto normal = direction_of(node, "normal");
    if (!normal) return normal.error();
    return Made(std::make_shared<PlaneSurface>(node.vec3("point") - origin, *normal));
  }
  const auto mesh = load_mesh(node, meshes);
  if (!mesh) return mesh.error();
  const auto placed = world_from_local(node.child("transform"));
  if (!placed) return under("transform", placed.error());
  return Made(std::make_shared<MeshSurface>(*mesh, translation(-origin) * *placed));
}

}  // namespace

const Family& surface_family() {
  static const Family family{"surface", "type", {&plane_table(), &sphere_table(), &mesh_table()}};
  return family;
}

Result<MadeSurface> make_surface(const Node& node, Vec3d scene_origin, FileCache<Mesh>& meshes) {
  auto geometry = make_geometry(node, scene_origin, meshes);
  if (!geometry) return geometry.error();
  const Material material = make_material(node.child("material"));
  if (material.emits() && (*geometry)->endless())
    return bad_input("found emissive on a plane without end, expected diffuse or holdout", {"", 0, 0, "material"});
  return MadeSurface{std::move(*geometry), material};
}

}  // namespace brume
