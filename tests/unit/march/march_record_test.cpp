#include "renderer/march/march_record.h"

#include <gtest/gtest.h>

#include "renderer/sampling/sampler.h"
#include "tests/support/media.h"

namespace brume {
namespace {

const Vec3d kLow{-1, -1, 0}, kHigh{1, 1, 4};  // from z = 0 to 4

/// A shader that remembers where it was asked.
class WitnessShader final : public Shader {
 public:
  ShaderTraits traits() const override { return {}; }
  float max_density(const Bounds3& box) const override { return static_cast<float>(box.high.z); }
  void density(const PointBatch& points, float* density) const override {
    for (int i = 0; i < points.n; ++i)
      asked.push_back({points.x[i], points.y[i], points.z[i]}), density[i] = points.z[i];
    time = points.time;
  }
  mutable std::vector<Vec3> asked;
  mutable float time = 0;
};

TEST(MarchRecord, RayThatMissesEverythingIsEmpty) {
  RecordedRay<1> beside({homogeneous_box({5, 5, 5}, {6, 6, 6}, Color(1), Color(1))}, ray_along_z(), 0.1f);
  EXPECT_TRUE(beside->empty());
  RecordedRay<1> no_medium({}, ray_along_z(), 0.1f);
  EXPECT_TRUE(no_medium->empty());
}

TEST(MarchRecord, HomogeneousMediumIsOneSegmentAndNothingIsLookedUp) {
  RecordedRay<3> r({homogeneous_box(kLow, kHigh, {1, 2, 3}, {2, 4, 8})}, ray_along_z(-1), 0.01f);
  ASSERT_EQ(r->n, 1);
  EXPECT_EQ(r->span().begin, 1);
  EXPECT_EQ(r->span().end, 5);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(r->sigma_s[static_cast<std::size_t>(c)][0], static_cast<float>(c + 1));
    EXPECT_EQ(r->sigma_t[static_cast<std::size_t>(c)][0], static_cast<float>(2 << c));
  }
  EXPECT_EQ(r.counts().lookups, 0u);
  EXPECT_EQ(r.counts().segments, 1u);
}

TEST(MarchRecord, SegmentsBeginAtMultiplesOfTheStepAndTheLastIsShorter) {
  RecordedRay<1> r({profile_box([](float) { return 1.0f; }, kLow, kHigh, Color(1), Color(1))}, ray_along_z(-1), 0.75f);
  ASSERT_EQ(r->n, 6);  // 4 / 0.75 = 5.33
  for (int i = 0; i < 6; ++i) EXPECT_EQ(r->t[i], 1 + 0.75f * static_cast<float>(i));
  EXPECT_EQ(r->t[6], 5);
  EXPECT_EQ(r.counts().lookups, 6u);
}

TEST(MarchRecord, ALengthThatIsAMultipleOfTheStepLeavesNoSliver) {
  for (const float step : {0.1f, 0.2f, 0.4f, 0.8f, 0.001f, 1.0f / 3}) {
    RecordedRay<1> r({profile_box([](float) { return 1.0f; }, kLow, kHigh, Color(1), Color(1))}, ray_along_z(-1), step);
    EXPECT_EQ(r->n, static_cast<int>(std::lround(4 / step))) << "step " << step;
  }
}

// "t must strictly grow in every marcher": edges that descend would give negative optical depths and a CDF that binary
// search cannot read.
TEST(MarchRecord, EdgesNeverDescend) {
  int longest = 0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Sampler s(SamplerKind::Independent, 2, i, 0);
    const auto number = [&](int k) { return static_cast<double>(s.u1(Decision::Pixel, k)); };
    const double begin = std::pow(10.0, 5 * number(0) - 1), thickness = std::pow(10.0, 4 * number(1) - 3);
    const float step = static_cast<float>(thickness * std::pow(10.0, -4.8 * number(2)));
    RecordedRay<1> r(
        {profile_box([](float) { return 1.0f; }, {-1, -1, begin}, {1, 1, begin + thickness}, Color(1), Color(1))},
        ray_along_z(0), step);
    longest = std::max(longest, r->n);
    for (int k = 0; k < r->n; ++k)
      ASSERT_LE(r->t[k], r->t[k + 1]) << "from " << begin << ", length " << thickness << ", step " << step << ", edge "
                                      << k << " of " << r->n;
    for (int k = 0; k < r->n; ++k) ASSERT_LE(r->cdf[k], r->cdf[k + 1]);
  }
  EXPECT_GT(longest, 30000);
}

TEST(MarchRecord, LookUpsLieAtTheOffsetOfEverySegment) {
  for (const float offset : {0.0f, 0.25f, 0.999f}) {
    const auto witness = std::make_shared<WitnessShader>();
    const Ray ray{{0.5f, -0.25f, -1}, normalize(Vec3(0.1f, 0.05f, 1)), {0, 100}};
    Arena arena;
    const ArenaScope scope(arena);
    MarchCounts counts;
    const std::vector<Medium> media{medium_of(witness, std::make_shared<BoxShape>(kLow, kHigh), Color(1), Color(1))};
    const auto r = record<1>(media, {}, ray, {0.3f, offset, 2.5f}, arena, counts);
    ASSERT_EQ(witness->asked.size(), static_cast<std::size_t>(r.n));
    EXPECT_EQ(witness->time, 2.5f);
    for (int i = 0; i < r.n; ++i) {
      const float t = r.t[i] + offset * (r.t[i + 1] - r.t[i]);
      EXPECT_NEAR(length(witness->asked[static_cast<std::size_t>(i)] - ray.at(t)), 0, 2e-6f);
      EXPECT_FLOAT_EQ(r.sigma_t[0][i], witness->asked[static_cast<std::size_t>(i)].z);  // the density it gave
    }
  }
}

TEST(MarchRecord, CoefficientsOfOverlappingMediaAddAndGapsAreEmpty) {
  // [0,2], [1,3] and [5,6]: five stretches with one empty among them.
  std::vector<Medium> media{homogeneous_box({-1, -1, 0}, {1, 1, 2}, {1, 0, 2}, {2, 0, 4}, {1, 1, 1}),
                            homogeneous_box({-1, -1, 1}, {1, 1, 3}, {0.5f, 3, 0}, {1, 3, 0}, {0, 2, 0}),
                            homogeneous_box({-1, -1, 5}, {1, 1, 6}, Color(1), Color(1))};
  RecordedRay<3> r(std::move(media), ray_along_z(-1), 0.1f);
  ASSERT_EQ(r->n, 5);
  const float edges[] = {1, 2, 3, 4, 6, 7};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(r->t[i], edges[i]);
  const Color sigma_t[] = {{2, 0, 4}, {3, 3, 4}, {1, 3, 0}, {0, 0, 0}, {1, 1, 1}};
  const Color sigma_s[] = {{1, 0, 2}, {1.5f, 3, 2}, {0.5f, 3, 0}, {0, 0, 0}, {1, 1, 1}};
  const Color emission[] = {{1, 1, 1}, {1, 3, 1}, {0, 2, 0}, {0, 0, 0}, {0, 0, 0}};
  for (int i = 0; i < 5; ++i)
    for (int c = 0; c < 3; ++c) {
      const auto k = static_cast<std::size_t>(c);
      EXPECT_EQ(r->sigma_t[k][i], sigma_t[i][c]) << i;
      EXPECT_EQ(r->sigma_s[k][i], sigma_s[i][c]) << i;
      EXPECT_EQ(r->emission[k][i], emission[i][c]) << i;
    }
  for (int m = 0; m < 3; ++m)
    for (int i = 0; i < 5; ++i) {
      const bool present = m == 0 ? i < 2 : m == 1 ? i == 1 || i == 2 : i == 4;
      EXPECT_EQ(r->medium_density[m][i], present ? 1.0f : 0.0f);
    }
}

/// From z = 0 to 1 and from 2 to 3, for rays along z.
class TwoSlabs final : public Shape {
 public:
  std::span<const Interval> intervals(const Ray& ray, Arena& arena) const override {
    const auto out = arena.alloc_span<Interval>(2);
    for (std::size_t k = 0; k < 2; ++k)
      out[k] = {2 * static_cast<float>(k) - ray.origin.z, 2 * static_cast<float>(k) + 1 - ray.origin.z};
    return out;
  }
  Bounds3 bounds() const override { return {{-1, -1, 0}, {1, 1, 3}}; }
};

// All its coefficients are multiples of the density that is recorded, in the gap, too, where it is 0.
TEST(MarchRecord, TheOnlyMediumOfARayMayHaveAGap) {
  const auto witness = std::make_shared<WitnessShader>();
  const Medium marched = medium_of(witness, std::make_shared<TwoSlabs>(), {1, 2, 3}, {2, 2, 4}, {5, 6, 7});
  const Medium beside = homogeneous_box({5, 5, 5}, {6, 6, 6}, Color(1), Color(1));
  RecordedRay<3> r({beside, marched}, ray_along_z(-1), 0.3f, 0.5f);
  ASSERT_EQ(r->n, 4 + 1 + 4);
  EXPECT_TRUE(r->has_one_albedo());
  ASSERT_EQ(witness->asked.size(), 8u);
  for (int i = 0; i < r->n; ++i) {
    const bool in_gap = i == 4;
    EXPECT_EQ(r->is_homogeneous(i), in_gap) << i;
    EXPECT_EQ(r->is_clear(i), in_gap) << i;
    const float density = in_gap ? 0 : witness->asked[static_cast<std::size_t>(i < 4 ? i : i - 1)].z;
    EXPECT_EQ(r->medium_density[0][i], 0) << i;
    EXPECT_EQ(r->medium_density[1][i], density) << i;
    for (int c = 0; c < 3; ++c) {
      const auto k = static_cast<std::size_t>(c);
      EXPECT_EQ(r->sigma_t[k][i], marched.sigma_t[c] * density) << i;
      EXPECT_EQ(r->sigma_s[k][i], marched.sigma_s[c] * density) << i;
      EXPECT_EQ(r->emission[c][i], marched.emission[c] * density) << i;
    }
  }
  EXPECT_EQ(r->cdf[4], r->cdf[5]) << "something was to be drawn in the gap";
}

TEST(MarchRecord, MarchedAndHomogeneousMediaMayOverlap) {
  std::vector<Medium> media{homogeneous_box({-1, -1, 0}, {1, 1, 4}, Color(1), Color(1)),
                            profile_box([](float z) { return z; }, {-1, -1, 1}, {1, 1, 3}, Color(2), Color(2))};
  RecordedRay<1> r(std::move(media), ray_along_z(), 0.5f, 0.5f);
  ASSERT_EQ(r->n, 6);  // one, four, one
  const float expected[] = {1, 1 + 2 * 1.25f, 1 + 2 * 1.75f, 1 + 2 * 2.25f, 1 + 2 * 2.75f, 1};
  for (int i = 0; i < 6; ++i) EXPECT_FLOAT_EQ(r->sigma_t[0][i], expected[i]);
}

TEST(MarchRecord, NothingIsRecordedBehindTheOriginOrBeyondTheSpan) {
  const Medium medium = homogeneous_box(kLow, kHigh, Color(1), Color(1));
  RecordedRay<1> from_inside({medium}, ray_along_z(3), 0.1f);
  EXPECT_EQ(from_inside->span().begin, 0);
  EXPECT_EQ(from_inside->span().end, 1);
  RecordedRay<1> on_the_face({medium}, ray_along_z(0), 0.1f);
  EXPECT_EQ(on_the_face->span().end, 4);
  RecordedRay<1> behind({medium}, ray_along_z(4), 0.1f);
  EXPECT_TRUE(behind->empty());
  RecordedRay<1> clipped({medium}, ray_along_z(-1, {2, 3.5f}), 0.1f);
  EXPECT_EQ(clipped->span().begin, 2);
  EXPECT_EQ(clipped->span().end, 3.5f);
}

TEST(MarchRecord, TooManySegmentsMakeTheStepLongerAreCountedAndEndWhereTheMediumEnds) {
  RecordedRay<1> r({profile_box([](float) { return 0.5f; }, kLow, kHigh, Color(1), Color(1))}, ray_along_z(-1), 1e-6f);
  EXPECT_EQ(r->n, kMaxSegments);
  EXPECT_EQ(r.counts().capped, 1u);
  EXPECT_EQ(r->span().end, 5);
  EXPECT_NEAR(r->tau[0][r->n], 2, 2e-6);
}

// distribute() reads whole SIMD vectors of the edges from the second one on. The sanitizer sees it when the edges are
// the last thing in their block of the arena; blocks of every size are tried for every length.
TEST(MarchRecord, DistributeReadsNothingBeyondTheArena) {
  const std::vector<Medium> media{profile_box([](float) { return 1.0f; }, kLow, kHigh, Color(1), Color(1))};
  for (int n = 1; n <= 40; ++n)
    for (std::size_t lines = 1; lines <= 24; ++lines) {
      Arena arena(64 * lines);
      const ArenaScope scope(arena);
      MarchCounts counts;
      auto r = record<1>(media, {}, ray_along_z(), {4.0f / static_cast<float>(n), 0.5f, 0}, arena, counts);
      ASSERT_EQ(r.n, n);
      distribute(r, Color(1), arena);
      ASSERT_NEAR(r.tau[0][n], 4, 1e-5);
    }
}

// B3 and O5 of the catalogue: a field of five sharp blobs, whose transmittance is too bright by known amounts when it
// is marched with few steps and one offset for all of them.
TEST(MarchRecord, BiasOfTheTransmittanceOfFiveBlobsIsThatOfTheCatalogue) {
  const auto blobs = [](float z) {
    float sum = 0.05f;
    for (const float c : {0.13f, 0.31f, 0.34f, 0.62f, 0.90f}) sum += 8 * std::exp(-std::pow((z - c) / 0.015f, 2.0f));
    return sum;
  };
  const double column = 0.05 + 8 * 5 * 0.015 * std::sqrt(3.14159265358979);  // 1.113: the blobs lie well inside
  struct Row {
    float scale;
    int steps;
    double bias, tolerance;
  };
  // The catalogue gives two digits; its 0.00 means below 0.05 %.
  for (const Row row : {Row{1, 16, 0.027, 0.0027}, Row{1, 32, 0.007, 0.0007}, Row{1, 64, 0, 5e-4},
                        Row{5, 32, 0.17, 0.017}, Row{5, 64, 0, 5e-4}}) {
    double sum = 0;
    constexpr int kOffsets = 2000;
    for (int k = 0; k < kOffsets; ++k) {
      RecordedRay<1> r({profile_box(blobs, {-1, -1, 0}, {1, 1, 1}, Color(0), Color(row.scale))}, ray_along_z(),
                       1.0f / static_cast<float>(row.steps), (static_cast<float>(k) + 0.5f) / kOffsets);
      sum += static_cast<double>(transmittance(*r)[0]);
    }
    const double bias = sum / kOffsets / std::exp(-column * static_cast<double>(row.scale)) - 1;
    EXPECT_NEAR(bias, row.bias, row.tolerance)
        << "optical depth " << column * static_cast<double>(row.scale) << ", " << row.steps << " steps";
  }
}

}  // namespace
}  // namespace brume
