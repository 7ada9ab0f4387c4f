#include "renderer/integrators/ray_march_cached.h"

#include "renderer/integrators/registry.h"

namespace brume {

RayMarchCachedIntegrator::RayMarchCachedIntegrator(const Scene& scene) {
  for (const auto& light : scene.lights) maps_.push_back(DeepShadowMap::make(scene, *light));
}

Color RayMarchCachedIntegrator::shadow(const Light& light, const Ray& ray, int bounce, int index,
                                       SampleContext& context) const {
  const auto& lights = context.scene.lights;
  for (std::size_t l = 0; l < lights.size(); ++l)
    if (lights[l].get() == &light && maps_[l]) return maps_[l]->transmittance(ray.origin);
  return RayMarchIntegrator::shadow(light, ray, bounce, index, context);
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
