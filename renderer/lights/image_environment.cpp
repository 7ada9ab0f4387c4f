#include "renderer/lights/image_environment.h"

namespace brume {

namespace {
constexpr float kInfinity = std::numeric_limits<float>::infinity();
}

ImageEnvironment::ImageEnvironment(std::shared_ptr<const EnvironmentMap> map, Color scale, float rotation)
    : map_(std::move(map)), scale_(scale), cos_(std::cos(rotation)), sin_(std::sin(rotation)) {}

LightHit ImageEnvironment::seen_at(Vec3 direction) const {
  const Vec3 in_map = to_map(direction);
  const float pdf = map_->pdf_w(in_map);
  const Color radiance = map_->radiance(in_map) * scale_;
  return {kInfinity,
          radiance,
          pdf,
          {.kind = LightPoint::Kind::Distant,
           .direction = direction,
           .sent = pdf > 0 ? radiance / pdf : Color(),
           .pdf = pdf}};
}

LightPoint ImageEnvironment::sample_point(Vec2 u) const { return seen_at(from_map(map_->sample(u).direction)).point; }

std::optional<LightHit> ImageEnvironment::hit(const Ray& ray) const {
  if (ray.span.end != kInfinity) return std::nullopt;
  return seen_at(ray.direction);
}

}  // namespace brume
