#include "renderer/media/grid_shader.h"

#include <algorithm>
#include <limits>

#include "renderer/core/blackbody.h"
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

GridShader::GridShader(Field density, Glow glow, float voxel_size)
    : density_(std::move(density)), glow_(std::move(glow)), voxel_size_(voxel_size) {}

ShaderTraits GridShader::traits() const {
  ShaderTraits traits;
  traits.own_emission = glow_.amount.grid || glow_.temperature.grid;
  traits.finest_scale = voxel_size_;
  traits.lookup_nanoseconds = 1.3f;
  return traits;
}

void GridShader::density(const PointBatch& points, float* density) const { lookup(density_, points, density); }

std::size_t GridShader::memory_bytes() const {
  std::size_t bytes = 0;
  for (const Field* field : {&density_, &glow_.amount, &glow_.temperature})
    if (field->grid) bytes += field->grid->memory_bytes();
  return bytes;
}

float GridShader::max_density(const Bounds3& box) const {
  if (!density_.grid) return 0;
  const Bounds3 in_grid = transform_bounds(density_.index_from_scene.cast<double>(), box);
  return density_.grid->max_value(in_grid) * 1.00001f;  // interpolation rounds
}

void GridShader::emission(const PointBatch& points, const EmissionBatch& emission) const {
  const auto [r, g, b] = emission;
  if (glow_.amount.grid)
    lookup(glow_.amount, points, r);
  else
    std::fill_n(r, points.n, 1.0f);
  if (!glow_.temperature.grid) {
    std::copy_n(r, points.n, g);
    std::copy_n(r, points.n, b);
    return;
  }
  lookup(glow_.temperature, points, g);
  for (int i = 0; i < points.n; ++i) {
    const Color glow = g[i] > 0 ? r[i] * blackbody_glow(glow_.scale * g[i] + glow_.offset) : Color{};
    r[i] = glow.r, g[i] = glow.g, b[i] = glow.b;
  }
}

namespace {

/// Length of the shortest voxel edge; index_to_world may rotate and shear.
double smallest_edge(const Affined& index_to_world) {
  return std::min({length(index_to_world.axis(0)), length(index_to_world.axis(1)), length(index_to_world.axis(2))});
}

Result<MadeShader> make_grid_shader(const Node& volume, const ShaderContext& context) {
  MadeShader made;
  constexpr int kFields = 3;
  const char* const keys[kFields] = {"grid", "emission_grid", "temperature_grid"};
  GridShader::Field fields[kFields];
  Affined index_from_scene[kFields];
  Bounds3 support[kFields];
  double voxel_size = std::numeric_limits<double>::infinity();
  const std::string& file = volume.text("file");
  if (file.empty()) return bad_input("found no file name, expected a .vdb or .nvdb file", {"", 0, 0, "file"});
  LoadOptions options = context.load_options;
  options.full_precision = volume.text("precision") == "full";
  int main = -1;  // the first field that has a grid
  for (int k = 0; k < kFields; ++k) {
    const std::string& name = volume.text(keys[k]);
    if (name.empty()) continue;
    if (main < 0) main = k;
    const auto loaded = context.grids.load(file, name, options);
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
  if (main < 0) return bad_input("found no grid, expected the name of one", {"", 0, 0, "grid"});

  // The bounds are the first grid's box, grown so that they hold the others': fire may burn where there is no smoke.
  Bounds3 box = support[main];
  for (int k = main + 1; k < kFields; ++k)
    if (fields[k].grid) box.add(transform_bounds(index_from_scene[main] * *inverse(index_from_scene[k]), support[k]));
  made.shape = std::make_shared<BoxShape>(box.low, box.high);
  made.shape_from_scene = index_from_scene[main];
  GridShader::Glow glow{fields[1], fields[2], static_cast<float>(volume.number("temperature_scale")),
                        static_cast<float>(volume.number("temperature_offset"))};
  made.shader = std::make_shared<GridShader>(fields[0], std::move(glow), static_cast<float>(voxel_size));
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
           .says("Name of the grid that gives the emission; empty: the emission follows the density."),
       param::grid("temperature_grid", "Temperature grid")
           .says("Name of the grid whose heat colours the emission as of a black body, 3000 K having the luminance 1; "
                 "empty for none."),
       param::number("temperature_scale", "Temperature scale", 1)
           .at_least(0)
           .log_slider(1, 3000)
           .in("K")
           .says("Kelvin for each unit of the temperature grid."),
       param::number("temperature_offset", "Temperature offset", 0)
           .slider(-1000, 1000)
           .in("K")
           .says("Kelvin added wherever the temperature grid is not 0."),
       param::choice("precision", "Voxels", "half",
                     {{"half", "Half", "half floats: off by a two thousandth at most, and twice as fast"},
                      {"full", "Full", "floats, for reference work"}})
           .says("How exactly the values of the grids are kept.")},
      true,
      make_grid_shader};
}

}  // namespace brume
