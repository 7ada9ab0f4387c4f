#include "renderer/lights/image_environment.h"

namespace brume {

namespace {
constexpr float kInfinity = std::numeric_limits<float>::infinity();
}

ImageEnvironment::ImageEnvironment(std::shared_ptr<const EnvironmentMap> map, Color scale, float rotation)
    : map_(std::move(map)), scale_(scale), cos_(std::cos(rotation)), sin_(std::sin(rotation)) {}

LightPoint ImageEnvironment::point_at(Vec3 direction) const {
  LightPoint point{.kind = LightPoint::Kind::Distant, .direction = direction};
  const Vec3 in_map = to_map(direction);
  point.pdf = map_->pdf_w(in_map);
  if (point.pdf > 0) point.sent = map_->radiance(in_map) * scale_ / point.pdf;
  return point;
}

LightPoint ImageEnvironment::sample_point(Vec2 u) const { return point_at(from_map(map_->sample(u).direction)); }

std::optional<LightHit> ImageEnvironment::hit(const Ray& ray) const {
  if (ray.span.end != kInfinity) return std::nullopt;
  const LightPoint point = point_at(ray.direction);
  return LightHit{kInfinity, map_->radiance(to_map(ray.direction)) * scale_, point.pdf, point};
}

}  // namespace brume
