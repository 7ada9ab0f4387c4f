#include "renderer/lights/registry.h"

#include "renderer/core/check.h"
#include "renderer/geometry/shape_params.h"
#include "renderer/geometry/transform_params.h"
#include "renderer/lights/constant_environment.h"
#include "renderer/lights/directional_light.h"
#include "renderer/lights/disc_light.h"
#include "renderer/lights/image_environment.h"
#include "renderer/lights/point_light.h"
#include "renderer/lights/quad_light.h"
#include "renderer/lights/sphere_light.h"
#include "renderer/lights/spot_light.h"

namespace brume {
namespace {

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

const ParamTable& spot_table() {
  static const ParamTable table = light_table(
      "spot", "Spot light", "Shines from one point into a cone, with a soft edge.", false,
      {param::point("position", "Position", 0, 0, 3).says("Where the light is."),
       param::vector("direction", "Direction", 0, 0, -1).says("The axis of the cone; any length."),
       param::number("cone_deg", "Cone", 30)
           .between(0.05, 90)
           .in("degrees")
           .says("Angle between the axis and the edge of the cone."),
       param::number("blend", "Blend", 0.3).between(0, 1).says("Share of the cone over which the light falls to 0."),
       param::color("intensity", "Intensity", 40, 40, 40)
           .slider(0, 400)
           .in("W/sr")
           .says("Radiant intensity along the axis.")});
  return table;
}

Param radiance_param(double value) {
  return param::color("radiance", "Radiance", value, value, value)
      .slider(0, 50)
      .in("W/(sr m^2)")
      .says("Radiance of the lit side.");
}

const ParamTable& disc_table() {
  static const ParamTable table = light_table(
      "disc", "Disc light", "A glowing flat disc that shines along its normal.", false,
      {param::point("center", "Centre", 0, 0, 3).says("The middle of the disc."),
       param::vector("normal", "Normal", 0, 0, -1).says("The way the lit side faces; any length."),
       param::number("radius", "Radius", 0.5).more_than(0).slider(0.01, 5).in("world units").says("Of the disc."),
       radiance_param(4), param::flag("two_sided", "Two-sided", false).says("Whether the other side shines too.")});
  return table;
}

const ParamTable& sphere_table() {
  static const ParamTable table = light_table(
      "sphere", "Sphere light", "A glowing ball that shines outwards.", false,
      {param::point("center", "Centre", 0, 0, 3).says("The middle of the sphere."),
       param::number("radius", "Radius", 0.3).more_than(0).slider(0.01, 5).in("world units").says("Of the sphere."),
       radiance_param(10)});
  return table;
}

const ParamTable& mesh_table() {
  static const ParamTable table = [] {
    ParamTable t =
        light_table("mesh", "Mesh light",
                    "A glowing mesh that shines from the front of its triangles, outwards where it is closed.", false,
                    {mesh_file_param(), radiance_param(4),
                     param::flag("two_sided", "Two-sided", false).says("Whether the back shines too.")});
    t.slots.push_back({"transform", "Transform", "Where the mesh stands.", &transform_family()});
    return t;
  }();
  return table;
}

const ParamTable& quad_table() {
  static const ParamTable table = light_table(
      "quad", "Quad light", "A glowing parallelogram that shines along cross(edge_u, edge_v).", false,
      {param::point("corner", "Corner", -0.5, -0.5, 3).says("One corner."),
       param::vector("edge_u", "Edge u", 0, 1, 0).in("world units").says("From the corner along one side."),
       param::vector("edge_v", "Edge v", 1, 0, 0).in("world units").says("From the corner along the other side."),
       radiance_param(4), param::flag("two_sided", "Two-sided", false).says("Whether the other side shines too.")});
  return table;
}

const ParamTable& directional_table() {
  static const ParamTable table =
      light_table("directional", "Directional light", "Light from infinitely far away, like the sun.", false,
                  {param::vector("direction", "Direction", 0.5, 0.5, -1).says("The way the light travels; any length."),
                   param::number("angular_diameter_deg", "Angular diameter", 0)
                       .between(0, 180)
                       .slider(0, 10)
                       .in("degrees")
                       .says("How large the light looks: 0 is parallel light, the sun has 0.53; only a light with a "
                             "size can be seen."),
                   param::color("irradiance", "Irradiance", 3, 3, 3)
                       .slider(0, 20)
                       .in("W/m^2")
                       .says("On a plane facing the light.")});
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

const ParamTable& image_environment_table() {
  static const ParamTable table = light_table(
      "image_environment", "Picture environment", "Light from a picture of all the surroundings.", true,
      {param::file("file", "Picture")
           .must_be_given()
           .says("An equirectangular picture (.exr or .hdr): its middle is seen along +x, its upper edge is +z."),
       param::color("radiance", "Radiance", 1, 1, 1)
           .slider(0, 5)
           .in("W/(sr m^2)")
           .says("Radiance where the picture is 1."),
       param::number("rotate_deg", "Rotate", 0).slider(-180, 180).in("degrees").says("Turn about the z axis.")});
  return table;
}

Vec3 placed(const Node& n, std::string_view key, Vec3d origin) { return Vec3(n.vec3(key) - origin); }

float number(const Node& n, const char* key) { return static_cast<float>(n.number(key)); }

constexpr float kRadians = kPi / 180;

template <class Kind, class... Args> Result<MadeLight> made(Args&&... args) {
  return MadeLight{std::make_unique<Kind>(std::forward<Args>(args)...)};
}

Result<MadeLight> make_point(const Node& n, const LightContext& c) {
  return made<PointLight>(placed(n, "position", c.scene_origin), n.color("intensity"));
}

Result<MadeLight> make_spot(const Node& n, const LightContext& c) {
  const auto axis = direction_of(n, "direction");
  if (!axis) return axis.error();
  return made<SpotLight>(placed(n, "position", c.scene_origin), Vec3(*axis), number(n, "cone_deg") * kRadians,
                         number(n, "blend"), n.color("intensity"));
}

Result<MadeLight> make_quad(const Node& n, const LightContext& c) {
  const Vec3d u = n.vec3("edge_u"), v = n.vec3("edge_v");
  if (!(length(cross(u, v)) > 0))
    return bad_input("found two parallel or zero edges, expected edges that span an area", {"", 0, 0, "edge_v"});
  return made<QuadLight>(placed(n, "corner", c.scene_origin), Vec3(u), Vec3(v), n.color("radiance"),
                         n.flag("two_sided"));
}

Result<MadeLight> make_disc(const Node& n, const LightContext& c) {
  const auto normal = direction_of(n, "normal");
  if (!normal) return normal.error();
  return made<DiscLight>(placed(n, "center", c.scene_origin), Vec3(*normal), number(n, "radius"), n.color("radiance"),
                         n.flag("two_sided"));
}

Result<MadeLight> make_sphere(const Node& n, const LightContext& c) {
  return made<SphereLight>(placed(n, "center", c.scene_origin), number(n, "radius"), n.color("radiance"));
}

Result<MadeLight> make_mesh(const Node& n, const LightContext& c) {
  const auto mesh = load_mesh(n, c.meshes);
  if (!mesh) return mesh.error();
  const auto placed = world_from_local(n.child("transform"));
  if (!placed) return under("transform", placed.error());
  auto surface = std::make_shared<MeshSurface>(*mesh, translation(-c.scene_origin) * *placed);
  auto sampling = surface->sampling();
  if (!sampling) return bad_input("found triangles without area, expected some area to shine", {"", 0, 0, "file"});
  return made<SurfaceLight>(std::move(surface), std::move(sampling), n.color("radiance"), n.flag("two_sided"),
                            SurfaceLight::Hiding::ByLight);
}

Result<MadeLight> make_directional(const Node& n, const LightContext&) {
  const auto direction = direction_of(n, "direction");
  if (!direction) return direction.error();
  return made<DirectionalLight>(Vec3(*direction), n.color("irradiance"), number(n, "angular_diameter_deg") * kRadians);
}

Result<MadeLight> make_environment(const Node& n, const LightContext&) {
  return made<ConstantEnvironment>(n.color("radiance"));
}

Result<MadeLight> make_image_environment(const Node& n, const LightContext& c) {
  const std::string& file = n.text("file");
  if (file.empty()) return bad_input("found no file name, expected a picture in .exr or .hdr", {"", 0, 0, "file"});
  const auto map = c.pictures.load(file, EnvironmentMap::read);
  if (!map) return under("file", map.error());
  MadeLight out{std::make_unique<ImageEnvironment>(*map, n.color("radiance"), number(n, "rotate_deg") * kRadians)};
  if ((*map)->mended() > 0)
    out.warnings.push_back(file + ": " + std::to_string((*map)->mended()) +
                           " values were negative or not finite and count as 0");
  return out;
}

}  // namespace

const std::vector<LightType>& light_types() {
  static const std::vector<LightType> types{{&point_table(), make_point},
                                            {&spot_table(), make_spot},
                                            {&directional_table(), make_directional},
                                            {&quad_table(), make_quad},
                                            {&disc_table(), make_disc},
                                            {&sphere_table(), make_sphere},
                                            {&mesh_table(), make_mesh},
                                            {&environment_table(), make_environment},
                                            {&image_environment_table(), make_image_environment}};
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

Result<MadeLight> make_light(const Node& node, const LightContext& context) {
  for (const LightType& t : light_types()) {
    if (t.table != &node.table()) continue;
    auto made = t.make(node, context);
    if (made) made->light->visible_to_camera = node.flag("visible_to_camera");
    return made;
  }
  BRUME_CHECK(node.kind(), ==, "a light");
  return MadeLight{};
}

}  // namespace brume
