#include "app/cli/render_report.h"

#include <nlohmann/json.hpp>
#include <set>

#include "renderer/core/simd.h"

namespace brume {

std::string format_report(const RenderReport& report) {
  const RenderStatistics& s = report.statistics;
  nlohmann::ordered_json json;
  json["brume"] = BRUME_VERSION;
  json["scene"] = report.scene_file;
  json["output"] = report.output;
  json["width"] = report.scene.film.width;
  json["height"] = report.scene.film.height;
  json["integrator"] = report.scene.render.integrator;
  json["seed"] = report.scene.render.seed;
  json["samples_per_pixel"] = s.samples_per_pixel;
  json["interrupted"] = report.interrupted;
  json["noise"] = report.noise;

  json["wall_seconds"] = s.wall_seconds;
  json["cpu_seconds"] = s.cpu_seconds;
  json["load_seconds"] = report.load_seconds;
  json["threads"] = s.threads;
  json["simd_level"] = simd_level();

  json["rays"] = s.rays.rays;
  json["shadow_rays"] = s.rays.shadow_rays;
  json["lookups"] = s.rays.march.lookups;
  json["segments"] = s.rays.march.segments;
  json["pool_high_water_bytes"] = s.pool_high_water_bytes;
  json["grid_bytes"] = report.grid_bytes;

  json["non_finite_samples"] = s.rays.non_finite;
  json["capped_rays"] = s.rays.march.capped;
  json["majorant_exceeded"] = s.rays.march.exceeded;

  json["needs"] = report.scene.needs.to_string();
  json["step_size"] = report.scene.step_size;
  json["shadow_step_size"] = report.scene.shadow_step_size;
  json["warnings"] = report.scene.warnings;
  // Names of files need not be UTF-8, and JSON must be.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::size_t grid_memory_bytes(const Node& description, GridCache& grids) {
  std::set<std::pair<std::string, std::string>> names;
  for (const Node& volume : description.list("volumes")) {
    if (!volume.flag("enabled")) continue;
    for (const Param& p : volume.table().params)
      if (p.type == ParamType::Grid && !volume.text(p.key).empty())
        names.emplace(volume.text("file"), volume.text(p.key));
  }
  std::size_t bytes = 0;
  for (const auto& [file, grid] : names)
    if (const auto loaded = grids.load(file, grid, {})) bytes += (*loaded)->grid->memory_bytes();
  return bytes;
}

}  // namespace brume
