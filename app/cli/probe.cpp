#include "app/cli/probe.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/cli/console.h"
#include "app/cli/ray_estimate.h"

namespace brume {
namespace {

/// Coordinates as float reach this far before squares of lengths overflow.
constexpr double kFarthest = 1e15;

Error ray_error(const std::string& message) { return bad_input(message, {"", 0, 0, "--ray"}); }

Result<Ray> scene_ray(const ProbeOptions& options, const Scene& scene) {
  const Vec3d origin = options.origin - scene.origin;
  if (length(origin) > kFarthest)
    return ray_error("found an origin further than 1e15 from the scene, expected a nearer one");
  Ray ray{Vec3(origin), Vec3(options.direction)};
  ray.span.begin = static_cast<float>(options.t_min);
  if (options.t_max) ray.span.end = static_cast<float>(*options.t_max);
  return ray;
}

nlohmann::ordered_json to_json(const ProbeOptions& options, const Scene& scene, const RayEstimate& e) {
  using Json = nlohmann::ordered_json;
  const auto vector = [](Vec3d v) { return Json::array({v.x, v.y, v.z}); };
  const auto count = static_cast<double>(e.samples);
  Json json;
  json["scene"] = options.scene.file;
  json["ray"] = {{"origin", vector(options.origin)},
                 {"direction", vector(options.direction)},
                 {"tmin", options.t_min},
                 {"tmax", options.t_max ? Json(*options.t_max) : Json()}};
  json["samples"] = e.samples;
  json["seed"] = scene.render.seed;
  json["non_finite"] = e.non_finite;
  json["radiance"] = {{"mean", e.radiance.mean}, {"standard_error", e.radiance.standard_error}};
  json["transmittance"] = e.transmittance.mean;
  json["transmittance_standard_error"] = e.transmittance.standard_error;
  json["optical_depth"] = e.optical_depth.mean;
  json["optical_depth_standard_error"] = e.optical_depth.standard_error;
  json["segments"] = e.segments;
  json["lookups"] = static_cast<double>(e.statistics.march.lookups) / count;
  json["rays"] = static_cast<double>(e.statistics.rays) / count;
  json["shadow_rays"] = static_cast<double>(e.statistics.shadow_rays) / count;
  json["capped_rays"] = static_cast<double>(e.statistics.march.capped) / count;
  json["step_size"] = scene.step_size;
  json["shadow_step_size"] = scene.shadow_step_size;
  json["seconds"] = e.wall_seconds;
  json["cpu_seconds"] = e.cpu_seconds;
  json["warnings"] = scene.warnings;
  return json;
}

}  // namespace

Result<void> parse_ray(const std::string& text, ProbeOptions& options) {
  const auto value = parse_value(param::numbers("--ray", "Ray", {}), text);
  const auto* v = value ? std::get_if<Numbers>(&*value) : nullptr;
  if (!v || v->size() != 6)
    return ray_error("found \"" + text +
                     "\", expected six numbers ox,oy,oz,dx,dy,dz: where the ray begins and where it goes");
  options.origin = {(*v)[0], (*v)[1], (*v)[2]};
  options.direction = {(*v)[3], (*v)[4], (*v)[5]};
  // Scaled first, so that tiny and huge directions have a length.
  const Vec3d d = options.direction;
  const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  if (!(largest > 0)) return ray_error("found the direction 0,0,0, expected one that leads somewhere");
  options.direction = normalize(Vec3d(d.x / largest, d.y / largest, d.z / largest));
  return {};
}

Result<ExitCode> run_probe(const ProbeOptions& options) {
  if (options.t_max && !(*options.t_max > options.t_min))
    return bad_input("found " + format_value(*options.t_max) + ", expected more than --tmin, which is " +
                         format_value(options.t_min),
                     {"", 0, 0, "--tmax"});
  SceneCache cache;
  SceneOptions independent = options.scene;
  independent.settings.push_back({"--ray", "render.sampler", "independent"});
  const auto loaded = load_scene(independent, cache, {});
  if (!loaded) return loaded.error();
  const auto scene = commit_loaded(*loaded, cache);
  if (!scene) return scene.error();
  for (const std::string& warning : (*scene)->warnings) print_warning(warning);
  const auto ray = scene_ray(options, **scene);
  if (!ray) return ray.error();

  WorkerPool pool(options.threads);
  const RayEstimate estimate = estimate_ray(**scene, *ray, options.samples, pool);
  const auto text =
      to_json(options, **scene, estimate).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  if (auto done = print_result(text + "\n"); !done) return done.error();
  return ExitCode::Ok;
}

}  // namespace brume
