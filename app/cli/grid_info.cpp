#include "app/cli/grid_info.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/cli/text_table.h"
#include "renderer/params/param.h"

namespace brume {
namespace {

using Json = nlohmann::ordered_json;

std::string vector_text(Vec3d v) {
  return "[" + short_number(v.x) + ", " + short_number(v.y) + ", " + short_number(v.z) + "]";
}

/// One number for cubes, three otherwise.
std::string voxel_size_text(const GridInfo& grid) {
  if (!grid.affine) return "frustum";
  const Vec3d v = grid.voxel_size;
  const double tolerance = 1e-5 * v.x;  // of matrices that went through float
  const bool cube = std::abs(v.x - v.y) < tolerance && std::abs(v.x - v.z) < tolerance;
  return cube ? short_number(v.x) : vector_text(v);
}

bool has_voxels(const GridInfo& grid) { return grid.active_voxels.value_or(0) > 0 && !grid.world_bounds.empty(); }

VoxelIndex dimensions(const GridInfo& grid) { return grid.index_max - grid.index_min + VoxelIndex(1); }

std::string dimensions_text(const GridInfo& grid) {
  if (!has_voxels(grid)) return "-";
  const VoxelIndex d = dimensions(grid);
  return std::to_string(d.x) + "x" + std::to_string(d.y) + "x" + std::to_string(d.z);
}

std::string bounds_text(const GridInfo& grid) {
  if (grid.world_bounds.empty()) return "-";
  return vector_text(grid.world_bounds.low) + " .. " + vector_text(grid.world_bounds.high);
}

/// What Brume makes of the grid, and what is wrong with it.
std::string remarks(const GridInfo& grid, const std::vector<GridInfo>& all) {
  if (!grid.usable) return "not usable: " + grid.why_not;
  std::vector<std::string> parts;
  if (guess_density_grid(all) == grid.name) parts.emplace_back("taken as density");
  if (guess_emission_grid(all) == grid.name) parts.emplace_back("taken as emission");
  if (parts.empty()) parts.emplace_back("usable");
  if (grid.non_finite > 0) parts.push_back(std::to_string(grid.non_finite) + " NaN or infinite voxels become 0");
  if (grid.negative > 0) parts.push_back(std::to_string(grid.negative) + " negative voxels become 0");
  return join(parts, "; ");
}

std::vector<std::string> row_of(const GridInfo& grid, const std::vector<GridInfo>& all) {
  return {grid.name,
          grid.type + (grid.is_half ? " (half)" : ""),
          grid.grid_class,
          voxel_size_text(grid),
          grid.active_voxels ? std::to_string(*grid.active_voxels) : "-",
          dimensions_text(grid),
          bounds_text(grid),
          grid.scanned && has_voxels(grid) ? short_number(grid.min) + " .. " + short_number(grid.max) : "-",
          grid.memory_bytes > 0 ? format_bytes(static_cast<double>(grid.memory_bytes)) : "-",
          grid.codec,
          remarks(grid, all)};
}

Json vector_json(Vec3d v) { return Json::array({v.x, v.y, v.z}); }
Json vector_json(VoxelIndex v) { return Json::array({v.x, v.y, v.z}); }

Json to_json(const GridInfo& grid) {
  const bool voxels = has_voxels(grid), range = grid.scanned && voxels;
  Json json;
  json["name"] = grid.name;
  json["type"] = grid.type;
  json["class"] = grid.grid_class;
  json["half"] = grid.is_half;
  json["codec"] = grid.codec;
  json["affine"] = grid.affine;
  json["voxel_size"] = grid.affine ? vector_json(grid.voxel_size) : Json();
  json["active_voxels"] = grid.active_voxels ? Json(*grid.active_voxels) : Json();
  json["index_bounds"] =
      voxels ? Json{{"min", vector_json(grid.index_min)}, {"max", vector_json(grid.index_max)}} : Json();
  json["dimensions"] = voxels ? vector_json(dimensions(grid)) : Json();
  json["bounds"] =
      voxels ? Json{{"min", vector_json(grid.world_bounds.low)}, {"max", vector_json(grid.world_bounds.high)}} : Json();
  json["min"] = range ? Json(grid.min) : Json();
  json["max"] = range ? Json(grid.max) : Json();
  json["memory_bytes"] = grid.memory_bytes;
  json["non_finite_voxels"] = grid.scanned ? Json(grid.non_finite) : Json();
  json["negative_voxels"] = grid.scanned ? Json(grid.negative) : Json();
  json["usable"] = grid.usable;
  json["why_not"] = grid.usable ? Json() : Json(grid.why_not);
  return json;
}

}  // namespace

std::string grids_as_text(const std::string& file, const std::vector<GridInfo>& grids) {
  std::error_code unknown;
  const auto bytes = std::filesystem::file_size(file, unknown);
  std::string text = file + ": " + std::to_string(grids.size()) + (grids.size() == 1 ? " grid" : " grids");
  if (!unknown) text += ", " + format_bytes(static_cast<double>(bytes));
  std::vector<std::vector<std::string>> rows{
      {"grid", "type", "class", "voxel size", "active", "dimensions", "bounds", "range", "memory", "codec", "remarks"}};
  for (const GridInfo& grid : grids) rows.push_back(row_of(grid, grids));
  return text + "\n\n" + format_table(rows, "lllrrrllrll", 2);
}

std::string grids_as_json(const std::string& file, const std::vector<GridInfo>& grids) {
  const auto name_or_null = [](const std::optional<std::string>& name) { return name ? Json(*name) : Json(); };
  Json json;
  json["file"] = file;
  json["density_grid"] = name_or_null(guess_density_grid(grids));
  json["emission_grid"] = name_or_null(guess_emission_grid(grids));
  json["grids"] = Json::array();
  for (const GridInfo& grid : grids) json["grids"].push_back(to_json(grid));
  // Names of grids need not be UTF-8, and JSON must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace brume
