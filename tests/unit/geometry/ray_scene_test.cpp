#include "renderer/geometry/ray_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/geometry/surface.h"
#include "tests/support/meshes.h"

namespace brume {
namespace {

std::shared_ptr<const RayScene> of(const TriangleMesh& mesh) {
  auto scene = RayScene::of(mesh);
  EXPECT_TRUE(scene.ok());
  return *scene;
}

TEST(RayScene, CubeIsHitFromAllSidesAtItsFace) {
  const auto scene = of(cube_mesh());
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        // Aimed a little past the centre, so that no ray runs along an edge.
        const Vec3 from =
            Vec3(5.0f * static_cast<float>(x), 5.0f * static_cast<float>(y), 5.0f * static_cast<float>(z));
        const Vec3 target{0.11f, 0.07f, -0.05f};
        const Ray ray{from, normalize(target - from)};
        const auto hit = scene->intersect(ray);
        ASSERT_TRUE(hit.has_value()) << x << ' ' << y << ' ' << z;
        const Vec3 p = ray.at(hit->t);
        EXPECT_NEAR(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1.0f, 1e-5f);
        EXPECT_LT(dot(hit->normal, ray.direction), 0) << "the face looks at the ray";
        EXPECT_TRUE(scene->occluded(ray));
      }
}

TEST(RayScene, NothingIsHitOutsideTheSpan) {
  const auto scene = of(cube_mesh());
  const Vec3 origin{0.1f, 0.2f, -5}, direction{0, 0, 1};
  EXPECT_FALSE(scene->occluded({origin, direction, {0, 3.9f}}));
  EXPECT_TRUE(scene->occluded({origin, direction, {0, 4.1f}}));
  EXPECT_FALSE(scene->intersect({origin, direction, {6.1f, 100}}).has_value());
  const auto exit = scene->intersect({origin, direction, {4.1f, 100}});
  ASSERT_TRUE(exit.has_value());
  EXPECT_NEAR(exit->t, 6, 1e-5f);
}

TEST(RayScene, ACrossedMeshIsGoneThroughInOrderAndASharedEdgeCountsOnce) {
  // The diagonal of a face is an edge of two triangles; so is the edge of the cube.
  const auto scene = of(joined(cube_mesh(), cube_mesh(0.5f), {0, 0, 3}));
  Arena arena;
  const ArenaScope scope(arena);
  for (const Vec3 origin : {Vec3{0.1f, 0.2f, -5}, Vec3{0, 0, -5}, Vec3{0.25f, 0.25f, -5}, Vec3{0.3f, -0.3f, -5}}) {
    const auto all = scene->crossings({origin, {0, 0, 1}}, arena);
    ASSERT_EQ(all.size(), 4u) << origin.x << ' ' << origin.y;
    const float expected[] = {4, 6, 7.5f, 8.5f};
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(all[i].t, expected[i], 1e-5f);
      EXPECT_EQ(all[i].entering, i % 2 == 0);
    }
  }
  EXPECT_EQ(scene->crossings({{0.1f, 0.2f, 0}, {0, 0, 1}, {0, 2}}, arena).size(), 1u);
}

TEST(RayScene, ManyCrossingsAreAllFound) {
  TriangleMesh comb;
  for (int i = 0; i < 100; ++i) comb = joined(comb, cube_mesh(0.25f), {static_cast<float>(i), 0, 0});
  const auto scene = of(comb);
  Arena arena;
  const ArenaScope scope(arena);
  EXPECT_EQ(scene->crossings({{-5, 0.01f, 0.02f}, {1, 0, 0}}, arena).size(), 200u);
}

TEST(RayScene, OfSeveralSurfacesTheNearestIsNamed) {
  const auto scene = RayScene::of({std::make_shared<SphereSurface>(Vec3d(0, 0, 4), 1.0),
                                   std::make_shared<PlaneSurface>(Vec3d(0, 0, 10), Vec3d(0, 0, -1)),
                                   std::make_shared<SphereSurface>(Vec3d(0, 0, 7), 1.0)});
  ASSERT_TRUE(scene.ok());
  const Ray ray{{0.1f, 0, 0}, {0, 0, 1}};
  const auto at = [&](float from) { return (*scene)->intersect({ray.origin, ray.direction, {from, 1000}}); };
  const std::pair<float, unsigned> expected[] = {{0, 0u}, {4, 0u}, {5.5f, 2u}, {7, 2u}, {9, 1u}};
  const float root = std::sqrt(0.99f), distances[] = {4 - root, 4 + root, 7 - root, 7 + root, 10};
  for (int i = 0; i < 5; ++i) {
    const auto hit = at(expected[i].first);
    ASSERT_TRUE(hit.has_value()) << i;
    EXPECT_EQ(hit->index, expected[i].second) << i;
    EXPECT_NEAR(hit->t, distances[i], 1e-6f) << i;
    EXPECT_TRUE((*scene)->occluded({ray.origin, ray.direction, {expected[i].first, distances[i] + 0.01f}}));
  }
  EXPECT_FALSE(at(10.5f).has_value());
  EXPECT_FALSE((*scene)->occluded({ray.origin, ray.direction, {8.5f, 9.5f}}));
}

}  // namespace
}  // namespace brume
