#include "renderer/lights/registry.h"

#include "renderer/core/check.h"
#include "renderer/lights/constant_environment.h"
#include "renderer/lights/directional_light.h"
#include "renderer/lights/point_light.h"
#include "renderer/lights/quad_light.h"

namespace brume {
namespace {

using LightResult = Result<std::unique_ptr<Light>>;

/// What every light has, before what makes it special.
ParamTable light_table(std::string key, std::string label, std::string doc, bool visible, std::vector<Param> own) {
  ParamTable table{std::move(key), std::move(label), std::move(doc), {}, {}};
  table.params.push_back(param::text("name", "Name").says("Name by which --set and the panels address the light."));
  table.params.push_back(param::flag("enabled", "On", true).says("Whether the light shines."));
  for (Param& p : own) table.params.push_back(std::move(p));
  table.params.push_back(param::flag("visible_to_camera", "Visible to camera", visible)
                             .says("Whether the camera sees the light itself; the scene is lit by it either way."));
  return table;
}

const ParamTable& point_table() {
  static const ParamTable table = light_table(
      "point", "Point light", "Shines from one point equally in all directions.", false,
      {param::point("position", "Position", 0, 0, 2).says("Where the light is."),
       param::color("intensity", "Intensity", 10, 10, 10).slider(0, 100).in("W/sr").says("Radiant intensity.")});
  return table;
}

const ParamTable& quad_table() {
  static const ParamTable table = light_table(
      "quad", "Quad light", "A glowing parallelogram that shines along cross(edge_u, edge_v).", false,
      {param::point("corner", "Corner", -0.5, -0.5, 3).says("One corner."),
       param::vector("edge_u", "Edge u", 0, 1, 0).in("world units").says("From the corner along one side."),
       param::vector("edge_v", "Edge v", 1, 0, 0).in("world units").says("From the corner along the other side."),
       param::color("radiance", "Radiance", 4, 4, 4).slider(0, 50).in("W/(sr m^2)").says("Radiance of the lit side."),
       param::flag("two_sided", "Two-sided", false).says("Whether the other side shines too.")});
  return table;
}

const ParamTable& directional_table() {
  static const ParamTable table =
      light_table("directional", "Directional light", "Parallel light from infinitely far away, like the sun.", false,
                  {param::vector("direction", "Direction", 0.5, 0.5, -1).says("The way the light travels; any length."),
                   param::color("irradiance", "Irradiance", 3, 3, 3)
                       .slider(0, 20)
                       .in("W/m^2")
                       .says("On a plane facing the light.")});
  // A direction is no place to see: the camera never meets this light.
  return table;
}

const ParamTable& environment_table() {
  static const ParamTable table =
      light_table("environment", "Environment", "The same light from every direction; seen as the background.", true,
                  {param::color("radiance", "Radiance", 0.2, 0.2, 0.2)
                       .slider(0, 2)
                       .in("W/(sr m^2)")
                       .says("Radiance of the surroundings.")});
  return table;
}

Vec3 placed(const Node& n, std::string_view key, Vec3d origin) { return Vec3(n.vec3(key) - origin); }

LightResult make_point(const Node& n, Vec3d origin) {
  return std::unique_ptr<Light>(std::make_unique<PointLight>(placed(n, "position", origin), n.color("intensity")));
}

LightResult make_quad(const Node& n, Vec3d origin) {
  const Vec3d u = n.vec3("edge_u"), v = n.vec3("edge_v");
  if (!(length(cross(u, v)) > 0))
    return bad_input("found two parallel or zero edges, expected edges that span an area", {"", 0, 0, "edge_v"});
  return std::unique_ptr<Light>(std::make_unique<QuadLight>(placed(n, "corner", origin), Vec3(u), Vec3(v),
                                                            n.color("radiance"), n.flag("two_sided")));
}

LightResult make_directional(const Node& n, Vec3d) {
  const Vec3d d = n.vec3("direction");
  if (!(length(d) > 0)) return bad_input("found [0, 0, 0], expected a direction", {"", 0, 0, "direction"});
  return std::unique_ptr<Light>(std::make_unique<DirectionalLight>(Vec3(normalize(d)), n.color("irradiance")));
}

LightResult make_environment(const Node& n, Vec3d) {
  return std::unique_ptr<Light>(std::make_unique<ConstantEnvironment>(n.color("radiance")));
}

}  // namespace

const std::vector<LightType>& light_types() {
  static const std::vector<LightType> types{{&point_table(), make_point},
                                            {&quad_table(), make_quad},
                                            {&directional_table(), make_directional},
                                            {&environment_table(), make_environment}};
  return types;
}

const Family& light_family() {
  static const Family family = [] {
    Family f{"light", "type", {}};
    for (const LightType& t : light_types()) f.tables.push_back(t.table);
    return f;
  }();
  return family;
}

Result<std::unique_ptr<const Light>> make_light(const Node& node, Vec3d scene_origin) {
  for (const LightType& t : light_types()) {
    if (t.table != &node.table()) continue;
    LightResult light = t.make(node, scene_origin);
    if (!light) return light.error();
    (*light)->visible_to_camera = node.flag("visible_to_camera");
    return std::unique_ptr<const Light>(std::move(*light));
  }
  BRUME_CHECK(node.kind(), ==, "a light");
  return std::unique_ptr<const Light>();
}

}  // namespace brume
