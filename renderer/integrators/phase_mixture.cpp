#include "renderer/integrators/phase_mixture.h"

namespace brume {

template <int C>
PhaseMixture<C>::PhaseMixture(const Scene& scene, Vec3 direction, const MarchRecord<C>& record, int segment,
                              Arena& arena)
    : scene_(scene), direction_(direction) {
  if (!record.medium_density) return;
  const auto densities = arena.alloc_span<float>(scene.media.size());
  for (std::size_t m = 0; m < densities.size(); ++m) densities[m] = record.medium_density[m][segment];
  densities_ = densities;
}

template <int C> float PhaseMixture<C>::share(std::size_t m) const {
  float sum = 0;
  for (int c = 0; c < C; ++c) sum += share(m, c);
  return sum;
}

template <int C> Spectrum<C> PhaseMixture<C>::value(Vec3 wi) const {
  const float cos_theta = dot(direction_, wi);
  if (single()) return filled<C>(scene_.phases[0]->value(cos_theta));
  Spectrum<C> result, sum;
  for (std::size_t m = 0; m < densities_.size(); ++m) {
    if (densities_[m] == 0) continue;
    const float p = scene_.phases[m]->value(cos_theta);
    for (int c = 0; c < C; ++c) result[c] += share(m, c) * p, sum[c] += share(m, c);
  }
  for (int c = 0; c < C; ++c) result[c] = sum[c] > 0 ? result[c] / sum[c] : 0;
  return result;
}

template <int C> float PhaseMixture<C>::pdf_w(Vec3 wi) const {
  const float cos_theta = dot(direction_, wi);
  if (single()) return scene_.phases[0]->value(cos_theta);
  float sum = 0, total = 0;
  for (std::size_t m = 0; m < densities_.size(); ++m) {
    const float here = share(m);
    if (here == 0) continue;
    sum += here * scene_.phases[m]->value(cos_theta);
    total += here;
  }
  return total > 0 ? sum / total : 0;
}

template <int C> Spectrum<C> PhaseMixture<C>::weight(Vec3 wi) const {
  if (single()) return filled<C>(1);
  Spectrum<C> result = value(wi);
  const float pdf = pdf_w(wi);
  for (float& v : result.v) v = pdf > 0 ? v / pdf : 0;
  return result;
}

template <int C> Vec3 PhaseMixture<C>::sample(float u_lobe, Vec2 u) const {
  std::size_t chosen = 0;
  if (!single()) {
    float total = 0;
    for (std::size_t m = 0; m < densities_.size(); ++m) total += share(m);
    float rest = u_lobe * total;
    for (std::size_t m = 0; m < densities_.size(); ++m) {
      if (share(m) == 0) continue;
      chosen = m;  // the last one that scatters, where rounding leaves a rest
      if (rest < share(m)) break;
      rest -= share(m);
    }
  }
  return scene_.phases[chosen]->sample(direction_, u).direction;
}

template class PhaseMixture<1>;
template class PhaseMixture<3>;

}  // namespace brume
