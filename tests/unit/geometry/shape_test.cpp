#include "renderer/geometry/shape.h"

#include <gtest/gtest.h>

#include "renderer/geometry/shape_params.h"
#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warps.h"
#include "tests/support/meshes.h"

namespace brume {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The one interval, or an empty one.
Interval inside(const Shape& shape, const Ray& ray) {
  Arena arena;
  const ArenaScope scope(arena);
  const auto parts = shape.intervals(ray, arena);
  if (parts.empty()) return {};
  EXPECT_EQ(parts.size(), 1u);
  EXPECT_FALSE(parts[0].empty()) << "an interval that is empty";
  return parts[0];
}

void expect_interval(Interval found, float begin, float end, float tolerance = 1e-6f) {
  EXPECT_NEAR(found.begin, begin, tolerance);
  EXPECT_NEAR(found.end, end, tolerance);
}

const BoxShape kBox({-1, -2, -3}, {1, 2, 3});
const SphereShape kBall({1, 2, 3}, 2);

TEST(BoxShape, OriginInFrontInsideOnTheFaceAndBehind) {
  expect_interval(inside(kBox, {{-4, 0, 0}, {1, 0, 0}}), 3, 5);
  expect_interval(inside(kBox, {{0.5f, 0, 0}, {1, 0, 0}}), 0, 0.5f);
  expect_interval(inside(kBox, {{-1, 0, 0}, {1, 0, 0}}), 0, 2);
  EXPECT_TRUE(inside(kBox, {{1, 0, 0}, {1, 0, 0}}).empty()) << "on the face, looking out";
  EXPECT_TRUE(inside(kBox, {{4, 0, 0}, {1, 0, 0}}).empty()) << "behind the origin";
  EXPECT_TRUE(inside(kBox, {{-4, 2.5f, 0}, {1, 0, 0}}).empty()) << "beside it";
}

TEST(SphereShape, OriginInFrontInsideOnTheSurfaceAndBehind) {
  expect_interval(inside(kBall, {{-4, 2, 3}, {1, 0, 0}}), 3, 7);
  expect_interval(inside(kBall, {{1, 2, 3}, {0, 0, -1}}), 0, 2);
  expect_interval(inside(kBall, {{-1, 2, 3}, {1, 0, 0}}), 0, 4);
  EXPECT_TRUE(inside(kBall, {{3, 2, 3}, {1, 0, 0}}).empty()) << "on the surface, looking out";
  EXPECT_TRUE(inside(kBall, {{5, 2, 3}, {1, 0, 0}}).empty()) << "behind the origin";
  EXPECT_TRUE(inside(kBall, {{-4, 4.5f, 3}, {1, 0, 0}}).empty()) << "beside it";
}

TEST(Shape, IntervalIsClippedToTheSpanOfTheRay) {
  const std::pair<const Shape*, Ray> cases[] = {{&kBox, {{-4, 0, 0}, {1, 0, 0}}}, {&kBall, {{-4, 2, 3}, {1, 0, 0}}}};
  for (auto [shape, ray] : cases) {
    ray.span = {3.5f, 4.5f};
    expect_interval(inside(*shape, ray), 3.5f, 4.5f);
    ray.span = {0, 4};
    expect_interval(inside(*shape, ray), 3, 4);
    ray.span = {0, 2.9f};
    EXPECT_TRUE(inside(*shape, ray).empty());
    ray.span = {4, 4};
    EXPECT_TRUE(inside(*shape, ray).empty());
    ray.span = {8, kInfinity};
    EXPECT_TRUE(inside(*shape, ray).empty());
  }
}

TEST(Shape, DirectionNeedNotBeUnit) {
  expect_interval(inside(kBox, {{-4, 0, 0}, {0.5f, 0, 0}}), 6, 10);
  expect_interval(inside(kBall, {{-4, 2, 3}, {4, 0, 0}}), 0.75f, 1.75f);
}

TEST(BoxShape, RaysParallelToAFaceAreInsideOrOutsideNeverNaN) {
  // 0 times infinity in the slab test would be NaN here.
  for (const float zero : {0.0f, -0.0f}) {
    expect_interval(inside(kBox, {{0.5f, -5, 0}, {zero, 1, zero}}), 3, 7);
    EXPECT_TRUE(inside(kBox, {{1.5f, -5, 0}, {zero, 1, zero}}).empty());
    // Exactly in a face: inside by convention, as the bounds include their faces.
    expect_interval(inside(kBox, {{1, -5, 0}, {zero, 1, zero}}), 3, 7);
  }
}

TEST(BoxShape, AllDirectionsThroughCornersEdgesAndFacesGiveTheChord) {
  // 26 directions from the centre out and back: every chord has the length that the geometry says.
  const BoxShape cube({-1, -1, -1}, {1, 1, 1});
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Vec3 target(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        const Vec3 direction = normalize(target);
        const Interval chord = inside(cube, {target * 3.0f, -direction});
        EXPECT_NEAR(chord.begin, 2 * length(target), 2e-6f);
        EXPECT_NEAR(chord.length(), 2 * length(target), 2e-6f);
      }
}

TEST(BoxShape, ARayThroughAnEdgeOnlyMeetsNothing) {
  const Interval edge = inside(BoxShape({-1, -1, -1}, {1, 1, 1}), {{2, 0, 0}, normalize(Vec3(-1, 0, 1))});
  EXPECT_LT(edge.length(), 1e-6f);  // the point (1, 0, 1)
}

TEST(SphereShape, ATangentMeetsNothingAndAGrazingRayHasItsChord) {
  const SphereShape ball({0, 0, 0}, 1);
  EXPECT_TRUE(inside(ball, {{1, 0, -3}, {0, 0, 1}}).empty());
  const float b = 0.9999f;  // rounded: the chord is that of the rounded value
  const double chord = 2 * std::sqrt(1 - double(b) * double(b));
  EXPECT_NEAR(inside(ball, {{b, 0, -3}, {0, 0, 1}}).length(), chord, 2 * 2.4e-7);  // two floats near 3
}

TEST(SphereShape, KeepsItsChordFarFromTheCamera) {
  // The textbook discriminant would lose everything at a distance of 1e6 (b^2 ~ 1e12). What is left is the spacing of
  // floats at t = 1e6: 1/16 for each end.
  for (const float distance : {1e3f, 1e5f, 1e6f}) {
    const Interval chord = inside(SphereShape({0, 0, 0}, 10), {{6, 0, -distance}, {0, 0, 1}});
    EXPECT_NEAR(chord.length(), 16, distance * 0x1p-23f);
  }
}

TEST(Shape, PointsOfTheIntervalAreInsideAndPointsBeyondAreNot) {
  const Sampler sampler(SamplerKind::Independent, 9, 0, 0);
  int met = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 direction = uniform_sphere(sampler.u2(Decision::PhaseDirection, 0, i));
    const Vec2 a = sampler.u2(Decision::Pixel, 0, i), b = sampler.u2(Decision::LightPoint, 0, i);
    const Ray ray{{8 * a.x - 4, 8 * a.y - 4, 8 * b.x - 4}, direction};
    for (const bool box : {true, false}) {
      const auto depth = [&](float t) {  // > 0 inside
        const Vec3 p = ray.at(t);
        return box ? std::min({1 - std::abs(p.x), 2 - std::abs(p.y), 3 - std::abs(p.z)})
                   : 2 - length(p - Vec3(1, 2, 3));
      };
      const Interval found = inside(box ? static_cast<const Shape&>(kBox) : kBall, ray);
      for (int k = 0; k < 20; ++k) {
        const float t = 12 * (static_cast<float>(k) + 0.37f) / 20;
        if (std::abs(depth(t)) < 1e-5f) continue;  // rounding decides
        ASSERT_EQ(depth(t) > 0, t > found.begin && t < found.end)
            << (box ? "box" : "sphere") << ", ray " << i << ", t = " << t;
      }
      met += found.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(met, 1000) << "the rays hardly meet the shapes";
}

TEST(Shape, BoundsHoldTheShape) {
  EXPECT_EQ(kBox.bounds().low, Vec3d(-1, -2, -3));
  EXPECT_EQ(kBall.bounds().low, Vec3d(-1, 0, 1));
  EXPECT_EQ(kBall.bounds().high, Vec3d(3, 4, 5));
}

TEST(ShapeRegistry, EveryKindIsMadeFromItsDefaultsAndParametersReachIt) {
  FileCache<Mesh> meshes;
  for (const ParamTable* table : shape_family().tables) {
    Node node(*table);
    if (table->find("file")) ASSERT_TRUE(node.set("file", write_obj("shape_test.obj", cube_mesh())).ok());
    const auto shape = make_shape(node, meshes);
    ASSERT_TRUE(shape.ok()) << table->key;
    EXPECT_FALSE((*shape)->bounds().empty());
    EXPECT_FALSE(inside(**shape, {{0, 0, 0}, {0, 0, 1}}).empty()) << table->key << " does not hold its own origin";
  }
  Node ball(*shape_family().find("sphere"));
  ASSERT_TRUE(ball.set("center", Numbers{1, 2, 3}).ok());
  ASSERT_TRUE(ball.set("radius", 4.0).ok());
  EXPECT_EQ((*make_shape(ball, meshes))->bounds().high, Vec3d(5, 6, 7));
}

TEST(ShapeRegistry, ABoxWithoutVolumeIsRefusedByTheNameOfTheKey) {
  Node box(*shape_family().find("box"));
  ASSERT_TRUE(box.set("max", Numbers{1, -1, 1}).ok());
  FileCache<Mesh> meshes;
  const auto shape = make_shape(box, meshes);
  ASSERT_FALSE(shape.ok());
  EXPECT_EQ(shape.error().source.key, "max");
}

}  // namespace
}  // namespace brume
