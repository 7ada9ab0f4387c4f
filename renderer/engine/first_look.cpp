#include "renderer/engine/first_look.h"

#include <algorithm>

#include "renderer/core/check.h"
#include "renderer/engine/survey.h"
#include "renderer/integrators/registry.h"
#include "renderer/lights/registry.h"
#include "renderer/scene/framing.h"
#include "renderer/scene/volume.h"

namespace brume {
namespace {

void must(const Result<void>& done) {
  if (!done) BRUME_CHECK(done.error().to_string(), ==, "no error");
}

Node& add(Node& scene, const char* list, const Family& family, const char* kind, const char* name) {
  Node& node = scene.list(list).emplace_back(*family.find(kind));
  must(node.set("name", std::string(name)));
  return node;
}

/// A warm key from the upper right in front and a cool rim from behind on the left.
void add_lights(Node& scene) {
  Node& key = add(scene, "lights", light_family(), "directional", "key");
  must(key.set("direction", Numbers{-0.7, 0.6, -0.8}));
  must(key.set("irradiance", Numbers{9, 8.2, 7}));
  Node& rim = add(scene, "lights", light_family(), "directional", "rim");
  must(rim.set("direction", Numbers{0.8, -0.7, -0.1}));
  must(rim.set("irradiance", Numbers{2.2, 3, 4.5}));
}

/// Grids hold kelvin or, more often, numbers that somebody found handy: then the hottest is made a candle's flame.
double kelvin_per_unit(float hottest) {
  const bool kelvin = hottest > 500;
  return kelvin || !(hottest > 0) ? 1 : 2700 / static_cast<double>(hottest);
}

}  // namespace

double density_scale_for(const Scene& scene, double target) {
  std::vector<float> depths = optical_depths(scene, 64, 64);
  std::erase_if(depths, [](float tau) { return !(tau > 0); });
  if (depths.empty()) return 0;
  const auto p90 = depths.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(depths.size() - 1));
  std::nth_element(depths.begin(), p90, depths.end());
  return target / static_cast<double>(*p90);
}

Result<FirstLook> first_look(const std::string& path, SceneCache& cache, const LoadOptions& options) {
  const auto infos = list_grids(path, false);
  if (!infos) return infos.error();
  const auto density = guess_density_grid(*infos);
  const auto flame = guess_emission_grid(*infos);
  if (!density && !flame) {
    std::vector<std::string> names;
    for (const GridInfo& info : *infos) names.push_back(info.name + " (" + info.why_not + ")");
    return bad_input("found no grid that can be rendered among: " + join(names) + "; expected a float fog volume",
                     {path, 0, 0, ""});
  }

  FirstLook look{Node(*scene_family().tables.front()), {}};
  Node& scene = look.description;
  Node& volume = add(scene, "volumes", volume_family(), "vdb", "volume");
  must(volume.set("file", path));
  must(volume.set("grid", density.value_or("")));
  add_lights(scene);
  must(scene.child("render").set("bounces", std::int64_t{1}));
  if (density) look.notes.push_back("density from the grid \"" + *density + "\"");
  if (flame) {
    must(volume.set("emission_grid", *flame));
    must(volume.set("emission_scale", 8.0));
    look.notes.push_back("glow from the grid \"" + *flame + "\"");
    if (const auto heat = guess_temperature_grid(*infos)) {
      const auto loaded = cache.grids.load(path, *heat, options);
      if (!loaded) return loaded.error();
      must(volume.set("temperature_grid", *heat));
      must(volume.set("temperature_scale", two_digits(kelvin_per_unit((*loaded)->grid->max_value()))));
      look.notes.push_back("its colour from the grid \"" + *heat + "\"");
    } else {
      must(volume.set("emission_color", Numbers{1, 0.42, 0.12}));
    }
  }

  // Framed from the front, a little from above.
  Node& camera = scene.child("camera");
  auto made = make_volume(volume, {}, cache, options);
  if (!made) return made.error();
  must(camera.set("look_at", Numbers{0, 0, 0}));
  must(camera.set("position", Numbers{0.25, -1, 0.2}));
  const Numbers& resolution = scene.child("film").numbers("resolution");
  frame_bounds(camera, made->bounds, resolution[0] / resolution[1]);

  const auto committed =
      commit(scene, cache, {.generation = 0, .progress = options.progress, .cancel = options.cancel});
  if (!committed) return committed.error();
  constexpr double kTargetOpticalDepth = 4;  // dense enough to have a lit and a dark side, thin enough to see into
  const double scale = two_digits(density_scale_for(**committed, kTargetOpticalDepth));
  if (scale > 0 && std::isfinite(scale)) {
    must(volume.set("density_scale", scale));
    look.notes.push_back("density scaled by " + short_number(scale) +
                         " so that most of it has an optical depth below 4");
  }
  return look;
}

}  // namespace brume
