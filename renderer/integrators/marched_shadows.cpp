#include "renderer/integrators/marched_shadows.h"

#include <cmath>

namespace brume {

template <int C>
MarchedShadows<C>::MarchedShadows(int bounce, SampleContext& context)
    : bounce_(bounce),
      context_(context),
      rays_(kWaiting, context.arena),
      carried_(context.arena.alloc_span<Color>(kWaiting)),
      index_(context.arena.alloc_span<int>(kWaiting)),
      transmittances_(context.arena.alloc_span<Spectrum<C>>(kWaiting)) {}

template <int C>
void MarchedShadows<C>::add(const Light&, const Ray& shadow, Color carried, const ShadowNumbers& numbers) {
  if (rays_.n == kWaiting) march();
  carried_[static_cast<std::size_t>(rays_.n)] = carried;
  index_[static_cast<std::size_t>(rays_.n)] = numbers.index;
  rays_.add(shadow, numbers.offset);
  const float most = luminance(carried);
  carried_sum_ += most, carried_least_ = std::min(carried_least_, most);
}

template <int C> void MarchedShadows<C>::play_roulette() {
  constexpr float kFaint = 0.02f;
  const int waiting = rays_.n;
  const float faint = kFaint * carried_sum_ / static_cast<float>(waiting);
  if (carried_least_ >= faint || !std::isfinite(faint)) return;
  rays_.n = 0;
  for (int i = 0; i < waiting; ++i) {
    Color carried = carried_[static_cast<std::size_t>(i)];
    const float survival = luminance(carried) / faint;
    if (survival < 1) {
      const int index = index_[static_cast<std::size_t>(i)];
      if (context_.sampler.u1(Decision::ShadowRoulette, bounce_, index) >= survival) continue;
      carried *= 1 / survival;
    }
    carried_[static_cast<std::size_t>(rays_.n)] = carried;
    if (rays_.n == i)
      ++rays_.n;
    else
      rays_.add(rays_[i], rays_.offset[i]);
  }
}

template <int C> void MarchedShadows<C>::march() {
  const Scene& scene = context_.scene;
  if (scene.render.russian_roulette) play_roulette();
  context_.statistics.shadow_rays += static_cast<std::uint64_t>(rays_.n);
  shadow_transmittances<C>(scene.media, rays_, scene.shadow_step_size, scene.render.time, context_.arena,
                           context_.statistics.march, transmittances_.data());
  for (int i = 0; i < rays_.n; ++i)
    sum_ += carried_[static_cast<std::size_t>(i)] * to_color(transmittances_[static_cast<std::size_t>(i)]);
  rays_.n = 0;
  carried_sum_ = 0, carried_least_ = kInfinity;
}

template <int C> Color MarchedShadows<C>::light() {
  if (rays_.n > 0) march();
  return sum_;
}

template class MarchedShadows<1>;
template class MarchedShadows<3>;

}  // namespace brume
