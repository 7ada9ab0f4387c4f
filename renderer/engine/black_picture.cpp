#include "renderer/engine/black_picture.h"

#include <algorithm>

#include "renderer/engine/survey.h"

namespace brume {

std::optional<std::string> explain_black(const Scene& scene, const Picture& picture) {
  float brightest = 0;
  for (const Color& c : picture.image.pixels) brightest = std::max(brightest, max_channel(c));
  if (brightest > 1e-3f) return std::nullopt;

  if (scene.media.empty() && !scene.surfaces)
    return "There is no volume that is switched on: add one, or drop a .vdb file here.";
  if (scene.lights.empty() && !scene.needs.emission)
    return "No light is switched on and nothing glows: add a light, or raise emission_scale.";
  if (!scene.needs.emission && !light_arrives(scene))
    return "Surfaces keep all light away from the volume: move one, or switch it off.";
  const std::string dark = "The brightest value is " + short_number(brightest) + ": raise the exposure or the lights.";
  if (scene.media.empty()) return dark;
  const std::vector<float> depths = optical_depths(scene, 32, 32);
  const float deepest = *std::max_element(depths.begin(), depths.end());
  if (deepest == 0) {
    float density = 0;
    for (const Medium& m : scene.media) density = std::max(density, max_channel(m.sigma_t));
    if (density == 0) return "The density scale is 0: raise density_scale.";
    return std::string("The camera sees no volume") + (scene.surfaces ? ", or a surface is before it" : "") +
           ": press F to frame everything.";
  }
  if (deepest < 0.05f) {
    const float middle = depths[depths.size() / 2 + 16];
    return "The optical depth through the middle is " + short_number(middle) + " and nowhere above " +
           short_number(deepest) + ": raise density_scale by about " + short_number(two_digits(4 / deepest)) +
           " times.";
  }
  const bool scatters =
      std::any_of(scene.media.begin(), scene.media.end(), [](const Medium& m) { return !is_black(m.sigma_s); });
  if (!scatters && !scene.needs.emission) return "The medium absorbs everything: raise its albedo.";
  return dark;
}

}  // namespace brume
