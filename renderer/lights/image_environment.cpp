#include "renderer/lights/image_environment.h"

namespace brume {

namespace {
constexpr float kInfinity = std::numeric_limits<float>::infinity();
}

ImageEnvironment::ImageEnvironment(std::shared_ptr<const EnvironmentMap> map, Color scale, float rotation)
    : map_(std::move(map)), scale_(scale), cos_(std::cos(rotation)), sin_(std::sin(rotation)) {}

LightPoint ImageEnvironment::sample_point(Vec2 u) const {
  return {LightPoint::Kind::Distant, {}, from_map(map_->sample(u).direction), {}};
}

IncidentLight ImageEnvironment::incident(const LightPoint& point, Vec3) const {
  const Vec3 in_map = to_map(point.direction);
  const float pdf = map_->pdf_w(in_map);
  if (!(pdf > 0)) return {point.direction, kInfinity, {}, 0};
  return {point.direction, kInfinity, map_->radiance(in_map) * scale_ / pdf, pdf};
}

std::optional<LightHit> ImageEnvironment::hit(const Ray& ray) const {
  if (ray.span.end != kInfinity) return std::nullopt;
  const Vec3 in_map = to_map(ray.direction);
  return LightHit{kInfinity,
                  map_->radiance(in_map) * scale_,
                  map_->pdf_w(in_map),
                  {LightPoint::Kind::Distant, {}, ray.direction, {}}};
}

}  // namespace brume
