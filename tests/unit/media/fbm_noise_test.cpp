#include "renderer/media/fbm_noise.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "renderer/core/simd.h"

namespace brume {
namespace {

/// Points in arrays padded as a PointBatch wants them; the padding holds NaN, which must not matter.
struct Points {
  explicit Points(int n_) : n(n_) {
    for (auto* v : {&x, &y, &z}) v->assign(padded(n), std::numeric_limits<float>::quiet_NaN());
  }
  static std::size_t padded(int n) { return static_cast<std::size_t>((n + 15) / 16 * 16); }
  PointBatch batch() const { return {x.data(), y.data(), z.data(), n, 0}; }
  void set(int i, Vec3 p) {
    const auto k = static_cast<std::size_t>(i);
    x[k] = p.x, y[k] = p.y, z[k] = p.z;
  }
  int n;
  std::vector<float> x, y, z;
};

Points random_points(int n, float low, float high, unsigned seed = 1) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> uniform(low, high);
  Points p(n);
  for (int i = 0; i < n; ++i) p.set(i, {uniform(rng), uniform(rng), uniform(rng)});
  return p;
}

std::vector<float> evaluate(const FbmNoise& noise, const Points& points) {
  std::vector<float> out(Points::padded(points.n));
  noise.evaluate(points.batch(), out.data());
  out.resize(static_cast<std::size_t>(points.n));
  return out;
}

struct Moments {
  double mean = 0, deviation = 0;
};

Moments moments(const std::vector<float>& values) {
  double sum = 0, squares = 0;
  for (const float v : values) sum += v, squares += double{v} * v;
  const double n = static_cast<double>(values.size()), mean = sum / n;
  return {mean, std::sqrt(squares / n - mean * mean)};
}

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
  const Moments ma = moments(a), mb = moments(b);
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - ma.mean) * (b[i] - mb.mean);
  return sum / static_cast<double>(a.size()) / (ma.deviation * mb.deviation);
}

/// Weight of octave o, for the deviation of 0.3 that the header states; 0.291 is that of one octave.
double weight(const FbmSettings& s, int o) {
  double squares = 0;
  for (int k = 0; k < s.octaves; ++k) squares += std::pow(double{s.gain}, 2 * k);
  return 0.3 / 0.291 * std::pow(double{s.gain}, o) / std::sqrt(squares);
}

/// No |derivative| along a unit direction exceeds this, for billow = 0. Per octave and axis: the blend of the eight
/// gradient components is at most 2, and the fade changes at most 15/8 per cell between values at most 6 apart; sqrt(3)
/// for three axes.
double steepest(const FbmSettings& s) {
  double sum = 0;
  for (int o = 0; o < s.octaves; ++o) sum += weight(s, o) * s.frequency * std::pow(double{s.lacunarity}, o);
  return sum * (2 + 1.875 * 6) * std::sqrt(3.0);
}

class EveryLevel : public testing::Test {
 protected:
  ~EveryLevel() override { static_cast<void>(force_simd_level("auto")); }
};
using FbmNoiseLevels = EveryLevel;

const FbmSettings kSmooth{.frequency = 1, .octaves = 6, .lacunarity = 2, .gain = 0.5f, .seed = 7};

TEST_F(FbmNoiseLevels, AgreeWithinTheRoundingOfTheCoordinates) {
  const float reach = 10;
  const Points points = random_points(5000, -reach, reach);
  FbmSettings billowed = kSmooth;
  billowed.billow = 1;
  for (const FbmSettings& settings : {kSmooth, billowed}) {
    const FbmNoise noise({}, settings);
    ASSERT_TRUE(force_simd_level("auto").ok());
    const std::vector<float> expected = evaluate(noise, points);
    // A coordinate is a sum of four terms of up to sqrt(3) reach, with three or six roundings of half an eps; the slope
    // turns that into values (12: twice the steepest found in a long walk; billow multiplies it by 0.291 / 0.1785). The
    // blending adds a few eps of values up to bound().
    const double eps = std::numeric_limits<float>::epsilon();
    const double moved = 6 * eps / 2 * std::sqrt(3.0) * reach;
    const double tolerance = moved * 12 * (1 + settings.billow) + 4 * eps * noise.bound();
    for (const std::string& level : simd_levels()) {
      ASSERT_TRUE(force_simd_level(level).ok());
      const std::vector<float> found = evaluate(noise, points);
      double worst = 0;
      for (std::size_t i = 0; i < found.size(); ++i) worst = std::max(worst, std::abs(double{found[i]} - expected[i]));
      EXPECT_LE(worst, tolerance) << level;
    }
  }
}

TEST_F(FbmNoiseLevels, GiveTheSameBitsForEverySplitIntoBatches) {
  const Points all = random_points(259, -30, 30);
  const FbmNoise noise({}, kSmooth);
  for (const std::string& level : simd_levels()) {
    ASSERT_TRUE(force_simd_level(level).ok());
    const std::vector<float> whole = evaluate(noise, all);
    for (const int size : {1, 2, 7, 16, 33, 128}) {
      for (int first = 0; first < all.n; first += size) {
        Points part(std::min(size, all.n - first));
        for (int i = 0; i < part.n; ++i) {
          const auto k = static_cast<std::size_t>(first + i);
          part.set(i, {all.x[k], all.y[k], all.z[k]});
        }
        const std::vector<float> found = evaluate(noise, part);
        ASSERT_EQ(std::memcmp(found.data(), whole.data() + first, found.size() * sizeof(float)), 0)
            << level << ", batches of " << size << ", from " << first;
      }
    }
  }
}

TEST(FbmNoise, HasMeanZeroAndTheStatedDeviationForAnySettings) {
  const int n = 200000;
  const Points points = random_points(n, -300, 300);
  for (const float billow : {0.0f, 0.3f, 1.0f}) {
    for (const int octaves : {1, 3, 8}) {
      for (const float gain : {0.3f, 0.8f}) {
        const FbmNoise noise({}, {.octaves = octaves, .gain = gain, .seed = 3, .billow = billow});
        const std::vector<float> values = evaluate(noise, points);
        const Moments m = moments(values);
        // Five standard errors: 0.3 / sqrt(n) of the mean, and 1.3 times that of the deviation for a kurtosis up to 7
        // (sqrt((k - 1) / 4)); 0.002 for the measured constants.
        const double error = 5 * 0.3 / std::sqrt(double{n});
        EXPECT_NEAR(m.mean, 0, error + 0.002) << billow << ' ' << octaves << ' ' << gain;
        EXPECT_NEAR(m.deviation, 0.3, 1.3 * error + 0.002) << billow << ' ' << octaves << ' ' << gain;

        int outside = 0;
        for (const float v : values) {
          ASSERT_LE(std::abs(v), noise.bound());
          outside += std::abs(v) > 1;
        }
        EXPECT_LT(outside, n * (billow == 0 ? 0.002 : 0.015));
      }
    }
  }
}

TEST(FbmNoise, IsContinuousAcrossCells) {
  // Along a line that crosses hundreds of cells of the finest octave, halving the step halves the largest difference,
  // and no difference exceeds the steepest slope.
  const FbmNoise noise({}, kSmooth);
  const int n = 100000;
  double largest[2];
  for (int k = 0; k < 2; ++k) {
    const double h = k == 0 ? 2e-4 : 1e-4;
    Points line(n);
    for (int i = 0; i < n; ++i)
      line.set(i, {static_cast<float>(-6 + 0.6 * h * i), static_cast<float>(1 - 0.48 * h * i),
                   static_cast<float>(0.64 * h * i)});
    const std::vector<float> v = evaluate(noise, line);
    largest[k] = 0;
    for (std::size_t i = 1; i < v.size(); ++i) largest[k] = std::max(largest[k], std::abs(double{v[i]} - v[i - 1]));
    EXPECT_LE(largest[k], steepest(kSmooth) * h);
  }
  // Rounding: points near 20 are 2e-6 apart at best, a fiftieth of the step.
  EXPECT_NEAR(largest[1] / largest[0], 0.5, 0.05);
}

TEST(FbmNoise, IsAnotherOneForAnotherSeed) {
  const int n = 50000;
  const Points points = random_points(n, -100, 100);
  FbmSettings settings = kSmooth;
  const std::vector<float> first = evaluate(FbmNoise({}, settings), points);
  for (const std::uint32_t seed : {0u, 1u, 6u, 8u, 0x80000007u, 0xFFFFFFFFu}) {
    settings.seed = seed;
    // The standard error of a correlation of independent values is 1 / sqrt(n).
    EXPECT_NEAR(correlation(first, evaluate(FbmNoise({}, settings), points)), 0, 5 / std::sqrt(double{n})) << seed;
  }
}

TEST(FbmNoise, HasUnrelatedValuesAtAnyPointForManySeeds) {
  // Lattices that coincided would have their common zeros here, whatever the seed.
  const int n = 4000;
  for (const Vec3 p : {Vec3(0, 0, 0), Vec3(1, -2, 3), Vec3(0.5f, 0.5f, 0.5f)}) {
    Points point(1);
    point.set(0, p);
    std::vector<float> values;
    for (std::uint32_t seed = 0; seed < n; ++seed)
      values.push_back(evaluate(FbmNoise({}, {.octaves = 1, .seed = seed}), point)[0]);
    const Moments m = moments(values);
    EXPECT_NEAR(m.mean, 0, 5 * 0.3 / std::sqrt(double{n}));
    EXPECT_NEAR(m.deviation, 0.3, 5 * 0.3 / std::sqrt(2.0 * n));
  }
}

TEST(FbmNoise, TreatsNegativeCoordinatesAsAnyOther) {
  const int n = 50000;
  const Points plus = random_points(n, 0, 200);
  Points minus(n);
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    minus.set(i, {-plus.x[k], -plus.y[k], -plus.z[k]});
  }
  const FbmNoise noise({}, kSmooth);
  const std::vector<float> a = evaluate(noise, plus), b = evaluate(noise, minus);
  EXPECT_NEAR(correlation(a, b), 0, 5 / std::sqrt(double{n}));  // no mirror image, no repetition
  EXPECT_NEAR(moments(b).deviation, moments(a).deviation, 0.01);
}

TEST(FbmNoise, HasNeighboursWithoutARelation) {
  // One octave at places whole cells apart: the hash must not carry anything over.
  const int n = 50000;
  const Points points = random_points(n, -100, 100);
  const FbmNoise noise({}, {.octaves = 1, .seed = 5});
  const std::vector<float> here = evaluate(noise, points);
  for (const Vec3 by :
       {Vec3(3, 0, 0), Vec3(0, 3, 0), Vec3(0, 0, -3), Vec3(8, 0, 0), Vec3(0, 64, 0), Vec3(256, 256, 0)}) {
    Points there(n);
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      there.set(i, Vec3(points.x[k], points.y[k], points.z[k]) + by);
    }
    EXPECT_NEAR(correlation(here, evaluate(noise, there)), 0, 5 / std::sqrt(double{n}));
  }
}

TEST(FbmNoise, LooksTheSameAlongAxesAndDiagonals) {
  // Mean square difference over a fixed distance, in units of that along x.
  const int n = 100000;
  const Points points = random_points(n, -100, 100);
  const FbmNoise noise({}, kSmooth);
  const std::vector<float> here = evaluate(noise, points);
  std::vector<double> squares;
  for (const Vec3 d : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 0), Vec3(0, 1, -1), Vec3(1, 1, 1)}) {
    Points there(n);
    const Vec3 by = normalize(d) * 0.2f;
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      there.set(i, Vec3(points.x[k], points.y[k], points.z[k]) + by);
    }
    const std::vector<float> other = evaluate(noise, there);
    double sum = 0;
    for (std::size_t i = 0; i < other.size(); ++i) sum += (double{other[i]} - here[i]) * (double{other[i]} - here[i]);
    squares.push_back(sum / n);
  }
  // Five standard errors are 0.03, for squares of nearly normal values have a relative deviation of sqrt(2), and two
  // such means are compared. The rest is what the lattice of the first octave leaves.
  for (const double s : squares) EXPECT_NEAR(s / squares[0], 1, 0.04);
}

TEST_F(FbmNoiseLevels, AreFiniteFarOut) {
  const float huge[] = {0, 1e6f, -1e6f, 4194304, -4194304.5f, 1e12f, -1e20f};
  Points points(7 * 7 * 7);
  int i = 0;
  for (const float x : huge)
    for (const float y : huge)
      for (const float z : huge) points.set(i++, {x, y, z});
  for (const std::string& level : simd_levels()) {
    ASSERT_TRUE(force_simd_level(level).ok());
    for (const float frequency : {0.0f, 1.0f, 1e6f}) {
      const FbmNoise noise({}, {.frequency = frequency, .octaves = 16, .lacunarity = 3, .gain = 1, .seed = 1});
      for (const float v : evaluate(noise, points)) {
        ASSERT_TRUE(std::isfinite(v)) << level;
        ASSERT_LE(std::abs(v), noise.bound() * 1.001f) << level;
      }
    }
  }
}

TEST(FbmNoise, TakesPointsThroughTheMap) {
  const Affined map = translation({3, -1, 2}) * rotation_deg({10, 20, 30}) * scaling({2, 2, 2});
  const Points points = random_points(1000, -2, 2);
  Points mapped(points.n);
  for (int i = 0; i < points.n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    mapped.set(i, Vec3(map.point({points.x[k], points.y[k], points.z[k]})));
  }
  std::vector<float> direct(Points::padded(points.n));
  fbm_noise(points.batch(), map.cast<float>(), kSmooth, direct.data());
  const std::vector<float> expected = evaluate(FbmNoise({}, kSmooth), mapped);
  // Coordinates up to 10, rounded some ten times on either way.
  const double tolerance = 20 * std::numeric_limits<float>::epsilon() * 10 * steepest(kSmooth);
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(direct[i], expected[i], tolerance);
}

TEST(FbmNoise, MovesSettingsOutOfRangeToTheNearestEnd) {
  const Points points = random_points(64, -5, 5);
  const auto values = [&](const FbmSettings& s) { return evaluate(FbmNoise({}, s), points); };
  EXPECT_EQ(values({.octaves = 0}), values({.octaves = 1}));
  EXPECT_EQ(values({.octaves = 99}), values({.octaves = kMaxFbmOctaves}));
  EXPECT_EQ(values({.lacunarity = 0.2f}), values({.lacunarity = 1}));
  EXPECT_EQ(values({.gain = -1}), values({.gain = 0}));
  EXPECT_EQ(values({.billow = 2}), values({.billow = 1}));
}

}  // namespace
}  // namespace brume
