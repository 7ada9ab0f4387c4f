#include "renderer/scene/volume.h"

#include <algorithm>
#include <cmath>

#include "renderer/core/check.h"
#include "renderer/geometry/shape_params.h"
#include "renderer/geometry/transform_params.h"
#include "renderer/media/grid_shader.h"
#include "renderer/media/registry.h"
#include "renderer/phase/registry.h"

namespace brume {
namespace {

ParamTable volume_table(const ShaderType& shader) {
  ParamTable table{shader.key, shader.label, shader.doc, {}, {}};
  auto& p = table.params;
  p.push_back(param::text("name", "Name").says("Name by which --set and the panels address the volume."));
  p.push_back(param::flag("enabled", "On", true).says("Whether the volume is there."));
  for (const Param& own : shader.params) p.push_back(own);
  p.push_back(param::number("density_scale", "Density scale", 1)
                  .at_least(0)
                  .log_slider(0.01, 1000)
                  .in("1/world unit")
                  .says("Extinction where the shader's density is 1."));
  p.push_back(param::color("albedo", "Albedo", 0.9, 0.9, 0.9)
                  .between(0, 1)
                  .says("Share of the extinction that scatters; the rest absorbs."));
  p.push_back(param::color("sigma_s", "Scattering", 1, 1, 1)
                  .slider(0, 10)
                  .auto_by_default("the albedo")
                  .says("Scattering coefficient for a scaled density of 1; overrides the albedo."));
  p.push_back(param::color("sigma_a", "Absorption", 0, 0, 0)
                  .slider(0, 10)
                  .auto_by_default("1 - albedo")
                  .says("Absorption coefficient for a scaled density of 1; overrides the albedo."));
  p.push_back(param::number("emission_scale", "Emission scale", 0)
                  .at_least(0)
                  .log_slider(0.01, 1000)
                  .in("W/(sr m^3)")
                  .says("Radiance emitted per unit length where the emission field is 1; 0 is no glow."));
  p.push_back(param::color("emission_color", "Emission colour", 1, 1, 1)
                  .slider(0, 1)
                  .says("Colour that multiplies the emission scale."));
  if (shader.bakes) {
    p.push_back(param::flag("baked", "Baked", false)
                    .costs(Affects::Geometry)
                    .says("Keeps the density on voxels and looks it up there instead of computing it: much faster, but "
                          "nothing finer than a voxel is left."));
    p.push_back(param::number("baked_voxel", "Baked voxel", 0.02)
                    .more_than(0)
                    .log_slider(0.001, 1)
                    .in("world units")
                    .auto_by_default("the smallest feature of the density")
                    .costs(Affects::Geometry)
                    .says("Edge of the voxels that a baked density is kept on."));
  }
  if (!shader.brings_bounds)
    table.slots.push_back({"bounds", "Bounds", "Shape outside which there is nothing.", &shape_family()});
  table.slots.push_back({"phase", "Phase function", "Which way light goes on after scattering.", &phase_family()});
  table.slots.push_back({"transform", "Transform", "Where the volume stands.", &transform_family()});
  return table;
}

/// The tables, in the order of shader_types().
const std::vector<ParamTable>& volume_tables() {
  static const std::vector<ParamTable> tables = [] {
    std::vector<ParamTable> all;
    for (const ShaderType& t : shader_types()) all.push_back(volume_table(t));
    return all;
  }();
  return tables;
}

const ShaderType& shader_of(const Node& volume) {
  for (std::size_t i = 0; i < volume_tables().size(); ++i)
    if (&volume_tables()[i] == &volume.table()) return shader_types()[i];
  BRUME_CHECK(volume.kind(), ==, "a volume");
  return shader_types().front();
}

/// density_scale and albedo are the shorthand of sigma_s and sigma_a; this is where they become coefficients.
void set_coefficients(const Node& volume, Medium& medium) {
  const float scale = static_cast<float>(volume.number("density_scale"));
  const Color albedo = volume.color("albedo");
  const Color sigma_s = volume.is_auto("sigma_s") ? albedo : volume.color("sigma_s");
  const Color sigma_a = volume.is_auto("sigma_a") ? Color(1) - albedo : volume.color("sigma_a");
  medium.sigma_s = sigma_s * scale;
  medium.sigma_t = (sigma_s + sigma_a) * scale;
  medium.emission = volume.color("emission_color") * static_cast<float>(volume.number("emission_scale"));
}

/// A length of which the last bits do not tell from which rotation it was computed.
double rounded(double length) {
  int exponent = 0;
  const double mantissa = std::frexp(length, &exponent);
  return std::ldexp(std::round(mantissa * 0x1p20) * 0x1p-20, exponent);
}

/// The density of a procedural shader on voxels of the volume's own space, counted from the low corner of its bounds;
/// null where there is none. Where the transform stretches, the voxels' longest edge is the one that is asked for.
Result<std::shared_ptr<const Shader>> baked_shader(const Node& volume, const ShaderType& type, const Bounds3& box,
                                                   const Affined& local_from_scene, SceneCache& cache,
                                                   const LoadOptions& options) {
  const auto local = type.make(volume, {translation(box.low), cache.grids, options});
  if (!local) return local.error();
  const Affined scene_from_local = *inverse(local_from_scene);
  const double edges[] = {length(scene_from_local.axis(0)), length(scene_from_local.axis(1)),
                          length(scene_from_local.axis(2))};
  const auto [shortest, longest] = std::minmax_element(std::begin(edges), std::end(edges));
  const double voxel = volume.is_auto("baked_voxel")
                           ? static_cast<double>(local->shader->traits().finest_scale.value_or(0.02f))
                           : rounded(volume.number("baked_voxel") / *longest);
  BakeRecipe recipe{type.key, {}, box, voxel};
  for (const Param& p : type.params) recipe.values.push_back(volume.value(p.key));
  const auto grid = cache.baked.load(recipe, [&] { return bake(*local->shader, box.high - box.low, voxel, options); });
  if (!grid) return under("baked_voxel", grid.error());
  if (!*grid) return std::shared_ptr<const Shader>();
  const Affined index_from_scene = scaling(Vec3d(1 / voxel)) * translation(-box.low) * local_from_scene;
  return std::shared_ptr<const Shader>(
      std::make_shared<GridShader>(GridShader::Field{*grid, index_from_scene.cast<float>()}, GridShader::Glow{},
                                   static_cast<float>(voxel * *shortest)));
}

}  // namespace

const Family& volume_family() {
  static const Family family = [] {
    Family f{"volume", "shader", {}};
    for (const ParamTable& t : volume_tables()) f.tables.push_back(&t);
    return f;
  }();
  return family;
}

Result<MadeVolume> make_volume(const Node& volume, Vec3d scene_origin, SceneCache& cache, const LoadOptions& options) {
  const auto placed = world_from_local(volume.child("transform"));
  if (!placed) return under("transform", placed.error());
  const Affined local_from_scene = *inverse(translation(-scene_origin) * *placed);

  const ShaderType& type = shader_of(volume);
  auto made = type.make(volume, {local_from_scene, cache.grids, options});
  if (!made) return made.error();
  if (!made->shape) {
    auto shape = make_shape(volume.child("bounds"), cache.meshes);
    if (!shape) return under("bounds", shape.error());
    made->shape = std::move(*shape);
    made->shape_from_scene = local_from_scene;
  }

  bool baked = false;
  if (type.bakes && volume.flag("baked")) {
    auto shader = baked_shader(volume, type, made->shape->bounds(), local_from_scene, cache, options);
    if (!shader) return shader.error();
    baked = *shader != nullptr;
    if (baked) made->shader = std::move(*shader);
  }

  MadeVolume out;
  out.bounds = transform_bounds(*inverse(made->shape_from_scene), made->shape->bounds());
  out.medium.traits = made->shader->traits();
  out.medium.traits.baked = baked;
  out.medium.shader = std::move(made->shader);
  out.medium.shape = std::move(made->shape);
  out.medium.shape_from_scene = made->shape_from_scene.cast<float>();
  set_coefficients(volume, out.medium);
  out.phase = make_phase(volume.child("phase"));
  out.warnings = std::move(made->warnings);
  return out;
}

}  // namespace brume
