#pragma once

#include "renderer/integrators/ray_march.h"

namespace brume {

/// Ray-marching with the transmittance towards each light looked up in a map that is made before rendering.
/// Lokovic & Veach 2000, "Deep Shadow Maps". Maps exist for lights that can be projected: point, spot and parallel
/// directional; towards the others it marches. Biased by the maps' resolution, which steps and samples cannot mend.
class RayMarchCachedIntegrator final : public RayMarchIntegrator {
 public:
  explicit RayMarchCachedIntegrator(const Scene& scene);
  double preparation_seconds() const override;

 protected:
  const DeepShadowMap* shadow_map(const Scene& scene, const Light& light) const override;

 private:
  std::vector<std::unique_ptr<const DeepShadowMap>> maps_;  // of the scene's lights, in their order; null: none
};

}  // namespace brume
