#include "renderer/geometry/triangle_scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace brume {
namespace {

/// The cube [-1, 1]^3, faces outward.
TriangleMesh cube() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back({(i & 1) ? 1.0f : -1.0f, (i & 2) ? 1.0f : -1.0f, (i & 4) ? 1.0f : -1.0f});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(TriangleScene, CubeIsHitFromAllSidesAtItsFace) {
  const auto scene = TriangleScene::make({cube()});
  ASSERT_TRUE(scene.ok());
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        // Aimed a little past the centre, so that no ray runs along an edge.
        const Vec3 from =
            Vec3(5.0f * static_cast<float>(x), 5.0f * static_cast<float>(y), 5.0f * static_cast<float>(z));
        const Vec3 target{0.11f, 0.07f, -0.05f};
        const Ray ray{from, normalize(target - from)};
        const auto hit = (*scene)->intersect(ray);
        ASSERT_TRUE(hit.has_value()) << x << ' ' << y << ' ' << z;
        const Vec3 p = ray.at(hit->t);
        EXPECT_NEAR(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1.0f, 1e-5f);
        EXPECT_LT(dot(hit->normal, ray.direction), 0) << "the face looks at the ray";
        EXPECT_TRUE((*scene)->occluded(ray));
      }
}

TEST(TriangleScene, NothingIsHitOutsideTheSpan) {
  const auto scene = TriangleScene::make({cube()});
  ASSERT_TRUE(scene.ok());
  const Vec3 origin{0.1f, 0.2f, -5}, direction{0, 0, 1};
  EXPECT_FALSE((*scene)->occluded({origin, direction, {0, 3.9f}}));
  EXPECT_TRUE((*scene)->occluded({origin, direction, {0, 4.1f}}));
  EXPECT_FALSE((*scene)->intersect({origin, direction, {6.1f, 100}}).has_value());
  const auto exit = (*scene)->intersect({origin, direction, {4.1f, 100}});
  ASSERT_TRUE(exit.has_value());
  EXPECT_NEAR(exit->t, 6, 1e-5f);
}

TEST(TriangleScene, HitNamesMeshAndTriangle) {
  TriangleMesh far;
  far.vertices = {{-9, -9, 8}, {9, -9, 8}, {0, 9, 8}};
  far.triangles = {{0, 1, 2}};
  const auto scene = TriangleScene::make({cube(), far});
  ASSERT_TRUE(scene.ok());
  const auto hit = (*scene)->intersect({{0.1f, 0.1f, 3}, {0, 0, 1}});
  ASSERT_TRUE(hit.has_value());
  EXPECT_EQ(hit->mesh, 1u);
  EXPECT_EQ(hit->triangle, 0u);
}

TEST(TriangleScene, BadIndexAndVertexAreRefused) {
  TriangleMesh mesh = cube();
  mesh.triangles[3][1] = 8;
  const auto bad_index = TriangleScene::make({mesh});
  ASSERT_FALSE(bad_index.ok());
  EXPECT_NE(bad_index.error().message.find("vertex number 8"), std::string::npos);
  mesh = cube();
  mesh.vertices[2].y = NAN;
  EXPECT_FALSE(TriangleScene::make({mesh}).ok());
}

TEST(TriangleScene, EmptySceneHitsNothing) {
  const auto scene = TriangleScene::make({});
  ASSERT_TRUE(scene.ok());
  EXPECT_FALSE((*scene)->occluded({{0, 0, 0}, {0, 0, 1}}));
}

}  // namespace
}  // namespace brume
