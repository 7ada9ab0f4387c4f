#include "renderer/march/density_sampling.h"

#include <gtest/gtest.h>

#include "renderer/sampling/sampler.h"
#include "tests/support/media.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

const Vec3d kLow{-1, -1, 0}, kHigh{1, 1, 4};

float random_number(std::uint32_t i) {
  return Sampler(SamplerKind::Independent, 8, 2, i).u1(Decision::DensityDistance);
}

template <int C> double pdf_at(const DensitySampling<C>& sampling, const MarchRecord<C>& rec, double t) {
  return double(sampling.pdf(evaluate(rec, static_cast<float>(t))));
}

/// Integral of the reported density over [a, b], split at the edges of the record where it jumps.
template <int C> double integral(const DensitySampling<C>& sampling, const MarchRecord<C>& rec, double a, double b) {
  double sum = 0;
  for (int i = 0; i < rec.n; ++i) {
    const double low = std::max(a, double(rec.t[i])), high = std::min(b, double(rec.t[i + 1]));
    // Inside one segment: the point of evaluation must not slip into the next by rounding.
    if (low >= high) continue;
    double tau = 0;
    for (const Coefficient& sigma_t : rec.sigma_t) tau = std::max(tau, double(sigma_t[i]) * (high - low));
    const int panels = 20 + static_cast<int>(tau);  // a mean free path each
    sum += integrate([&](double t) { return double(sampling.pdf(evaluate(rec, static_cast<float>(t), i))); }, low, high,
                     panels);
  }
  return sum;
}

/// Chi-square of samples against the reported density, over cells of equal width; and what every sampler promises.
template <int C> void expect_samples_follow_the_density(const MarchRecord<C>& rec, const char* what) {
  const DensitySampling<C> sampling(rec, PlaceInSegment::Drawn);
  constexpr int kBins = 64, kN = 100000;
  const double begin = double(rec.span().begin), width = double(rec.span().length()) / kBins;
  std::vector<double> observed(kBins), expected;
  for (int b = 0; b < kBins; ++b)
    expected.push_back(kN * integral(sampling, rec, begin + b * width, begin + (b + 1) * width));
  double total = 0;
  for (const double e : expected) total += e;
  // The nodes of the quadrature are rounded to floats, which an extinction of 3000 feels.
  double rounding = 0;
  for (const Coefficient& sigma_t : rec.sigma_t) rounding = std::max(rounding, double(sigma_t[0]) * 0x1p-24 * begin);
  EXPECT_NEAR(total / kN, 1, 2e-5 + rounding) << what << ": the density does not integrate to 1";
  // Density 0 may show 1e-12 of a count from the quadrature.
  for (double& e : expected) e = e < 1e-6 ? 0 : e;
  for (std::uint32_t i = 0; i < kN; ++i) {
    const auto [s, drawn_pdf] = sampling.sample(random_number(i));
    ASSERT_TRUE(s.t >= rec.span().begin && s.t <= rec.span().end) << what;
    const double pdf = double(sampling.pdf(s));
    ASSERT_GT(pdf, 0) << what;
    ASSERT_NEAR(double(drawn_pdf) / pdf, 1, 1e-6) << what;
    if (i % 100 == 0) {
      // Where t is the edge of a segment, evaluate() may take it for the next one's; both are limits of the density.
      const int segment = find_segment(rec, s.t);
      // The sample knows its transmittance better than its distance, which is rounded to a float.
      const double here = double(sampling.pdf(evaluate(rec, s.t, segment))),
                   before = double(sampling.pdf(evaluate(rec, s.t, std::max(0, segment - 1))));
      EXPECT_LT(std::min(std::abs(pdf / here - 1), std::abs(pdf / before - 1)), rounding + 1e-6) << what;
    }
    ++observed[static_cast<std::size_t>(std::clamp(static_cast<int>((double(s.t) - begin) / width), 0, kBins - 1))];
  }
  EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance) << what;
}

/// Where segments vary: chosen with the probability P_i, and then at the place where they were looked up.
template <int C> void expect_segments_follow_their_weights(const MarchRecord<C>& rec, const char* what) {
  const DensitySampling<C> sampling(rec, PlaceInSegment::LookedUp);
  constexpr int kN = 100000;
  std::vector<double> observed(static_cast<std::size_t>(rec.n)), expected;
  for (int i = 0; i < rec.n; ++i) {
    double p = 0;
    for (int c = 0; c < C; ++c) p += double(scattered_in(rec, i, c));
    expected.push_back(kN * p / double(rec.scattered()));
  }
  for (std::uint32_t i = 0; i < kN; ++i) {
    const auto [s, pdf] = sampling.sample(random_number(i));
    const auto drawn = static_cast<std::size_t>(s.segment);
    const float delta = rec.t[drawn + 1] - rec.t[drawn];
    ASSERT_NEAR(s.t, rec.t[drawn] + rec.offset * delta, 1e-6f) << what;
    // What is drawn are steps of the CDF, which is off by a few roundings of its end.
    ASSERT_NEAR(double(pdf * delta), expected[drawn] / kN, 3e-7) << what;
    ASSERT_NEAR(sampling.pdf(s) / pdf, 1, 1e-6) << what;
    ++observed[drawn];
  }
  EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance) << what;
}

TEST(DensitySampling, SegmentsThatVaryAreChosenByTheirWeightAndSampledWhereTheyWereLookedUp) {
  const auto rough = [](float z) { return 0.2f + std::abs(std::sin(3 * z)); };
  for (const float offset : {0.0f, 0.3f, 0.99f}) {
    RecordedRay<1> grey({profile_box(rough, kLow, kHigh, Color(0.5f), Color(0.7f))}, ray_along_z(-1), 0.1f, offset);
    expect_segments_follow_their_weights(*grey, "grey");
    RecordedRay<3> coloured({profile_box(rough, kLow, kHigh, {0.1f, 1, 6}, {0.2f, 1, 8})}, ray_along_z(-1), 0.13f,
                            offset, {0.01f, 1, 0.2f});
    expect_segments_follow_their_weights(*coloured, "chromatic");
  }
}

TEST(DensitySampling, SamplesFollowTheDensityInOneChannel) {
  for (const float sigma : {1e-8f, 0.01f, 1.0f, 20.0f, 3000.0f}) {
    RecordedRay<1> r({homogeneous_box(kLow, kHigh, Color(0.9f * sigma), Color(sigma))}, ray_along_z(-1), 1);
    expect_samples_follow_the_density(*r, "homogeneous");
  }
  RecordedRay<1> ramp({profile_box([](float z) { return 0.1f + z * z; }, kLow, kHigh, Color(0.5f), Color(0.7f))},
                      ray_along_z(-1), 0.1f, 0.3f);
  expect_samples_follow_the_density(*ramp, "ramp");
}

TEST(DensitySampling, SamplesFollowTheDensityInThreeChannels) {
  const auto rough = [](float z) { return 0.2f + std::abs(std::sin(3 * z)); };
  for (const Color throughput : {Color(1), Color(0.01f, 1, 0.2f), Color(0, 0, 1)}) {
    RecordedRay<3> r({profile_box(rough, kLow, kHigh, {0.1f, 1, 6}, {0.2f, 1, 8})}, ray_along_z(-1), 0.13f, 0.5f,
                     throughput);
    expect_samples_follow_the_density(*r, "chromatic");
  }
}

// D2 of the catalogue: a channel without extinction is 0/0 in the naive formulas.
TEST(DensitySampling, AChannelWithoutExtinctionTakesPart) {
  RecordedRay<3> no_red({homogeneous_box(kLow, kHigh, {0, 1, 3}, {0, 1, 4})}, ray_along_z(-1), 1);
  expect_samples_follow_the_density(*no_red, "red does not interact");
  RecordedRay<3> no_blue({homogeneous_box(kLow, kHigh, {2, 1, 0}, {2, 1, 0})}, ray_along_z(-1), 1);
  expect_samples_follow_the_density(*no_blue, "blue does not interact");
  RecordedRay<3> absorbs({homogeneous_box(kLow, kHigh, {0, 0, 1}, {5, 2, 1})}, ray_along_z(-1), 1);
  expect_samples_follow_the_density(*absorbs, "red and green absorb only");
  RecordedRay<3> thin({homogeneous_box(kLow, kHigh, {1e-9f, 1, 0}, {1e-9f, 2, 0})}, ray_along_z(-1), 1);
  expect_samples_follow_the_density(*thin, "red almost does not interact");
}

TEST(DensitySampling, GapsAreStepsOfTheCdfAndAreNeverHit) {
  std::vector<Medium> media{homogeneous_box({-1, -1, 0}, {1, 1, 1}, Color(1), Color(1)),
                            profile_box([](float z) { return z > 2.5f && z < 2.8f ? 0.0f : 1.0f; }, {-1, -1, 2},
                                        {1, 1, 3}, Color(2), Color(2.5f)),
                            homogeneous_box({-1, -1, 3.5}, {1, 1, 4}, Color(0), Color(1))};
  RecordedRay<1> grey(media, ray_along_z(-1), 0.1f);
  expect_samples_follow_the_density(*grey, "with gaps");
  media[1].sigma_s = {0, 2, 1}, media[1].sigma_t = {1, 2, 4};
  media[0].sigma_s = {1, 0, 0.5f}, media[0].sigma_t = {3, 0, 1};
  RecordedRay<3> chromatic(media, ray_along_z(-1), 0.1f);
  expect_samples_follow_the_density(*chromatic, "with gaps, chromatic");
  const DensitySampling<1> sampling(*grey, PlaceInSegment::Drawn);
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const float z = sampling.sample(random_number(i)).at.t - 1;
    const bool in_a_gap = (z > 1.0001f && z < 1.9999f) || z > 3.0001f;
    ASSERT_FALSE(in_a_gap) << z;
  }
}

TEST(DensitySampling, EveryNumberFromTheUnitIntervalGivesAPointThatScatters) {
  // Ends of the interval and targets that fall exactly on steps of the CDF, where binary search may go either way.
  std::vector<Medium> media{homogeneous_box({-1, -1, 0}, {1, 1, 1}, Color(0), Color(1)),
                            homogeneous_box({-1, -1, 1}, {1, 1, 2}, Color(1), Color(1)),
                            homogeneous_box({-1, -1, 3}, {1, 1, 4}, Color(1), Color(1)),
                            homogeneous_box({-1, -1, 5}, {1, 1, 6}, Color(0), Color(9))};
  RecordedRay<1> r(media, ray_along_z(-1), 1);
  const DensitySampling<1> sampling(*r, PlaceInSegment::Drawn);
  std::vector<float> numbers{0, 1e-30f, 0x1p-24f, 0.5f, 0x1.fffffep-1f, 0x1.fffffcp-1f};
  for (int i = 0; i <= r->n; ++i) {
    const float at = r->cdf[i] / r->scattered();
    for (const float u : {std::nextafter(at, 0.0f), at, std::nextafter(at, 1.0f)})
      if (u >= 0 && u < 1) numbers.push_back(u);
  }
  for (const float u : numbers) {
    const RayPoint<1> s = sampling.sample(u).at;
    EXPECT_GT(sampling.pdf(s), 0) << "u = " << u;
    EXPECT_TRUE((s.t >= 2 && s.t <= 3) || (s.t >= 4 && s.t <= 5)) << "u = " << u << " gives t = " << s.t;
  }
}

TEST(DensitySampling, TheWeightOfASampleIsTheSameForEveryDistanceInOneChannel) {
  RecordedRay<1> r({profile_box([](float z) { return 0.1f + z; }, kLow, kHigh, Color(0.5f), Color(0.7f))},
                   ray_along_z(-1), 0.1f);
  const DensitySampling<1> sampling(*r, PlaceInSegment::Drawn);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const RayPoint<1> p = sampling.sample(random_number(i)).at;
    EXPECT_NEAR(p.sigma_s[0] * p.transmittance[0] / sampling.pdf(p) / r->scattered(), 1, 3e-7);
  }
}

TEST(DensitySampling, NoWeightExceedsTheInverseOfItsChannelsShare) {
  // Balance heuristic over the channels: sigma_s T / pdf <= scattered / weight. Drawing for one channel alone has no
  // bound.
  const Color throughput{0.2f, 0.3f, 0.5f};
  RecordedRay<3> r({homogeneous_box(kLow, kHigh, {1, 4, 16}, {1, 4, 16})}, ray_along_z(-1), 1, 0.5f, throughput);
  const DensitySampling<3> sampling(*r, PlaceInSegment::Drawn);
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const RayPoint<3> p = sampling.sample(random_number(i)).at;
    for (int c = 0; c < 3; ++c)
      ASSERT_LE(p.sigma_s[c] * p.transmittance[c] / sampling.pdf(p), r->scattered() / throughput[c] * 1.00001f);
  }
}

TEST(FindSegment, FindsTheSegmentOfEveryEdgeAndMiddle) {
  const auto expect_found = [](const MarchRecord<1>& record) {
    for (int i = 0; i < record.n; ++i)
      for (const float t :
           {record.t[i], 0.5f * (record.t[i] + record.t[i + 1]), std::nextafter(record.t[i + 1], 0.0f)}) {
        if (t < record.t[0]) continue;  // far away some edges are the same float
        const auto above = std::upper_bound(record.t, record.t + record.n, t);
        EXPECT_EQ(find_segment(record, t), above - record.t - 1);
      }
    EXPECT_EQ(find_segment(record, record.t[record.n]), record.n - 1);
  };
  const auto flat = [](float low, float high) {
    return profile_box([](float) { return 1.0f; }, {-1, -1, double(low)}, {1, 1, double(high)}, Color(1), Color(1));
  };
  for (const float step : {2.0f, 0.3f, 0.1f, 0.0037f, 1e-4f}) {
    const RecordedRay<1> one({flat(0, 1)}, ray_along_z(-1), step), from_afar({flat(0, 1)}, ray_along_z(-3000), step),
        with_a_gap({flat(0, 1), flat(1.7f, 2)}, ray_along_z(-1), step);
    EXPECT_GT(one->inverse_step, 0);
    EXPECT_EQ(with_a_gap->inverse_step, 0);
    for (const auto* r : {&one, &from_afar, &with_a_gap}) expect_found(**r);
  }
}

TEST(SegmentOf, IsTheLastThatBeginsAtOrBelowTheValue) {
  for (int n = 1; n < 100; ++n) {
    std::vector<float> edges{0};  // some of them equal
    for (int i = 0; i < n; ++i) edges.push_back(edges.back() + (i % 3 == 1 ? 0 : 1));
    for (float value = 0; value < edges.back(); value += 0.5f) {
      const auto above = std::upper_bound(edges.begin(), edges.end(), value);
      EXPECT_EQ(segment_of(edges.data(), n, value), above - edges.begin() - 1) << n << ' ' << value;
    }
  }
}

TEST(Evaluate, GivesTransmittanceAndCoefficientsAnywhere) {
  RecordedRay<3> r({homogeneous_box(kLow, kHigh, {1, 2, 0}, {1, 2, 0})}, ray_along_z(-1), 1);
  const RayPoint<3> p = evaluate(*r, 2.5f);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(p.transmittance[c], std::exp(-1.5 * (c == 2 ? 0 : c + 1)), 1e-6);
    EXPECT_EQ(p.sigma_s[c], c == 2 ? 0.0f : static_cast<float>(c + 1));
  }
}

}  // namespace
}  // namespace brume
