#include "renderer/lights/surface_light.h"

namespace brume {

LightPoint SurfaceLight::sample_point(Vec2 u) const {
  const auto [position, normal] = sampling_->sample(u);
  return point_at(position, normal);
}

float SurfaceLight::solid_angle(Vec3 x) const {
  // Seen from afar a convex body shows a quarter of its surface on average (Cauchy 1832).
  constexpr float kShown = 0.25f;
  return std::min(kShown * sampled_area() / length_squared(middle() - x), 2 * kPi);
}

}  // namespace brume
