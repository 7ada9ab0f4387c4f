#include "renderer/integrators/ray_march_cached.h"

#include "renderer/integrators/registry.h"

namespace brume {

RayMarchCachedIntegrator::RayMarchCachedIntegrator(const Scene& scene) {
  for (const auto& light : scene.lights) maps_.push_back(DeepShadowMap::make(scene, *light));
}

double RayMarchCachedIntegrator::preparation_seconds() const {
  double seconds = 0;
  for (const auto& map : maps_) seconds += map ? map->cpu_seconds() : 0;
  return seconds;
}

const DeepShadowMap* RayMarchCachedIntegrator::shadow_map(const Scene& scene, const Light& light) const {
  for (std::size_t l = 0; l < maps_.size(); ++l)
    if (scene.lights[l].get() == &light) return maps_[l].get();
  return nullptr;
}

IntegratorType ray_march_cached_integrator_type() {
  return {integrator_table("ray_march_cached", "Ray-marching, deep shadow maps",
                           "Ray-marching with cached transmittance to point, spot and parallel lights (Lokovic 2000).",
                           {light_params(), march_params(), shadow_map_params(), path_params(), random_params()}),
          [](const Scene& scene) -> std::unique_ptr<const Integrator> {
            return std::make_unique<RayMarchCachedIntegrator>(scene);
          }};
}

}  // namespace brume
