#include "renderer/march/shadow_march.h"

namespace brume {
namespace {

/// Integral of the density over one stretch of one medium.
double density_integral(const Medium& medium, const Interval& span, const Ray& ray, const MarchSettings& settings,
                        Arena& arena, MarchCounts& counts) {
  if (medium.traits.constant) return span.length();
  float step = settings.step;
  const int count = segment_count(span.length(), step, counts);
  counts.lookups += static_cast<std::uint64_t>(count);

  const ArenaScope scope(arena);
  const auto n = static_cast<std::size_t>(count);
  const auto x = arena.alloc_span<float>(n), y = arena.alloc_span<float>(n), z = arena.alloc_span<float>(n);
  const auto density = arena.alloc_span<float>(n);
  const float last = span.length() - static_cast<float>(count - 1) * step;  // the last segment may be shorter
  for (int i = 0; i < count; ++i) {
    const float width = i + 1 < count ? step : last;
    const float t = span.begin + static_cast<float>(i) * step + settings.offset * width;
    const auto k = static_cast<std::size_t>(i);
    x[k] = ray.origin.x + ray.direction.x * t;
    y[k] = ray.origin.y + ray.direction.y * t;
    z[k] = ray.origin.z + ray.direction.z * t;
  }
  medium.shader->density({x.data(), y.data(), z.data(), count, settings.time}, density.data());
  double sum = 0;
  for (std::size_t k = 0; k + 1 < n; ++k) sum += static_cast<double>(density[k]);
  return sum * static_cast<double>(step) + static_cast<double>(density[n - 1] * last);
}

}  // namespace

template <int C>
Spectrum<C> shadow_optical_depth(std::span<const Medium> media, const Ray& ray, const MarchSettings& settings,
                                 Arena& arena, MarchCounts& counts) {
  Spectrum<C> tau;
  for (const Medium& medium : media) {
    const ArenaScope scope(arena);
    double amount = 0;
    for (const Interval& span : medium.intervals(ray, arena))
      amount += density_integral(medium, span, ray, settings, arena, counts);
    for (int c = 0; c < C; ++c) tau[c] += medium.sigma_t[c] * static_cast<float>(amount);
  }
  return tau;
}

template Spectrum<1> shadow_optical_depth<1>(std::span<const Medium>, const Ray&, const MarchSettings&, Arena&,
                                             MarchCounts&);
template Spectrum<3> shadow_optical_depth<3>(std::span<const Medium>, const Ray&, const MarchSettings&, Arena&,
                                             MarchCounts&);

}  // namespace brume
