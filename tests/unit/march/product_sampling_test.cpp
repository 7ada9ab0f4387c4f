#include "renderer/march/product_sampling.h"

#include <gtest/gtest.h>

#include "renderer/lights/quad_light.h"
#include "renderer/phase/henyey_greenstein.h"
#include "renderer/sampling/sampler.h"
#include "tests/support/media.h"
#include "tests/support/simd_levels.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

const Vec3d kLow{-1, -1, 0}, kHigh{1, 1, 4};
constexpr Interval kAll{0, std::numeric_limits<float>::infinity()};

float number(std::uint32_t i) { return Sampler(SamplerKind::Independent, 4, 6, i).u1(Decision::DensityDistance); }

std::vector<Medium> cloud(Color sigma_t = Color(0.7f)) {
  return {profile_box([](float z) { return z > 1 && z < 1.5f ? 0.0f : 0.2f + z; }, kLow, kHigh, Color(0.5f), sigma_t)};
}

LightPivot lamp(Vec3 position, float radius = 0) { return {.position = position, .radius = radius}; }

/// Samples against the function they are to be drawn from: the integral of any g is the mean of g over the density.
template <int C>
void expect_a_density(const RecordedRay<C>& r, const Ray& ray, const LightPivot& pivot, Interval lit,
                      const PhaseFunction* phase, const char* what) {
  Arena arena;
  const ArenaScope scope(arena);
  const float* const p = scattered_by_segment(*r, arena);
  const ProductSampling<C> product(*r, p, ray, pivot, lit, phase, arena);
  ASSERT_GT(product.total(), 0) << what;
  const Interval span = intersect(r->span(), lit);
  RunningMean length, moment;
  double shaded = 0;
  constexpr std::uint32_t kN = 200000;
  for (std::uint32_t i = 0; i < kN; ++i) {
    const auto [at, pdf] = product.sample(number(i));
    ASSERT_TRUE(at.t >= r->span().begin && at.t <= r->span().end) << what;
    ASSERT_GT(pdf, 0) << what;
    // Only segments that scatter are drawn: what the integral over the rest would give is left out on both sides.
    length.add(1 / double(pdf));
    moment.add(double(at.t) / double(pdf));
  }
  double expected_length = 0, expected_moment = 0;
  for (int i = 0; i < r->n; ++i) {
    if (!(p[i] > 0)) continue;
    const bool touched = r->t[i] < lit.end && r->t[i + 1] > lit.begin;
    if (!touched) continue;
    const double a = double(r->t[i]), b = double(r->t[i + 1]);
    expected_length += b - a, expected_moment += 0.5 * (b * b - a * a);
    shaded += std::max(0.0, double(span.begin) - a) + std::max(0.0, b - double(span.end));
  }
  // Inside a segment that the lit part ends in, samples near the light keep to the lit part, others need not.
  EXPECT_NEAR(length.mean(), expected_length, 5 * length.standard_error() + shaded) << what;
  EXPECT_NEAR(moment.mean(), expected_moment, 5 * moment.standard_error() + shaded * double(r->span().end)) << what;
}

class ProductSamplingAt : public AtSimdLevel {};

TEST_P(ProductSamplingAt, SamplesAreDrawnWithTheDensityTheyReport) {
  const Ray ray = ray_along_z(-1);
  const HenyeyGreenstein forward(0.7);
  RecordedRay<1> grey(cloud(), ray, 0.07f);
  RecordedRay<3> coloured(cloud({0.3f, 1, 4}), ray, 0.07f);
  expect_a_density(grey, ray, lamp({3, 0, 2}), kAll, &forward, "a lamp outside");
  expect_a_density(grey, ray, lamp({0.02f, 0, 2}), kAll, nullptr, "a lamp next to the ray");
  expect_a_density(grey, ray, lamp({0.02f, 0, 2}, 0.3f), kAll, &forward, "a large lamp");
  expect_a_density(coloured, ray, lamp({0.3f, 0, 2}), kAll, &forward, "three channels");
  expect_a_density(grey, ray, lamp({0.3f, 0, 2}), {2, 3.1f}, nullptr, "a cone");
}

INSTANTIATE_TEST_SUITE_P(Levels, ProductSamplingAt, testing::ValuesIn(simd_levels()), simd_level_name);

TEST(ProductSampling, TheTotalIsTheUnshadowedLightOfTheRay) {
  // In thin segments far from the light the midpoint rule has an error of second order only.
  const std::vector<Medium> media = cloud();
  const Ray ray = ray_along_z(-1);
  const Vec3 position{1.5f, 0.5f, 2.5f};
  RecordedRay<1> r(media, ray, 0.01f);
  Arena arena;
  const ArenaScope scope(arena);
  const float* const p = scattered_by_segment(*r, arena);
  const HenyeyGreenstein phase(0.4);
  const auto expect_total = [&](const LightPivot& pivot, const std::function<double(double)>& factor,
                                Interval lit = kAll) {
    const ProductSampling<1> product(*r, p, ray, pivot, lit, &phase, arena);
    double expected = 0;
    for (int i = 0; i < r->n; ++i) {
      if (r->t[i + 1] <= lit.begin || r->t[i] >= lit.end) continue;
      const double t = 0.5 * (double(r->t[i]) + double(r->t[i + 1]));
      const Vec3 x = ray.at(static_cast<float>(t)), to_light = pivot.position - x;
      const double r2 = double(length_squared(to_light)), cosine = double(dot(ray.direction, to_light)) / std::sqrt(r2);
      expected += double(p[i]) / r2 * double(phase.value(static_cast<float>(cosine))) * factor(t);
    }
    EXPECT_NEAR(product.total() / expected, 1, 1e-4);
  };
  expect_total(lamp(position), [](double) { return 1.0; });
  expect_total(lamp(position), [](double) { return 1.0; }, {4.2f, 4.6f});  // far from the foot: what is not lit is more
  LightPivot flat = lamp(position);
  flat.normal = {-1, 0, 0};
  expect_total(flat, [&](double t) {
    const Vec3 from_light = ray.at(static_cast<float>(t)) - position;
    return double(dot(from_light, flat.normal) / length(from_light));
  });
}

// A segment that a flat light's plane cuts is lit in part: however little, it must be drawn.
TEST(ProductSampling, EverySegmentThatIsLitInPartCanBeDrawn) {
  const Ray ray{{0, 0, -1}, normalize(Vec3(0.001f, 0, 1))};
  RecordedRay<1> r({homogeneous_box(kLow, kHigh, Color(0.5f), Color(0.7f))}, ray, 0.5f);
  ASSERT_EQ(r->n, 1);
  Arena arena;
  const ArenaScope scope(arena);
  const float* const p = scattered_by_segment(*r, arena);
  for (const float z : {0.1f, 1.0f, 3.9f}) {
    LightPivot flat = lamp({0.5f, 0.5f, z});
    flat.normal = {0, 0, 1};
    const ProductSampling<1> product(*r, p, ray, flat, {z + 1, 100}, nullptr, arena);
    EXPECT_GT(product.total(), 0) << z;
    flat.normal = {0, 0, -1};
    const ProductSampling<1> below(*r, p, ray, flat, {0, z + 1}, nullptr, arena);
    EXPECT_GT(below.total(), 0) << z;
  }
}

// Nearly all samples are drawn at the lamp, too few elsewhere to measure a mean with; but they have a density.
TEST(ProductSampling, ALampOnTheRayGivesFiniteSamples) {
  const Ray ray = ray_along_z(-1);
  RecordedRay<1> r(cloud(), ray, 0.07f);
  Arena arena;
  const ArenaScope scope(arena);
  const ProductSampling<1> product(*r, scattered_by_segment(*r, arena), ray, lamp({0, 0, 2}), kAll, nullptr, arena);
  for (std::uint32_t i = 0; i < 10000; ++i) {
    const auto [at, pdf] = product.sample(number(i));
    ASSERT_TRUE(std::isfinite(at.t) && pdf > 0 && std::isfinite(pdf));
  }
}

TEST(ProductSampling, NothingIsDrawnWhereNoLightComes) {
  const Ray ray = ray_along_z(-1);
  RecordedRay<1> r(cloud(), ray, 0.1f);
  Arena arena;
  const ArenaScope scope(arena);
  const ProductSampling<1> dark(*r, scattered_by_segment(*r, arena), ray, lamp({3, 0, 2}), {100, 200}, nullptr, arena);
  EXPECT_EQ(dark.total(), 0);
}

}  // namespace
}  // namespace brume
