#include "app/cli/render_report.h"

#include <nlohmann/json.hpp>

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
  json["grid_bytes"] = report.scene.grid_bytes();

  json["non_finite_samples"] = s.rays.non_finite;
  json["capped_rays"] = s.rays.march.capped;
  json["majorant_exceeded"] = s.rays.march.exceeded;

  json["needs"] = report.scene.needs.to_string();
  json["step_size"] = report.scene.step_size;
  json["shadow_step_size"] = report.scene.shadow_step_size;
  json["light_samples"] = report.scene.light_samples;
  json["warnings"] = report.scene.warnings;
  // Names of files need not be UTF-8, and JSON must be.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace brume
