#include "renderer/march/density_sampling.h"

#include <algorithm>

namespace brume {

template <int C> int find_segment(const MarchRecord<C>& rec, float t) {
  const float* above = std::upper_bound(rec.t, rec.t + rec.n + 1, t);
  return std::clamp(static_cast<int>(above - rec.t) - 1, 0, rec.n - 1);
}

template <int C> RayPoint<C> evaluate(const MarchRecord<C>& rec, float t, int segment) {
  RayPoint<C> point{t, segment, {}, {}};
  const auto i = static_cast<std::size_t>(segment);
  for (std::size_t c = 0; c < C; ++c) {
    point.sigma_s.v[c] = rec.sigma_s[c][i];
    point.transmittance.v[c] = std::exp(-(rec.tau[c][i] + rec.sigma_t[c][i] * (t - rec.t[i])));
  }
  return point;
}

template <int C> DistanceSample DensitySampling<C>::sample(float u) const {
  const MarchRecord<C>& rec = record_;
  const float target = u * rec.scattered();
  // upper_bound steps over segments that scatter nothing: they have cdf[i] == cdf[i + 1].
  const float* above = std::upper_bound(rec.cdf, rec.cdf + rec.n + 1, target);
  auto i = static_cast<std::size_t>(std::clamp(static_cast<int>(above - rec.cdf) - 1, 0, rec.n - 1));
  while (i > 0 && rec.cdf[i + 1] <= rec.cdf[i]) --i;  // target rounded up to the very end
  const float p = rec.cdf[i + 1] - rec.cdf[i];
  float v = std::clamp((target - rec.cdf[i]) / p, 0.0f, 1.0f);

  // The channel whose exponential is inverted, in proportion to its share of P_i; v is stretched to serve again.
  std::size_t channel = 0;
  if constexpr (C > 1) {
    float share[C], sum = 0;
    for (std::size_t c = 0; c < C; ++c) sum += share[c] = rec.weight.v[c] * rec.sigma_s[c][i] * rec.length[c][i];
    float rest = v * sum;
    while (channel + 1 < C && (rest >= share[channel] || share[channel] == 0)) rest -= share[channel++];
    while (channel > 0 && share[channel] == 0) --channel;
    v = std::clamp(rest / share[channel], 0.0f, 1.0f);
  }

  // Inverts the CDF (1 - exp(-sigma s)) / (1 - exp(-sigma delta)) of the distance s into the segment.
  const float begin = rec.t[i], delta = rec.t[i + 1] - begin;
  const float sigma = rec.sigma_t[channel][i], x = sigma * delta;
  const float s = x > 1e-4f ? -std::log1p(v * std::expm1(-x)) / sigma
                            : delta * v * (1 - 0.5f * x * (1 - v));  // first order in x: below 1e-4 exact in float
  const float t = std::clamp(begin + s, begin, rec.t[i + 1]);
  return {t, pdf(evaluate(rec, t, static_cast<int>(i)))};
}

template <int C> float DensitySampling<C>::pdf(const RayPoint<C>& point) const {
  float sum = 0;
  for (int c = 0; c < C; ++c) sum += record_.weight[c] * point.sigma_s[c] * point.transmittance[c];
  return sum / record_.scattered();
}

template int find_segment<1>(const MarchRecord<1>&, float);
template int find_segment<3>(const MarchRecord<3>&, float);
template RayPoint<1> evaluate<1>(const MarchRecord<1>&, float, int);
template RayPoint<3> evaluate<3>(const MarchRecord<3>&, float, int);
template class DensitySampling<1>;
template class DensitySampling<3>;

}  // namespace brume
