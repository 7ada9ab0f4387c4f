#include "renderer/scene/light_budget.h"

#include <algorithm>
#include <cmath>

namespace brume {
namespace {

// Nanoseconds, of which only the ratios count: of a camera ray, of a segment's record and distribution, and of a light
// sample, without look-ups.
constexpr double kRay = 500, kSegment = 3, kSample = 80;

// How the cost of lighting a camera ray should compare with that of its march. Where light that scatters once in the
// medium is all there is, the samples of a march are stratified, and their error falls faster than their cost grows.
// Elsewhere much of the error is not theirs to mend: it comes from where the ray goes on, from edges of surfaces, from
// the glow. Least error at equal time over the scenes that ship.
constexpr double kAlone = 4.0, kAmongOthers = 0.5;

constexpr int kMost = 16;

}  // namespace

int balanced_light_samples(const Scene& scene) {
  if (scene.bounds.empty() || scene.lights.empty()) return 1;
  const Vec3d size = scene.bounds.high - scene.bounds.low;
  const double surface = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
  const double chord = 4 * size.x * size.y * size.z / std::max(surface, 1e-300);  // mean of a convex body: Cauchy
  const double steps = std::min(chord / static_cast<double>(scene.step_size), 1e5),
               shadow_steps = std::min(0.5 * chord / static_cast<double>(scene.shadow_step_size), 1e5);
  double lookup = 0;
  for (const Medium& m : scene.media) lookup += static_cast<double>(m.traits.lookup_nanoseconds);

  const bool alone = scene.render.bounces == 0 && !scene.needs.surfaces && !scene.needs.emission;
  const double balance = alone ? kAlone : kAmongOthers;
  const double samples = balance * (kRay + steps * (kSegment + lookup)) / (kSample + shadow_steps * lookup);
  const bool all = scene.render.light_selection == LightSelection::All;
  const double of_each = samples / (all ? static_cast<double>(scene.lights.size()) : 1.0);
  return std::clamp(static_cast<int>(std::lround(of_each)), 1, kMost);
}

}  // namespace brume
