#include "renderer/engine/survey.h"

#include <cmath>
#include <cstdio>

#include "renderer/march/shadow_march.h"
#include "renderer/sampling/sampler.h"

namespace brume {

std::vector<float> optical_depths(const Scene& scene, int columns, int rows) {
  std::vector<float> depths;
  Arena arena;
  MarchCounts counts;
  const float aspect = static_cast<float>(scene.film.width) / static_cast<float>(scene.film.height);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      Ray ray = scene.camera.ray((static_cast<float>(x) + 0.5f) / static_cast<float>(columns),
                                 (static_cast<float>(y) + 0.5f) / static_cast<float>(rows), aspect);
      if (scene.surfaces)
        if (const auto surface = scene.surfaces->intersect(ray)) ray.span.end = surface->t;
      const ArenaScope scope(arena);
      const auto tau =
          shadow_optical_depth<3>(scene.media, ray, {scene.step_size, 0.5f, scene.render.time}, arena, counts);
      depths.push_back((tau[0] + tau[1] + tau[2]) / 3);
    }
  return depths;
}

bool light_arrives(const Scene& scene) {
  if (!scene.surfaces || scene.bounds.empty()) return true;
  constexpr int kPlaces = 256;
  for (std::uint32_t i = 0; i < kPlaces; ++i) {
    const Sampler sampler(SamplerKind::Sobol, 1, 0, i);
    const Vec2 u = sampler.u2(Decision::Pixel);
    const Vec3d part(double(u.x), double(u.y), double(sampler.u1(Decision::MarchOffset)));
    const Vec3d extent = scene.bounds.extent();
    const Vec3 x(scene.bounds.low + Vec3d(extent.x * part.x, extent.y * part.y, extent.z * part.z));
    for (const auto& light : scene.lights) {
      const LightPoint point = light->sample_point(sampler.u2(Decision::LightPoint));
      if (point.kind == LightPoint::Kind::Environment) return true;  // comes from everywhere
      const IncidentLight in = light->incident(point, x);
      if (!is_black(in.irradiance) && !scene.surfaces->occluded({x, in.wi, {0, in.distance * kJustBefore}}))
        return true;
    }
  }
  return false;
}

double two_digits(double v) {
  if (!(v > 0)) return v;
  const double unit = std::pow(10.0, std::floor(std::log10(v)) - 1);
  return std::round(v / unit) * unit;
}

std::string short_number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, v >= 1000 && v < 1e9 ? "%.0f" : "%.3g", v);
  return text;
}

}  // namespace brume
