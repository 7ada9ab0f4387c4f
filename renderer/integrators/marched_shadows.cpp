#include "renderer/integrators/marched_shadows.h"

namespace brume {

template <int C>
MarchedShadows<C>::MarchedShadows(SampleContext& context)
    : context_(context),
      rays_(context.arena.alloc_span<ShadowRay>(kWaiting)),
      carried_(context.arena.alloc_span<Color>(kWaiting)),
      transmittances_(context.arena.alloc_span<Spectrum<C>>(kWaiting)) {}

template <int C>
void MarchedShadows<C>::add(const Light&, const Ray& shadow, Color carried, const LightNumbers& numbers, int k) {
  if (waiting_ == kWaiting) march();
  rays_[waiting_] = {shadow, numbers.shadow_offset(k)};
  carried_[waiting_] = carried;
  ++waiting_;
}

template <int C> void MarchedShadows<C>::march() {
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
