#include "renderer/media/cloud_shader.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "renderer/core/simd.h"
#include "renderer/media/registry.h"

namespace brume {
namespace {

/// Points in arrays padded as a PointBatch wants them.
struct Points {
  explicit Points(int n_) : n(n_), x(padded()), y(padded()), z(padded()) {}
  std::size_t padded() const { return static_cast<std::size_t>((n + 15) / 16 * 16); }
  PointBatch batch() const { return {x.data(), y.data(), z.data(), n, 0}; }
  Vec3 operator[](int i) const { return {x[std::size_t(i)], y[std::size_t(i)], z[std::size_t(i)]}; }
  void set(int i, Vec3 p) { x[std::size_t(i)] = p.x, y[std::size_t(i)] = p.y, z[std::size_t(i)] = p.z; }
  int n;
  std::vector<float> x, y, z;
};

/// Some of it in random order, some along rays, so that blocks of 16 lie inside, outside and across the border.
Points some_points(int n, double reach = 1.3) {
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> uniform(-reach, reach);
  Points p(n);
  for (int i = 0; i < n;) {
    if (i % 3 == 0) {
      p.set(i++, Vec3(Vec3d(uniform(rng), uniform(rng), uniform(rng))));
      continue;
    }
    const Vec3d from(-reach, uniform(rng), uniform(rng)), to(reach, uniform(rng), uniform(rng));
    for (int k = 0; k < 100 && i < n; ++k) p.set(i++, Vec3(from + (to - from) * (k / 99.0)));
  }
  return p;
}

/// The result is as long as the batch; what was beyond must not have been needed.
std::vector<float> density(const Shader& shader, const Points& points) {
  std::vector<float> out(points.padded(), std::numeric_limits<float>::quiet_NaN());
  shader.density(points.batch(), out.data());
  out.resize(static_cast<std::size_t>(points.n));
  return out;
}

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(double{a[i]} - b[i]));
  return largest;
}

/// |q|^2 of the header.
double squared_radius(const CloudSettings& s, Vec3 p) {
  Vec3d q = Vec3d(p) - Vec3d(s.center);
  q = {q.x / s.size.x, q.y / s.size.y, q.z / s.size.z};
  if (q.z < 0) q.z /= 1 - s.flat_bottom;
  return length_squared(q);
}

class CloudShaderLevels : public testing::Test {
 protected:
  ~CloudShaderLevels() override { static_cast<void>(force_simd_level("auto")); }
};

TEST(CloudShader, FollowsItsFormula) {
  CloudSettings s;
  s.center = {0.1f, -0.05f, 0.02f}, s.coverage = 0.95f, s.flat_bottom = 0.5f, s.softness = 0.3f;
  const Points points = some_points(20000);
  std::vector<float> noise(points.padded());
  fbm_noise(points.batch(), {}, s.noise, noise.data());
  const std::vector<float> found = density(CloudShader({}, s), points);
  int inside = 0, solid = 0;
  for (int i = 0; i < points.n; ++i) {
    const double erosion = std::clamp((1 - double{noise[std::size_t(i)]}) / 2, 0.0, 1.0);
    const double left = s.coverage - squared_radius(s, points[i]) - s.roughness * erosion;
    const double expected = std::clamp(left / s.softness, 0.0, 1.0);
    // A dozen roundings of values up to some 30 = (1.3 / 0.3)^2 + ..., below the ellipsoid's middle; but there nothing
    // is left. Where something is, they are at most 1, and softness divides them.
    ASSERT_NEAR(found[std::size_t(i)], expected, 12 * std::numeric_limits<float>::epsilon() / s.softness);
    inside += expected > 0, solid += expected == 1;
  }
  EXPECT_GT(inside, points.n / 50);  // or nothing was tested
  EXPECT_GT(solid, points.n / 100);
}

TEST_F(CloudShaderLevels, AgreeWithinRounding) {
  const Points points = some_points(20000);
  const CloudSettings s;
  const CloudShader cloud({}, s);
  ASSERT_TRUE(force_simd_level("auto").ok());
  const std::vector<float> expected = density(cloud, points);
  // As for the noise: coordinates up to 2 with six roundings, a slope of 12 per unit and a lattice 1.6 times finer,
  // twice that for billow and gain; half of it is eroded, and softness divides.
  const double eps = std::numeric_limits<float>::epsilon();
  const double tolerance = (6 * eps / 2 * 2 * 12 * 1.6 * 2 / 2 + 12 * eps) / s.softness;
  ASSERT_LT(tolerance, 1e-3);
  for (const std::string& level : simd_levels()) {
    ASSERT_TRUE(force_simd_level(level).ok());
    EXPECT_LE(largest_difference(density(cloud, points), expected), tolerance) << level;
  }
}

TEST_F(CloudShaderLevels, GiveTheSameBitsForEverySplitIntoBatches) {
  const Points all = some_points(1300);  // more than two chunks
  const CloudShader cloud({}, {});
  for (const std::string& level : simd_levels()) {
    ASSERT_TRUE(force_simd_level(level).ok());
    const std::vector<float> whole = density(cloud, all);
    for (const int size : {1, 7, 16, 50, 512, 513}) {
      for (int first = 0; first < all.n; first += size) {
        Points part(std::min(size, all.n - first));
        for (int i = 0; i < part.n; ++i) part.set(i, all[first + i]);
        const std::vector<float> found = density(cloud, part);
        ASSERT_EQ(std::memcmp(found.data(), whole.data() + first, found.size() * sizeof(float)), 0)
            << level << ", batches of " << size << ", from " << first;
      }
    }
  }
}

TEST(CloudShader, IsExactlyZeroOutsideItsEllipsoidForAnySettings) {
  const Points points = some_points(20000);
  for (const float coverage : {1.0f, 0.6f}) {
    for (const float flat_bottom : {0.0f, 0.9f}) {
      for (const float roughness : {0.0f, 3.0f}) {
        CloudSettings s;
        s.coverage = coverage, s.flat_bottom = flat_bottom, s.roughness = roughness, s.softness = 0.01f;
        const std::vector<float> found = density(CloudShader({}, s), points);
        for (int i = 0; i < points.n; ++i) {
          // A point on the border may be rounded to either side of it.
          if (squared_radius(s, points[i]) >= coverage + 1e-5) {
            ASSERT_EQ(found[std::size_t(i)], 0);
          }
        }
      }
    }
  }
}

TEST(CloudShader, IsFiniteAndBetweenZeroAndOneEverywhere) {
  std::vector<float> values = {0, -0.3f, 0.999f, 1, -1e6f, 1e20f, -std::numeric_limits<float>::max()};
  Points points(7 * 7 * 7);
  int i = 0;
  for (const float x : values)
    for (const float y : values)
      for (const float z : values) points.set(i++, {x, y, z});
  for (const float scale : {1.0f, 1e-4f, 1e4f}) {
    CloudSettings s;
    s.size = Vec3(scale), s.noise.frequency = 1 / scale;
    for (const float d : density(CloudShader({}, s), points)) ASSERT_TRUE(d >= 0 && d <= 1) << d;
  }
}

TEST(CloudShader, IsEmptyWithoutCoverageAndAnEllipsoidWithoutRoughness) {
  const Points points = some_points(5000);
  CloudSettings none;
  none.coverage = 0;
  for (const float d : density(CloudShader({}, none), points)) ASSERT_EQ(d, 0);

  CloudSettings plain;
  plain.roughness = 0, plain.flat_bottom = 0;
  const std::vector<float> found = density(CloudShader({}, plain), points);
  for (int i = 0; i < points.n; ++i) {
    const double expected = std::clamp((1 - squared_radius(plain, points[i])) / plain.softness, 0.0, 1.0);
    ASSERT_NEAR(found[std::size_t(i)], expected, 1e-5);
  }
}

TEST(CloudShader, FillsAFairShareOfItsEllipsoidForEverySeed) {
  // The defaults must give a cloud whatever the seed: between a tenth and nine tenths of the (flattened) ellipsoid.
  const int n = 20000;
  const Points points = some_points(n, 1);
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    CloudSettings s;
    s.noise.seed = seed;
    const std::vector<float> found = density(CloudShader({}, s), points);
    double inside = 0, filled = 0;
    for (int i = 0; i < n; ++i) inside += squared_radius(s, points[i]) < 1, filled += found[std::size_t(i)];
    EXPECT_GT(filled / inside, 0.1) << seed;
    EXPECT_LT(filled / inside, 0.9) << seed;
  }
}

TEST(CloudShader, IsAnotherCloudForAnotherSeed) {
  const Points points = some_points(5000);
  CloudSettings other;
  other.noise.seed += 1;
  EXPECT_GT(largest_difference(density(CloudShader({}, {}), points), density(CloudShader({}, other), points)), 0.5);
}

TEST(CloudShader, MovesWithItsVolume) {
  const Affined scene_from_local = translation({5, -3, 2}) * rotation_deg({20, 30, 40}) * scaling({2, 2, 2});
  const Points local = some_points(5000);
  Points scene(local.n);
  for (int i = 0; i < local.n; ++i) scene.set(i, Vec3(scene_from_local.point(Vec3d(local[i]))));
  const CloudShader here({}, {}), there(*inverse(scene_from_local), {});
  // The points are rounded at up to 8 units instead of 1.3, and mapped back: some ten roundings of 8 eps at the slopes
  // of AgreeWithinRounding.
  const double eps = std::numeric_limits<float>::epsilon();
  EXPECT_LE(largest_difference(density(here, local), density(there, scene)),
            10 * 8 * eps * 12 * 1.6 / CloudSettings().softness);
}

TEST(CloudShader, TellsItsFinestScaleInWorldUnits) {
  CloudSettings s;
  s.noise.octaves = 3, s.noise.frequency = 1, s.noise.lacunarity = 2;
  EXPECT_FLOAT_EQ(*CloudShader({}, s).traits().finest_scale, 0.125f);                              // half of 1 / 4
  EXPECT_FLOAT_EQ(*CloudShader(*inverse(scaling({10, 30, 20})), s).traits().finest_scale, 1.25f);  // along the shortest
  s.noise.octaves = 12;
  EXPECT_FLOAT_EQ(*CloudShader({}, s).traits().finest_scale, 2 * 0.6f / 100);
  EXPECT_EQ(CloudShader({}, s).max_density({}), 1.0f);
  EXPECT_FALSE(CloudShader({}, s).traits().constant);
}

TEST(CloudShader, IsMadeFromItsTableWithTheSameDefaults) {
  const ShaderType type = cloud_shader_type();
  EXPECT_EQ(type.key, "cloud");
  EXPECT_FALSE(type.brings_bounds);
  const ParamTable table{type.key, type.label, type.doc, type.params, {}};
  Node node(table);
  GridCache grids;
  const ShaderContext context{Affined{}, grids, {}};
  const Points points = some_points(2000);

  const auto made = type.make(node, context);
  ASSERT_TRUE(made.ok());
  EXPECT_EQ(made->shape, nullptr);
  EXPECT_EQ(density(*made->shader, points), density(CloudShader({}, {}), points));

  // Every parameter reaches the shader.
  for (const Param& p : type.params) {
    Node changed(table);
    const Value value = p.type == ParamType::Int      ? Value(std::int64_t{3})
                        : p.type == ParamType::Number ? Value(p.key == "lacunarity" ? 1.5 : 0.4)
                                                      : Value(Numbers{0.5, 0.6, 0.7});
    ASSERT_TRUE(changed.set(p.key, value).ok()) << p.key;
    EXPECT_NE(density(*type.make(changed, context)->shader, points), density(*made->shader, points)) << p.key;
    EXPECT_FALSE(p.doc.empty()) << p.key;
  }
}

TEST(CloudShader, RefusesATransformThatFlattensSpace) {
  const ShaderType type = cloud_shader_type();
  const ParamTable table{type.key, type.label, type.doc, type.params, {}};
  GridCache grids;
  const auto made = type.make(Node(table), {scaling({1, 0, 1}), grids, {}});
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().source.key, "transform");
}

}  // namespace
}  // namespace brume
