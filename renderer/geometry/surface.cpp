#include "renderer/geometry/surface.h"

#include <algorithm>

#include "renderer/geometry/ray_scene.h"
#include "renderer/geometry/sphere_roots.h"
#include "renderer/sampling/warps.h"

namespace brume {
namespace {

bool contains(Interval span, double t) {
  return t > static_cast<double>(span.begin) && t < static_cast<double>(span.end);
}

}  // namespace

std::optional<SurfaceCrossing> SphereSurface::intersect(const Ray& ray) const {
  const auto roots = sphere_roots(center_, radius_, ray);
  if (!roots) return std::nullopt;
  for (const double t : {roots->enter, roots->leave})
    if (contains(ray.span, t))
      return SurfaceCrossing{static_cast<float>(t),
                             Vec3(normalize(Vec3d(ray.origin) + Vec3d(ray.direction) * t - center_))};
  return std::nullopt;
}

namespace {

class SphereSampling final : public SurfaceSampling {
 public:
  SphereSampling(Vec3 center, float radius) : center_(center), radius_(radius) {}
  Point sample(Vec2 u) const override {
    const Vec3 n = uniform_sphere(u);
    return {center_ + n * radius_, n};
  }
  double area() const override { return 4 * double(kPi) * double(radius_) * double(radius_); }

 private:
  Vec3 center_;
  float radius_;
};

}  // namespace

std::unique_ptr<const SurfaceSampling> SphereSurface::sampling() const {
  return std::make_unique<SphereSampling>(Vec3(center_), static_cast<float>(radius_));
}

std::optional<SurfaceCrossing> PlaneSurface::intersect(const Ray& ray) const {
  const double slope = dot(Vec3d(ray.direction), normal_);
  if (slope == 0) return std::nullopt;
  const double t = dot(point_ - Vec3d(ray.origin), normal_) / slope;
  if (!contains(ray.span, t)) return std::nullopt;
  return SurfaceCrossing{static_cast<float>(t), Vec3(normal_)};
}

Bounds3 PlaneSurface::bounds() const {
  const Vec3d far(1e12);  // Embree takes no infinite box
  return {point_ - far, point_ + far};
}

MeshSurface::MeshSurface(std::shared_ptr<const Mesh> mesh, const Affined& scene_from_mesh)
    : mesh_(std::move(mesh)),
      scene_from_mesh_(scene_from_mesh),
      mesh_from_scene_(inverse(scene_from_mesh)->cast<float>()),
      bounds_(transform_bounds(scene_from_mesh, mesh_->triangles.bounds())) {}

/// Carries the ray into the mesh's space, where its direction is not unit: t keeps its meaning.
Ray MeshSurface::in_mesh(const Ray& ray) const {
  return {mesh_from_scene_.point(ray.origin), mesh_from_scene_.vector(ray.direction), ray.span};
}

std::optional<SurfaceCrossing> MeshSurface::intersect(const Ray& ray) const {
  const auto hit = mesh_->rays->intersect(in_mesh(ray));
  if (!hit) return std::nullopt;
  // Normals go by the transposed inverse.
  const Affine& m = mesh_from_scene_;
  return SurfaceCrossing{hit->t,
                         normalize(m.row[0] * hit->normal.x + m.row[1] * hit->normal.y + m.row[2] * hit->normal.z)};
}

namespace {

/// A triangle in proportion to its area, then a point of it.
class MeshSampling final : public SurfaceSampling {
 public:
  MeshSampling(const TriangleMesh& mesh, const Affined& scene_from_mesh) {
    // A mirror turns triangles round; their normals go by the transposed inverse and do not.
    const double side = scene_from_mesh.determinant() < 0 ? -1 : 1;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto [a, b, c] = mesh.corners(i);
      const Vec3d p = scene_from_mesh.point(Vec3d(a));
      const Vec3d u = scene_from_mesh.point(Vec3d(b)) - p, v = scene_from_mesh.point(Vec3d(c)) - p;
      const Vec3d n = cross(u, v) * side;
      const double twice = length(n);
      if (!(twice > 0)) continue;
      area_ += twice / 2;
      triangles_.push_back({Vec3(p), Vec3(u), Vec3(v), Vec3(n / twice)});
      up_to_.push_back(area_);
    }
  }
  Point sample(Vec2 u) const override {
    const double aim = static_cast<double>(u.x) * area_;
    const auto last = static_cast<std::ptrdiff_t>(up_to_.size()) - 1;
    const auto i =
        static_cast<std::size_t>(std::min(std::upper_bound(up_to_.begin(), up_to_.end(), aim) - up_to_.begin(), last));
    // What is left of u.x is uniform in the triangle, with the fewer bits the more triangles there are.
    const double before = i > 0 ? up_to_[i - 1] : 0;
    const float rest = std::clamp(static_cast<float>((aim - before) / (up_to_[i] - before)), 0.0f, 1.0f);
    const float s = std::sqrt(rest), x = s * (1 - u.y), y = s * u.y;
    const Triangle& t = triangles_[i];
    return {t.corner + t.u * x + t.v * y, t.normal};
  }
  double area() const override { return area_; }

 private:
  struct Triangle {
    Vec3 corner, u, v, normal;
  };
  std::vector<Triangle> triangles_;
  std::vector<double> up_to_;  // areas summed
  double area_ = 0;
};

}  // namespace

std::unique_ptr<const SurfaceSampling> MeshSurface::sampling() const {
  auto sampling = std::make_unique<MeshSampling>(mesh_->triangles, scene_from_mesh_);
  return sampling->area() > 0 ? std::move(sampling) : nullptr;
}

bool MeshSurface::occluded(const Ray& ray) const { return mesh_->rays->occluded(in_mesh(ray)); }

}  // namespace brume
