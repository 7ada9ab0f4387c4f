#include "renderer/surfaces/surfaces.h"

namespace brume {

Result<std::unique_ptr<const Surfaces>> Surfaces::make(const std::vector<MadeSurface>& surfaces) {
  auto made = std::make_unique<Surfaces>();
  std::vector<std::shared_ptr<const Surface>> geometry;
  for (const MadeSurface& s : surfaces) {
    geometry.push_back(s.surface);
    made->materials_.push_back(s.material);
  }
  auto rays = RayScene::of(std::move(geometry));
  if (!rays) return rays.error();
  made->rays_ = std::move(*rays);
  return std::unique_ptr<const Surfaces>(std::move(made));
}

std::optional<SurfaceHit> Surfaces::intersect(const Ray& ray) const {
  const auto hit = rays_->intersect(ray);
  if (!hit) return std::nullopt;
  const bool front = dot(hit->normal, ray.direction) < 0;
  const Vec3 x = ray.at(hit->t), normal = front ? hit->normal : -hit->normal;
  // The hit is off by some roundings of the numbers it was computed from.
  constexpr float kRoundings = 0x1p-19f;
  const float size = std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z), hit->t});
  const Material& material = materials_[hit->index];
  return SurfaceHit{hit->t, x + normal * (kRoundings * size), normal, material.albedo,
                    front || material.two_sided ? material.radiance : Color{}};
}

}  // namespace brume
