#include "renderer/integrators/path.h"

namespace brume {

float roulette(Color beta, int bounce, const SampleContext& context) {
  constexpr int kFirstBounce = 3;
  constexpr float kLeastSurvival = 0.05f;
  if (!context.scene.render.russian_roulette || bounce < kFirstBounce) return 1;
  const float survival = std::clamp(max_channel(beta), kLeastSurvival, 1.0f);
  return context.sampler.u1(Decision::Roulette, bounce) < survival ? 1 / survival : 0;
}

}  // namespace brume
