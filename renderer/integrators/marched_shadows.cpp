#include "renderer/integrators/marched_shadows.h"

namespace brume {

template <int C>
MarchedShadows<C>::MarchedShadows(int bounce, SampleContext& context)
    : bounce_(bounce),
      context_(context),
      rays_(context.arena.alloc_span<ShadowRay>(kWaiting)),
      carried_(context.arena.alloc_span<Color>(kWaiting)),
      index_(context.arena.alloc_span<int>(kWaiting)),
      transmittances_(context.arena.alloc_span<Spectrum<C>>(kWaiting)) {}

template <int C>
void MarchedShadows<C>::add(const Light&, const Ray& shadow, Color carried, const LightNumbers& numbers, int k) {
  if (waiting_ == kWaiting) march();
  rays_[waiting_] = {shadow, numbers.shadow_offset(k)};
  carried_[waiting_] = carried;
  index_[waiting_] = numbers.index(k);
  ++waiting_;
}

template <int C> void MarchedShadows<C>::play_roulette() {
  constexpr float kFaint = 0.02f;
  float sum = 0;
  for (std::size_t i = 0; i < waiting_; ++i) sum += luminance(carried_[i]);
  const float faint = kFaint * sum / static_cast<float>(waiting_);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < waiting_; ++i) {
    const float survival = luminance(carried_[i]) / faint;
    if (survival < 1) {
      if (context_.sampler.u1(Decision::ShadowRoulette, bounce_, index_[i]) >= survival) continue;
      carried_[i] *= 1 / survival;
    }
    rays_[kept] = rays_[i], carried_[kept] = carried_[i];
    ++kept;
  }
  waiting_ = kept;
}

template <int C> void MarchedShadows<C>::march() {
  play_roulette();
  const Scene& scene = context_.scene;
  context_.statistics.shadow_rays += waiting_;
  shadow_transmittances<C>(scene.media, rays_.first(waiting_), scene.shadow_step_size, scene.render.time,
                           context_.arena, context_.statistics.march, transmittances_.first(waiting_));
  for (std::size_t i = 0; i < waiting_; ++i) sum_ += carried_[i] * to_color(transmittances_[i]);
  waiting_ = 0;
}

template <int C> Color MarchedShadows<C>::light() {
  if (waiting_ > 0) march();
  return sum_;
}

template class MarchedShadows<1>;
template class MarchedShadows<3>;

}  // namespace brume
