#include "renderer/march/density_sampling.h"

#include <algorithm>

#include "renderer/march/distribute.h"

namespace brume {
namespace {

/// Solves 1 - exp(-x s) = v (1 - exp(-x)) for s in thin segments, x below 0.05, where the difference would cancel.
float thin_inverse(float v, float x) {
  const float m = 1 - x * (0.5f - x * (1.0f / 6 - x * (1.0f / 24)));  // (1 - exp(-x)) / x
  const float y = v * m * x;
  return v * m * (1 + y * (0.5f + y * (1.0f / 3 + y * (0.25f + y * 0.2f))));  // -log(1 - y) / x
}

}  // namespace
DrawnSegment draw_segment(const float* cdf, int n, float u) {
  const float target = u * cdf[n];
  // Segments of no weight have cdf[i] == cdf[i + 1] and are stepped over, but for a target that was rounded up to the
  // very end.
  int i = segment_of(cdf, n, target);
  while (i > 0 && cdf[i + 1] <= cdf[i]) --i;
  return {i, std::clamp((target - cdf[i]) / (cdf[i + 1] - cdf[i]), 0.0f, 1.0f)};
}

template <int C> SampledPoint<C> DensitySampling<C>::place(DrawnSegment drawn) const {
  SampledPoint<C> sample{place_in(drawn.segment, drawn.rest), 0};
  sample.pdf_t = pdf(sample.at);
  return sample;
}

template <int C> SampledPoint<C> DensitySampling<C>::sample_in(int segment, float v, float p, float probability) const {
  SampledPoint<C> sample{place_in(segment, v), 0};
  sample.pdf_t =
      probability * (is_drawn(segment) ? scattered_at(sample.at) / p : 1 / record_.segment(segment).length());
  return sample;
}

template <int C> RayPoint<C> DensitySampling<C>::place_in(int segment, float v) const {
  return is_drawn(segment) ? exponential(segment, v) : looked_up_point(record_, segment);
}

template <int C> RayPoint<C> DensitySampling<C>::exponential(int segment, float v) const {
  const MarchRecord<C>& rec = record_;
  const auto i = static_cast<std::size_t>(segment);

  // The channel whose exponential is inverted, in proportion to its share of P_i; v is stretched to serve again.
  std::size_t channel = 0;
  if constexpr (C > 1) {
    float share[C], sum = 0;
    for (std::size_t c = 0; c < C; ++c) sum += share[c] = scattered_in(rec, segment, static_cast<int>(c));
    float rest = v * sum;
    while (channel + 1 < C && (rest >= share[channel] || share[channel] == 0)) rest -= share[channel++];
    while (channel > 0 && share[channel] == 0) --channel;
    v = std::clamp(rest / share[channel], 0.0f, 1.0f);
  }

  // Inverts the CDF (1 - exp(-sigma s)) / (1 - exp(-sigma delta)) of the distance s into the segment: the transmittance
  // at s is that share of the way from the one at the segment's begin to the one at its end.
  const float begin = rec.t[i], delta = rec.t[i + 1] - begin;
  const float sigma = rec.sigma_t[channel][i], x = sigma * delta;
  const float* transmittance = &rec.transmittance[channel][i];
  const float here = transmittance[0] - v * (transmittance[0] - transmittance[1]);
  if (x < 0.05f || !(here > 0)) {
    const float s = x < 0.05f ? delta * thin_inverse(v, x) : -std::log1p(v * std::expm1(-x)) / sigma;
    return evaluate(rec, std::clamp(begin + s, begin, rec.t[i + 1]), segment);
  }
  const float t = std::clamp(begin + std::log(transmittance[0] / here) / sigma, begin, rec.t[i + 1]);
  if constexpr (C == 1)
    return {t, segment, {rec.sigma_s[0][i]}, {here}};
  else
    return evaluate(rec, t, segment);
}

template <int C> float DensitySampling<C>::scattered_at(const RayPoint<C>& point) const {
  float sum = 0;
  for (int c = 0; c < C; ++c) sum += record_.weight[c] * point.sigma_s[c] * point.transmittance[c];
  return sum;
}

template <int C> float DensitySampling<C>::pdf(const RayPoint<C>& point) const {
  if (is_drawn(point.segment)) return scattered_at(point) / record_.scattered();
  return record_.probability(point.segment) / record_.segment(point.segment).length();
}

template class DensitySampling<1>;
template class DensitySampling<3>;

}  // namespace brume
