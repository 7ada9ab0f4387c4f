#include "renderer/media/grid_shader.h"

#include <algorithm>
#include <limits>

#include "renderer/media/brick_lookup.h"
#include "renderer/media/registry.h"

namespace brume {
namespace {

void lookup(const GridShader::Field& field, const PointBatch& points, float* out) {
  if (field.grid)
    lookup_trilinear(*field.grid, field.index_from_scene, points, 1.0f, out);
  else
    std::fill_n(out, points.n, 0.0f);
}

}  // namespace

GridShader::GridShader(Field density, Field emission, float voxel_size)
    : density_(std::move(density)), emission_(std::move(emission)), voxel_size_(voxel_size) {}

ShaderTraits GridShader::traits() const {
  ShaderTraits traits;
  traits.own_emission = emission_.grid != nullptr;
  traits.finest_scale = voxel_size_;
  return traits;
}

void GridShader::density(const PointBatch& points, float* density) const { lookup(density_, points, density); }

float GridShader::max_density(const Bounds3& box) const {
  if (!density_.grid) return 0;
  const Bounds3 in_grid = transform_bounds(density_.index_from_scene.cast<double>(), box);
  return density_.grid->max_value(in_grid) * 1.00001f;  // interpolation rounds
}

void GridShader::emission(const PointBatch& points, float* emission) const { lookup(emission_, points, emission); }

namespace {

/// Length of the shortest voxel edge; index_to_world may rotate and shear.
double smallest_edge(const Affined& index_to_world) {
  return std::min({length(index_to_world.axis(0)), length(index_to_world.axis(1)), length(index_to_world.axis(2))});
}

Result<MadeShader> make_grid_shader(const Node& volume, const ShaderContext& context) {
  MadeShader made;
  GridShader::Field fields[2];
  const char* const keys[2] = {"grid", "emission_grid"};
  Affined index_from_scene[2];
  Bounds3 support[2];
  double voxel_size = std::numeric_limits<double>::infinity();
  const std::string& file = volume.text("file");
  if (file.empty()) return bad_input("found no file name, expected a .vdb or .nvdb file", {"", 0, 0, "file"});
  for (int k = 0; k < 2; ++k) {
    const std::string& name = volume.text(keys[k]);
    if (name.empty()) continue;
    const auto loaded = context.grids.load(file, name, context.load_options);
    if (!loaded) {
      Error error = loaded.error();
      if (error.source.key.empty()) error.source.key = keys[k];
      return error;
    }
    const LoadedGrid& grid = **loaded;
    made.warnings.insert(made.warnings.end(), grid.warnings.begin(), grid.warnings.end());
    const auto index_from_local = inverse(grid.index_to_world);
    const auto scene_from_local = inverse(context.local_from_scene);
    if (!index_from_local || !scene_from_local)
      return bad_input("found a grid whose transform flattens space, expected an invertible one", {"", 0, 0, keys[k]});
    index_from_scene[k] = *index_from_local * context.local_from_scene;
    fields[k] = {grid.grid, index_from_scene[k].cast<float>()};
    support[k] = grid.grid->support();
    voxel_size = std::min(voxel_size, smallest_edge(*scene_from_local * grid.index_to_world));
  }
  if (!fields[0].grid && !fields[1].grid)
    return bad_input("found no grid, expected the name of one", {"", 0, 0, "grid"});

  // The bounds are the density's box, grown so that they hold the emission's: fire may burn where there is no smoke.
  const int main = fields[0].grid ? 0 : 1;
  Bounds3 box = support[main];
  if (main == 0 && fields[1].grid)
    box.add(transform_bounds(index_from_scene[0] * *inverse(index_from_scene[1]), support[1]));
  made.shape = std::make_shared<BoxShape>(box.low, box.high);
  made.shape_from_scene = index_from_scene[main];
  made.shader = std::make_shared<GridShader>(fields[0], fields[1], static_cast<float>(voxel_size));
  return made;
}

}  // namespace

ShaderType vdb_shader_type() {
  return {
      "vdb",
      "VDB grid",
      "Density from a grid of an OpenVDB (.vdb) or NanoVDB (.nvdb) file, trilinearly interpolated.",
      {param::file("file", "File").must_be_given().says("The .vdb or .nvdb file."),
       param::grid("grid", "Density grid", "density").says("Name of the grid that gives the density; empty for none."),
       param::grid("emission_grid", "Emission grid")
           .says("Name of the grid that gives the emission; empty: the emission follows the density.")},
      true,
      make_grid_shader};
}

}  // namespace brume
