#include "renderer/sampling/sampler.h"

#include <gtest/gtest.h>

#include <vector>

#include "renderer/core/simd.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

const std::vector<Decision> kDecisions = [] {
  std::vector<Decision> all;
  for (int d = 0; d < kDecisionCount; ++d) all.push_back(static_cast<Decision>(d));
  return all;
}();

constexpr SamplerKind kKinds[] = {SamplerKind::Independent, SamplerKind::Sobol};

double chi_square_uniform(const std::vector<double>& values, int bins) {
  std::vector<double> observed(static_cast<std::size_t>(bins)),
      expected(observed.size(), static_cast<double>(values.size()) / bins);
  for (const double v : values) ++observed[static_cast<std::size_t>(v * bins)];
  return chi_square_p_value(observed, expected);
}

/// p-value of a 2D histogram against the uniform square.
double chi_square_square(const std::vector<double>& a, const std::vector<double>& b, int bins) {
  std::vector<double> observed(static_cast<std::size_t>(bins * bins)),
      expected(observed.size(), static_cast<double>(a.size()) / (bins * bins));
  for (std::size_t i = 0; i < a.size(); ++i)
    ++observed[static_cast<std::size_t>(a[i] * bins) * static_cast<std::size_t>(bins) +
               static_cast<std::size_t>(b[i] * bins)];
  return chi_square_p_value(observed, expected);
}

/// The first numbers of a decision over pixels (a Sobol' sequence is only random from one pixel to the next).
std::vector<double> over_pixels(SamplerKind kind, Decision decision, int n, std::uint32_t sample = 0, int bounce = 0,
                                int index = 0) {
  std::vector<double> values;
  for (int p = 0; p < n; ++p)
    values.push_back(
        static_cast<double>(Sampler(kind, 7, static_cast<std::uint32_t>(p), sample).u1(decision, bounce, index)));
  return values;
}

std::vector<double> over_samples(SamplerKind kind, Decision decision, int n, std::uint32_t pixel, int bounce = 0,
                                 int index = 0) {
  std::vector<double> values;
  for (int s = 0; s < n; ++s)
    values.push_back(
        static_cast<double>(Sampler(kind, 7, pixel, static_cast<std::uint32_t>(s)).u1(decision, bounce, index)));
  return values;
}

TEST(Sampler, NumbersAreAtLeastZeroAndBelowOne) {
  for (const SamplerKind kind : kKinds) {
    float low = 1, high = 0;
    for (std::uint32_t s = 0; s < 1 << 20; ++s) {
      const Vec2 u = Sampler(kind, 1, s & 15, s >> 4).u2(Decision::LightPoint);
      low = std::min({low, u.x, u.y}), high = std::max({high, u.x, u.y});
    }
    EXPECT_GE(low, 0);
    EXPECT_LT(high, 1);
    // 2^21 numbers leave a gap of 14 / 2^21 at an end with probability e^-14.
    EXPECT_LT(low, 14.0f / (1 << 21));
    EXPECT_GT(high, 1 - 14.0f / (1 << 21));
  }
}

TEST(Sampler, MarginalsAreUniformForEveryDecision) {
  for (const SamplerKind kind : kKinds)
    for (const Decision d : kDecisions) {
      const int number = static_cast<int>(d);
      EXPECT_GT(chi_square_uniform(over_pixels(kind, d, 20000), 64), kChiSquareSignificance)
          << "over pixels, decision " << number;
      EXPECT_GT(chi_square_uniform(over_pixels(kind, d, 20000, 12345, 3, 2), 64), kChiSquareSignificance)
          << "over pixels at a later pass and bounce, decision " << number;
      EXPECT_GT(chi_square_uniform(over_samples(kind, d, 20000, 5), 64), kChiSquareSignificance)
          << "over passes, decision " << number;
    }
}

TEST(Sampler, SecondComponentIsUniformAndIndependentOfTheFirst) {
  for (const SamplerKind kind : kKinds)
    for (const Decision d :
         {Decision::Pixel, Decision::LightPoint, Decision::PhaseDirection, Decision::BounceDirection}) {
      std::vector<double> x, y;
      for (std::uint32_t p = 0; p < 20000; ++p) {
        const Vec2 u = Sampler(kind, 3, p, 9).u2(d);
        x.push_back(static_cast<double>(u.x)), y.push_back(static_cast<double>(u.y));
      }
      EXPECT_GT(chi_square_uniform(y, 64), kChiSquareSignificance);
      EXPECT_GT(chi_square_square(x, y, 16), kChiSquareSignificance);
    }
}

// A10 of the catalogue: two decisions that share a number give structured noise or a wrong mean.
TEST(Sampler, DecisionsDoNotDependOnEachOther) {
  constexpr int kN = 8192;
  const int pairs = kDecisionCount * (kDecisionCount - 1) / 2;
  for (const SamplerKind kind : kKinds) {
    std::vector<std::vector<double>> pixels, samples;
    for (const Decision d : kDecisions)
      pixels.push_back(over_pixels(kind, d, kN, 2)), samples.push_back(over_samples(kind, d, kN, 11));
    // The correlation of independent numbers is normal with standard deviation 1/sqrt(n).
    const double bound = sidak_z(1e-3, 2 * pairs) / std::sqrt(kN);
    for (std::size_t a = 0; a < kDecisionCount; ++a)
      for (std::size_t b = a + 1; b < kDecisionCount; ++b) {
        EXPECT_LT(std::abs(correlation(pixels[a], pixels[b])), bound) << a << ' ' << b;
        EXPECT_LT(std::abs(correlation(samples[a], samples[b])), bound) << a << ' ' << b;
        // Some hundred tests of each kind.
        EXPECT_GT(chi_square_square(pixels[a], pixels[b], 8), 1e-6) << a << ' ' << b;
        EXPECT_GT(chi_square_square(samples[a], samples[b], 8), 1e-6) << a << ' ' << b;
      }
  }
}

TEST(Sampler, BouncesLightSamplesPassesPixelsAndSeedsDoNotDependOnEachOther) {
  constexpr int kN = 8192;
  for (const SamplerKind kind : kKinds) {
    const Decision d = Decision::DensityDistance;
    const std::vector<double> base = over_pixels(kind, d, kN, 4, 1, 1);
    std::vector<double> other_seed, other_pixel;
    for (std::uint32_t p = 0; p < kN; ++p) {
      other_seed.push_back(static_cast<double>(Sampler(kind, 8, p, 4).u1(d, 1, 1)));
      other_pixel.push_back(static_cast<double>(Sampler(kind, 7, p + 1, 4).u1(d, 1, 1)));
    }
    const std::pair<const char*, std::vector<double>> others[] = {
        {"next bounce", over_pixels(kind, d, kN, 4, 2, 1)},
        {"next light sample", over_pixels(kind, d, kN, 4, 1, 2)},
        {"bounce and light sample swapped", over_pixels(kind, d, kN, 4, 2, 0)},
        {"next seed", other_seed},
        {"next pixel", other_pixel}};
    for (const auto& [what, values] : others) {
      EXPECT_LT(std::abs(correlation(base, values)), sidak_z(1e-3, 10) / std::sqrt(kN)) << what;
      EXPECT_GT(chi_square_square(base, values, 16), kChiSquareSignificance) << what;
    }
  }
  // Successive passes are independent only where statistics are asked for; Sobol' points keep out of each other's way.
  const std::vector<double> first = over_pixels(SamplerKind::Independent, Decision::Roulette, kN, 0),
                            second = over_pixels(SamplerKind::Independent, Decision::Roulette, kN, 1);
  EXPECT_LT(std::abs(correlation(first, second)), sidak_z(1e-3, 1) / std::sqrt(kN));
}

TEST(SobolSampler, EveryAlignedBlockOf2ToTheKNumbersHitsEveryPartOf1DOnce) {
  for (std::uint32_t pixel = 0; pixel < 50; ++pixel)
    for (const int k : {1, 4, 8}) {
      const std::uint32_t n = 1u << k;
      for (const std::uint32_t first : {0u, n, 5 * n}) {
        std::vector<int> hits(n);
        for (std::uint32_t s = first; s < first + n; ++s)
          ++hits[static_cast<std::size_t>(Sampler(SamplerKind::Sobol, 1, pixel, s).u1(Decision::MarchOffset) *
                                          static_cast<float>(n))];
        for (const int h : hits) ASSERT_EQ(h, 1) << "pixel " << pixel << ", block of " << n << " from " << first;
      }
    }
}

TEST(SobolSampler, SixteenPointsOfAPairHitEveryElementaryInterval) {
  // The first two dimensions of the pass's point, and a pair of its own.
  constexpr std::pair<Decision, int> kPairs[] = {{Decision::Pixel, 0}, {Decision::LightPoint, 1}};
  for (std::uint32_t pixel = 0; pixel < 200; ++pixel)
    for (const auto& [d, bounce] : kPairs)
      for (const std::uint32_t first : {0u, 16u, 48u})
        for (int columns_log = 0; columns_log <= 4; ++columns_log) {
          const int columns = 1 << columns_log, rows = 16 / columns;
          std::vector<int> hits(16);
          for (std::uint32_t s = first; s < first + 16; ++s) {
            const Vec2 u = Sampler(SamplerKind::Sobol, 1, pixel, s).u2(d, bounce);
            ++hits[static_cast<std::size_t>(static_cast<int>(u.x * static_cast<float>(columns)) * rows +
                                            static_cast<int>(u.y * static_cast<float>(rows)))];
          }
          for (const int h : hits) ASSERT_EQ(h, 1) << "pixel " << pixel << ", " << columns << " x " << rows;
        }
}

TEST(SobolSampler, InTheFirstPassBlocksOfPixelsHitEverySixteenthOnceAndTheirQuartersEveryQuarter) {
  constexpr int kPictureWidth = 101;
  for (const Decision d : {Decision::Pixel, Decision::DensityDistance, Decision::MarchOffset, Decision::LightPoint,
                           Decision::BounceDistance, Decision::LightChoice})
    for (const auto& [block_x, block_y] : {std::pair(0, 0), {7, 3}, {25, 60}}) {
      std::vector<int> hits(16), hits_of_quarter(16);
      const SamplerPass pass(SamplerKind::Sobol, 5, 0);
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
          const float u = Sampler(pass, 4 * block_x + x, 4 * block_y + y, kPictureWidth).u1(d);
          ++hits[static_cast<std::size_t>(u * 16)];
          ++hits_of_quarter[static_cast<std::size_t>(4 * (2 * (y / 2) + x / 2)) + static_cast<std::size_t>(u * 4)];
        }
      EXPECT_EQ(hits, std::vector<int>(16, 1)) << "decision " << static_cast<int>(d);
      EXPECT_EQ(hits_of_quarter, std::vector<int>(16, 1)) << "decision " << static_cast<int>(d);
    }
}

TEST(SobolSampler, EveryPixelOfABlockHasAScrambledSequenceOfItsOwn) {
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y) {
      std::vector<int> hits(64);
      for (std::uint32_t s = 0; s < 64; ++s) {
        const float u = Sampler({SamplerKind::Sobol, 5, s}, x, y, 64).u1(Decision::DensityDistance);
        ++hits[static_cast<std::size_t>(u * 64)];
      }
      EXPECT_EQ(hits, std::vector<int>(64, 1)) << x << ' ' << y;
    }
  // Behind the digits that are shared out neighbours know nothing of each other.
  std::vector<double> left, right;
  for (int k = 0; k < 8192; ++k) {
    const SamplerPass pass(SamplerKind::Sobol, 5, 37);
    const int x = 4 * (k % 128), y = k / 128;
    const auto rest = [](float u) { return double(u) * 16 - std::floor(double(u) * 16); };
    left.push_back(rest(Sampler(pass, x, y, 512).u1(Decision::DensityDistance)));
    right.push_back(rest(Sampler(pass, x + 1, y, 512).u1(Decision::DensityDistance)));
  }
  EXPECT_GT(chi_square_square(left, right, 16), kChiSquareSignificance);
  // Over blocks the numbers of one place are random.
  for (const Decision d : {Decision::DensityDistance, Decision::LightPoint}) {
    std::vector<double> here, beside, below;
    for (int k = 0; k < 8192; ++k) {
      const SamplerPass pass(SamplerKind::Sobol, 5, 3);
      const int x = 4 * (k % 128), y = 4 * (k / 128);
      here.push_back(static_cast<double>(Sampler(pass, x, y, 512).u1(d)));
      beside.push_back(static_cast<double>(Sampler(pass, x + 4, y, 512).u1(d)));
      below.push_back(static_cast<double>(Sampler(pass, x, y + 4, 512).u1(d)));
    }
    EXPECT_GT(chi_square_uniform(here, 64), kChiSquareSignificance);
    EXPECT_GT(chi_square_square(here, beside, 16), kChiSquareSignificance);
    EXPECT_GT(chi_square_square(here, below, 16), kChiSquareSignificance);
  }
}

TEST(SobolSampler, MeanOfASmoothFunctionConvergesFasterThanIndependentNumbers) {
  // Owen scrambling: variance O(n^-3) for smooth one-dimensional integrands against O(n^-1).
  constexpr int kN = 256;
  RunningMean squared_error[2];
  for (std::uint32_t pixel = 0; pixel < 100; ++pixel)
    for (int k = 0; k < 2; ++k) {
      RunningMean mean;
      for (const double u : over_samples(kKinds[k], Decision::BounceDistance, kN, pixel)) mean.add(std::exp(u));
      squared_error[k].add(std::pow(mean.mean() - (std::exp(1.0) - 1), 2));
    }
  EXPECT_LT(squared_error[1].mean(), squared_error[0].mean() / 1000);  // in theory about 256^2 = 65536
}

TEST(Sampler, PerPixelNumberIsFixedOverPassesUniformOverPixelsAndUnlikeTheOthers) {
  for (const SamplerKind kind : kKinds) {
    std::vector<double> values;
    for (std::uint32_t p = 0; p < 8192; ++p) {
      const float first = Sampler(kind, 7, p, 0).per_pixel(Decision::TechniquePhase);
      for (const std::uint32_t s : {1u, 2u, 1000u})
        ASSERT_EQ(Sampler(kind, 7, p, s).per_pixel(Decision::TechniquePhase), first);
      values.push_back(static_cast<double>(first));
    }
    EXPECT_GT(chi_square_uniform(values, 64), kChiSquareSignificance);
    const double bound = sidak_z(1e-3, kDecisionCount) / std::sqrt(8192.0);
    for (const Decision d : kDecisions) EXPECT_LT(std::abs(correlation(values, over_pixels(kind, d, 8192))), bound);
  }
}

TEST(SobolSampler, NumbersHaveTheSameBitsAtEverySimdLevel) {
  const auto numbers = [] {
    std::vector<float> all;
    for (std::uint32_t s = 0; s < 100; ++s)
      for (const Decision d : kDecisions) all.push_back(Sampler({SamplerKind::Sobol, 5, s}, 17, 3, 64).u1(d));
    return all;
  };
  const std::vector<float> best = numbers();
  for (const std::string& level : simd_levels()) {
    ASSERT_TRUE(force_simd_level(level).ok());
    EXPECT_EQ(numbers(), best) << level;
  }
  ASSERT_TRUE(force_simd_level("auto").ok());
}

TEST(Sampler, NumbersDependOnNothingButTheArguments) {
  for (const SamplerKind kind : kKinds) {
    const Sampler a(kind, 3, 17, 5);
    const float first = a.u1(Decision::Roulette, 4);
    static_cast<void>(a.u2(Decision::Pixel));
    static_cast<void>(a.u1(Decision::Roulette, 5));
    EXPECT_EQ(a.u1(Decision::Roulette, 4), first);
    EXPECT_EQ(Sampler(kind, 3, 17, 5).u1(Decision::Roulette, 4), first);
  }
}

}  // namespace
}  // namespace brume
