#include "renderer/camera/pinhole_camera.h"

#include <gtest/gtest.h>

namespace brume {
namespace {

constexpr float kAspect = 16.0f / 9;

TEST(PinholeCamera, MiddleOfTheFilmLooksAtTheTarget) {
  const Vec3 position{1, -5, 2}, target{-2, 3, 1};
  const Ray ray = PinholeCamera(position, target, {0, 0, 1}, 40).ray(0.5f, 0.5f, kAspect);
  EXPECT_EQ(ray.origin, position);
  EXPECT_NEAR(length(ray.direction - normalize(target - position)), 0, 2e-7f);
  EXPECT_EQ(ray.span.begin, 0);
  EXPECT_EQ(ray.span.end, std::numeric_limits<float>::infinity());
}

TEST(PinholeCamera, RowZeroIsAtTheTopAndColumnZeroAtTheLeft) {
  // Looking along +y with z up, +x is to the right.
  const PinholeCamera camera({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 90);
  EXPECT_GT(camera.ray(0.5f, 0.25f, 1).direction.z, 0.1f);
  EXPECT_LT(camera.ray(0.5f, 0.75f, 1).direction.z, -0.1f);
  EXPECT_LT(camera.ray(0.25f, 0.5f, 1).direction.x, -0.1f);
  EXPECT_GT(camera.ray(0.75f, 0.5f, 1).direction.x, 0.1f);
}

TEST(PinholeCamera, FieldOfViewIsTheWholeVerticalAngleAndPixelsAreSquare) {
  for (const float vfov : {1.0f, 40.0f, 120.0f, 178.0f}) {
    const PinholeCamera camera({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, vfov);
    const Vec3 top = camera.ray(0.5f, 0, kAspect).direction, right = camera.ray(1, 0.5f, kAspect).direction;
    const double half = double(vfov) * 3.14159265358979 / 360;
    EXPECT_NEAR(std::atan2(double(top.z), double(top.y)) / half, 1, 1e-6);
    EXPECT_NEAR(double(right.x / right.y) / (std::tan(half) * double(kAspect)), 1, 1e-5);
  }
}

TEST(PinholeCamera, DirectionsAreUnitAllOverTheFilm) {
  const PinholeCamera camera({3, 2, 1}, {0, 0, 0}, {0.3f, 0.2f, 1}, 100);
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 20; ++j)
      EXPECT_NEAR(length(camera.ray(static_cast<float>(i) / 20, static_cast<float>(j) / 20, kAspect).direction), 1,
                  2e-7f);
}

TEST(PinholeCamera, UpNeedNotBeUnitNorPerpendicular) {
  const PinholeCamera a({0, -4, 1}, {0, 0, 0}, {0, 0, 1}, 50), b({0, -4, 1}, {0, 0, 0}, {0, -3, 7}, 50);
  EXPECT_NEAR(length(a.ray(0.1f, 0.9f, 1).direction - b.ray(0.1f, 0.9f, 1).direction), 0, 5e-7f);
}

Node camera_node(Numbers position, Numbers look_at, Numbers up) {
  Node node(*camera_family().tables.front());
  EXPECT_TRUE(node.set("position", position).ok() && node.set("look_at", look_at).ok() && node.set("up", up).ok());
  return node;
}

TEST(MakeCamera, RefusesACameraThatLooksAtItselfOrAlongItsUpVector) {
  const auto itself = make_camera(camera_node({1, 2, 3}, {1, 2, 3}, {0, 0, 1}), {});
  ASSERT_FALSE(itself.ok());
  EXPECT_EQ(itself.error().source.key, "look_at");
  for (const Numbers& up : {Numbers{0, 0, 1}, Numbers{0, 0, -5}, Numbers{0, 0, 0}}) {
    const auto along = make_camera(camera_node({0, 0, 5}, {0, 0, 0}, up), {});
    ASSERT_FALSE(along.ok());
    EXPECT_EQ(along.error().source.key, "up");
  }
}

TEST(MakeCamera, FarFromTheWorldsOriginItKeepsItsDirections) {
  // Subtracting the origin of the scene in double leaves nothing of the million.
  const Vec3d far(1e6, 2e6, -3e6);
  const auto near_camera = make_camera(camera_node({0.25, -4, 1}, {0, 0, 0.5}, {0, 0, 1}), {});
  const auto far_camera =
      make_camera(camera_node({far.x + 0.25, far.y - 4, far.z + 1}, {far.x, far.y, far.z + 0.5}, {0, 0, 1}), far);
  ASSERT_TRUE(near_camera.ok() && far_camera.ok());
  const Ray a = near_camera->ray(0.2f, 0.7f, 1.5f), b = far_camera->ray(0.2f, 0.7f, 1.5f);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_NEAR(length(a.direction - b.direction), 0, 3e-7f);
}

TEST(MakeCamera, TheDistanceOfTheTargetDoesNotMatter) {
  const auto close_target = make_camera(camera_node({0, 0, 0}, {1e-6, 2e-6, 1e-6}, {0, 0, 1}), {});
  const auto far_target = make_camera(camera_node({0, 0, 0}, {1e9, 2e9, 1e9}, {0, 0, 1}), {});
  ASSERT_TRUE(close_target.ok() && far_target.ok());
  EXPECT_NEAR(length(close_target->ray(0.3f, 0.3f, 1).direction - far_target->ray(0.3f, 0.3f, 1).direction), 0, 3e-7f);
}

}  // namespace
}  // namespace brume
