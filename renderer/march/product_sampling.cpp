#include "renderer/march/product_sampling.h"

#include "renderer/march/product_weights.h"
#include "renderer/march/step_loops.h"

namespace brume {
namespace {

/// Share of the samples that look to the light only. Where the medium between ray and light is dense, what the product
/// promises nearer to the camera is all shadow, and without them the noise would have no bound. Hesterberg 1995,
/// "Weighted Average Importance Sampling and Defensive Mixture Distributions".
constexpr float kDefensive = 0.01f;

}  // namespace

template <int C>
ProductSampling<C>::ProductSampling(const MarchRecord<C>& record, const float* p, const Ray& ray,
                                    const LightPivot& pivot, Interval lit, const PhaseFunction* phase, Arena& arena)
    : record_(record), p_(p), density_(record, PlaceInSegment::LookedUp), lit_(lit) {
  const PivotFoot seen = foot_of(ray, pivot.position, record.span());
  const auto foot = static_cast<float>(seen.t), off_ray = static_cast<float>(seen.distance);
  const float distance = std::hypot(off_ray, pivot.radius);
  foot_ = {foot, distance};

  const auto n = static_cast<std::size_t>(record.n);
  float* cdf = alloc_edges(record.n, arena);
  cdf_ = cdf;
  const ArenaScope scope(arena);
  float* weight = arena.alloc_span<float>(n).data();
  float* angle = arena.alloc_span<float>(n).data();
  float* cosine = arena.alloc_span<float>(n + kWidestVector).data();
  float* turned = arena.alloc_span<float>(n + kWidestVector).data();
  const ProductTerms terms{.foot = foot,
                           .off_ray = off_ray,
                           .distance = distance,
                           .height = dot(ray.origin - pivot.position, pivot.normal),
                           .slope = dot(ray.direction, pivot.normal),
                           .two_sided = pivot.two_sided,
                           .flat = pivot.normal != Vec3()};
  if (phase) {
    light_cosines(record.t, record.n, terms, cosine);
    phase->values(cosine, record.n + 1, turned);
  }
  product_weights(record.t, p, phase ? turned : nullptr, record.n, terms, weight, angle);
  // Few segments are near the light: what holds for the others is mended there.
  const float reach_of_near = PivotFoot::kNear * record.longest;
  const int first_near = distance < reach_of_near ? find_segment(record, foot - reach_of_near) : record.n;
  for (int i = first_near; i < record.n; ++i) {
    if (record.t[i] > foot + reach_of_near) break;
    if (!is_near(i) || angle[i] == 0) continue;
    const double a = record.t[i] - foot, delta = record.t[i + 1] - record.t[i], b = a + delta, d = distance;
    const auto exact = static_cast<float>(std::atan2(d * delta, d * d + a * b) / d);
    weight[i] *= exact / angle[i];
    angle[i] = exact;
  }
  for (int i = 0; i < record.n && record.t[i + 1] <= lit.begin; ++i) weight[i] = angle[i] = 0;
  for (int i = record.n - 1; i >= 0 && record.t[i] >= lit.end; --i) weight[i] = angle[i] = 0;
  const float angles = sum(angle, record.n);
  if (angles > 0) add_scaled(angle, kDefensive * sum(weight, record.n) / angles, record.n, weight);
  running_sum(weight, record.n, cdf);
}

template <int C> float ProductSampling<C>::total() const { return cdf_[record_.n] / (1 + kDefensive); }

template <int C> SampledPoint<C> ProductSampling<C>::place(DrawnSegment drawn) const {
  const int i = drawn.segment;
  const float share = probability(i);
  if (!is_near(i)) return density_.sample_in(i, drawn.rest, p_[i], share);
  const Interval part = intersect(record_.segment(i), lit_);
  const DistanceSample s = EquiangularDistribution(foot_, part).sample(drawn.rest);
  return {evaluate(record_, s.t, i), share * s.pdf_t};
}

template class ProductSampling<1>;
template class ProductSampling<3>;

}  // namespace brume
