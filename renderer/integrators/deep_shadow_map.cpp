#include "renderer/integrators/deep_shadow_map.h"

#include "renderer/core/parallel.h"
#include "renderer/march/shadow_march.h"

namespace brume {

std::unique_ptr<const DeepShadowMap> DeepShadowMap::make(const Scene& scene, const Light& light) {
  const LightPoint point = light.sample_point({0.5f, 0.5f});
  const bool projects =
      point.kind != LightPoint::Kind::Environment && light.solid_angle(Vec3(scene.bounds.center())) == 0;
  if (!projects || scene.bounds.empty()) return nullptr;
  return std::unique_ptr<const DeepShadowMap>(new DeepShadowMap(scene, point, scene.render.shadow_map_resolution));
}

DeepShadowMap::DeepShadowMap(const Scene& scene, const LightPoint& point, int resolution)
    : point_(point),
      frame_(point.kind == LightPoint::Kind::Distant ? point.direction : Vec3(0, 0, 1)),
      center_(scene.bounds.center()),
      radius_(static_cast<float>(0.5 * scene.bounds.diagonal())),
      resolution_(resolution) {
  if (point.kind == LightPoint::Kind::Distant) {
    near_ = 0, far_ = 2 * radius_;
  } else {
    const float to_center = length(center_ - point.position);
    near_ = std::max(0.0f, to_center - radius_), far_ = to_center + radius_;
  }
  const int knots = resolution;
  tau_.resize(static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution) *
              static_cast<std::size_t>(knots));
  const float piece = (far_ - near_) / static_cast<float>(knots - 1);
  cpu_seconds_ = parallel_for(resolution, [&](int row) {
    Arena arena;
    MarchCounts counts;
    for (int column = 0; column < resolution; ++column) {
      const Ray whole = ray_of(static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f);
      Color sum;
      for (int k = 0; k < knots; ++k) {
        if (k > 0) {
          const float from = near_ + static_cast<float>(k - 1) * piece;
          const ArenaScope scope(arena);
          sum += to_color(shadow_optical_depth<3>(scene.media, {whole.origin, whole.direction, {from, from + piece}},
                                                  {scene.shadow_step_size, 0.5f, scene.render.time}, arena, counts));
        }
        tau_[static_cast<std::size_t>((row * resolution + column) * knots + k)] = sum;
      }
    }
  });
}

Ray DeepShadowMap::ray_of(float u, float v) const {
  const float x = u / static_cast<float>(resolution_), y = v / static_cast<float>(resolution_);
  if (point_.kind == LightPoint::Kind::Distant) {
    const Vec3 on_plane = center_ + frame_.s * ((2 * x - 1) * radius_) + frame_.t * ((2 * y - 1) * radius_);
    return {on_plane + frame_.n * radius_, -frame_.n};
  }
  const float phi = 2 * kPi * x, theta = kPi * y;
  return {point_.position, {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}};
}

DeepShadowMap::Place DeepShadowMap::place_of(Vec3 x) const {
  const float size = static_cast<float>(resolution_);
  if (point_.kind == LightPoint::Kind::Distant) {
    const Vec3 p = x - center_;
    return {(0.5f + 0.5f * dot(p, frame_.s) / radius_) * size, (0.5f + 0.5f * dot(p, frame_.t) / radius_) * size,
            radius_ - dot(p, frame_.n)};
  }
  const Vec3 p = x - point_.position;
  float phi = std::atan2(p.y, p.x);
  if (phi < 0) phi += 2 * kPi;
  return {phi / (2 * kPi) * size, std::atan2(std::hypot(p.x, p.y), p.z) / kPi * size, length(p)};
}

Color DeepShadowMap::transmittance(Vec3 x) const {
  const Place at = place_of(x);
  const int knots = resolution_;
  const float depth = std::clamp((at.distance - near_) / (far_ - near_), 0.0f, 1.0f) * static_cast<float>(knots - 1);
  const int k = std::min(static_cast<int>(depth), knots - 2);
  const float fk = depth - static_cast<float>(k);
  const float u = at.u - 0.5f, v = at.v - 0.5f;
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  const float fu = u - static_cast<float>(i), fv = v - static_cast<float>(j);
  const bool around = point_.kind != LightPoint::Kind::Distant;  // columns go round the light
  const auto tau = [&](int column, int row) {
    column = around ? (column + resolution_) % resolution_ : std::clamp(column, 0, resolution_ - 1);
    row = std::clamp(row, 0, resolution_ - 1);
    const auto first = static_cast<std::size_t>((row * resolution_ + column) * knots + k);
    return tau_[first] * (1 - fk) + tau_[first + 1] * fk;
  };
  const Color sum =
      (tau(i, j) * (1 - fu) + tau(i + 1, j) * fu) * (1 - fv) + (tau(i, j + 1) * (1 - fu) + tau(i + 1, j + 1) * fu) * fv;
  return {std::exp(-sum.r), std::exp(-sum.g), std::exp(-sum.b)};
}

}  // namespace brume
