#include <gtest/gtest.h>

#include "renderer/scene/framing.h"
#include "renderer/scene/volume.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

Result<std::shared_ptr<const Scene>> try_commit(const Node& description) {
  SceneCache cache;
  return commit(description, cache, {});
}

TEST(Commit, AnEmptyDescriptionIsAScene) {
  const auto scene = committed(empty_scene(), 7);
  EXPECT_EQ(scene->generation, 7u);
  EXPECT_TRUE(scene->bounds.empty());
  EXPECT_EQ(scene->origin, Vec3d(0));
  EXPECT_EQ(scene->needs.channels, 1);
  EXPECT_FALSE(scene->needs.emission || scene->needs.overlap || scene->needs.lookups || scene->needs.equiangular);
  EXPECT_GT(scene->step_size, 0);
}

TEST(Commit, AsksForNoMoreThanTheSceneNeeds) {
  Node description = empty_scene();
  set(add_volume(description, "homogeneous"), "albedo", "0.5,0.5,0.5");
  set(description, "volumes.0.emission_color", "1,0,0");
  EXPECT_EQ(committed(description)->needs.channels, 1);
  EXPECT_FALSE(committed(description)->needs.emission) << "emission_scale is 0";
  set(description, "volumes.0.emission_scale", "2");
  EXPECT_TRUE(committed(description)->needs.emission);
  EXPECT_EQ(committed(description)->needs.channels, 1) << "colour of the glow needs no channels of the transport";
  set(description, "volumes.0.albedo", "0.5,0.6,0.5");
  EXPECT_EQ(committed(description)->needs.channels, 3);
  add_volume(description, "gaussian");
  EXPECT_TRUE(committed(description)->needs.overlap && committed(description)->needs.lookups);
  set(description, "volumes.1.enabled", "false");
  EXPECT_FALSE(committed(description)->needs.overlap || committed(description)->needs.lookups);
  add_light(description, "directional");
  add_light(description, "environment");
  EXPECT_FALSE(committed(description)->needs.equiangular);
  add_light(description, "quad");
  EXPECT_TRUE(committed(description)->needs.equiangular);
  set(description, "lights.2.enabled", "false");
  EXPECT_FALSE(committed(description)->needs.equiangular);
  EXPECT_EQ(committed(description)->lights.size(), 2u);
}

TEST(Commit, LightsAreLargeWhereTheyLookLargerThanThePhaseFunctionIsWide) {
  Node description = empty_scene();
  Node& v = add_volume(description, "homogeneous");
  set(v, "phase.type", "henyey_greenstein");
  set(v, "phase.g", "0.9");
  set(add_light(description, "quad"), "corner", "0,0,1000");
  add_light(description, "point");
  EXPECT_FALSE(committed(description)->needs.large_lights) << "far away, and a point";
  set(description, "lights.0.corner", "0,0,0");
  EXPECT_TRUE(committed(description)->needs.large_lights) << "inside the medium";
  set(description, "volumes.0.phase.g", "0");
  EXPECT_FALSE(committed(description)->needs.large_lights) << "no light is wider than all directions";
  set(description, "lights.0.enabled", "false");
  set(description, "volumes.0.phase.g", "0.9");
  EXPECT_FALSE(committed(description)->needs.large_lights) << "switched off";
  set(add_light(description, "directional"), "angular_diameter_deg", "120");
  EXPECT_TRUE(committed(description)->needs.large_lights) << "half of the sky";
}

TEST(Commit, CoefficientsComeFromTheAlbedoUnlessTheyAreGiven) {
  Node description = empty_scene();
  Node& v = add_volume(description, "homogeneous");
  set(v, "density_scale", "4");
  set(v, "albedo", "0.25,0.5,1");
  EXPECT_EQ(committed(description)->media[0].sigma_s, Color(1, 2, 4));
  EXPECT_EQ(committed(description)->media[0].sigma_t, Color(4));
  set(v, "sigma_s", "1,2,3");
  EXPECT_EQ(committed(description)->media[0].sigma_s, Color(4, 8, 12));
  EXPECT_EQ(committed(description)->media[0].sigma_t, Color(7, 10, 12));  // absorption is still 1 - albedo
  set(v, "sigma_a", "0,0,1");
  EXPECT_EQ(committed(description)->media[0].sigma_t, Color(4, 8, 16));
  set(v, "emission_scale", "3");
  set(v, "emission_color", "1,0.5,0");
  EXPECT_EQ(committed(description)->media[0].emission, Color(3, 1.5f, 0))
      << "emission is not multiplied by the density scale";
}

TEST(Commit, AutomaticStepIsTheFinestScaleAndTheShadowStepFollowsTheStep) {
  Node description = empty_scene();
  set(add_volume(description, "gaussian"), "sigma", "0.8");
  set(add_volume(description, "gaussian"), "sigma", "0.4");
  EXPECT_FLOAT_EQ(committed(description)->step_size, 0.05f);
  EXPECT_FLOAT_EQ(committed(description)->shadow_step_size, 0.05f);
  set(description, "render.step_size", "0.2");
  EXPECT_FLOAT_EQ(committed(description)->step_size, 0.2f);
  EXPECT_FLOAT_EQ(committed(description)->shadow_step_size, 0.2f);
  set(description, "render.shadow_step_size", "0.6");
  EXPECT_FLOAT_EQ(committed(description)->step_size, 0.2f);
  EXPECT_FLOAT_EQ(committed(description)->shadow_step_size, 0.6f);
}

TEST(Commit, AMatrixIsTheSameAsItsScaleRotationAndShift) {
  Node description = empty_scene();
  Node& v = add_volume(description, "homogeneous");
  set(v, "transform.scale", "2,-1,0.5");
  set(v, "transform.rotate_deg", "30,-60,100");
  set(v, "transform.translate", "1,2,-3");
  const auto by_parts = committed(description);
  const Affined m = translation({1, 2, -3}) * rotation_deg({30, -60, 100}) * scaling({2, -1, 0.5});
  Numbers matrix;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) matrix.push_back(j < 3 ? m.row[i][j] : m.offset[i]);
  matrix.insert(matrix.end(), {0, 0, 0, 1});
  set(v, "transform.matrix", format_value(matrix));
  set(v, "transform.scale", "1,1,1");  // the matrix replaces the three
  const auto by_matrix = committed(description);
  const Affine& a = by_parts->media[0].shape_from_scene;
  const Affine& b = by_matrix->media[0].shape_from_scene;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(length(a.row[i] - b.row[i]), 0, 1e-6f);
  EXPECT_NEAR(length(a.offset - b.offset), 0, 1e-6f);
  EXPECT_NEAR(length(by_parts->bounds.low - by_matrix->bounds.low), 0, 1e-12);
  // And it is the inverse: a corner of the unit box lands on the corner of the shape.
  EXPECT_NEAR(length(a.point(Vec3(m.point({1, -1, 1}))) - Vec3(1, -1, 1)), 0, 2e-6f);
}

TEST(Commit, NearTheOriginCoordinatesStayAndFarAwayTheSceneMovesToItsMedia) {
  Node description = empty_scene();
  Node& v = add_volume(description, "homogeneous");
  set(v, "transform.translate", "20,0,0");  // the diagonal is 3.5
  EXPECT_EQ(committed(description)->origin, Vec3d(0));
  set(v, "transform.translate", "1000000,-2000000,0");
  set(description, "camera.position", "1000000,-2000005,1");
  set(description, "camera.look_at", "1000000,-2000000,0");
  const auto far = committed(description);
  EXPECT_EQ(far->origin, Vec3d(1e6, -2e6, 0));
  EXPECT_NEAR(length(far->bounds.low - Vec3d(-1, -1, -1)), 0, 1e-9);
  EXPECT_NEAR(length(far->camera.ray(0.5f, 0.5f, 1).origin - Vec3(0, -5, 1)), 0, 1e-6f);
}

// G4 and O10 of the catalogue: the same scene, a million units away and ten times its own size from there.
TEST(Commit, ASceneFarAwayLooksTheSame) {
  const auto scene_at = [](Vec3d at, int seed) {
    Node description = empty_scene();
    set(description, "render.sampler", "independent");
    set(description, "render.seed", std::to_string(seed));
    Node& v = add_volume(description, "gaussian");
    set(v, "transform.translate", format_value(Numbers{at.x, at.y, at.z}));
    set(v, "density_scale", "4");
    set(add_light(description, "point"), "position", format_value(Numbers{at.x + 0.5, at.y - 1, at.z + 2}));
    set(description, "camera.position", format_value(Numbers{at.x, at.y - 5, at.z + 1}));
    set(description, "camera.look_at", format_value(Numbers{at.x, at.y, at.z}));
    return committed(description);
  };
  const auto here = scene_at({}, 1), far = scene_at({1e6, -3e6, 2e6}, 1);
  const Ray a = here->camera.ray(0.45f, 0.55f, 1), b = far->camera.ray(0.45f, 0.55f, 1);
  const RayEstimate near_light = estimate(*here, a, 4000, 2), far_light = estimate(*far, b, 4000, 2);
  // The same random numbers, so only rounding differs: 1e6 in double leaves 1e-10, the directions are float.
  EXPECT_NEAR(far_light.mean() / near_light.mean(), 1, 1e-4);
}

TEST(Commit, ErrorsNameTheKeyInTheWholeDescription) {
  Node description = empty_scene();
  set(add_volume(description, "homogeneous"), "name", "plume");
  set(add_light(description, "quad"), "edge_v", "0,1,0");  // along edge_u
  EXPECT_EQ(try_commit(description).error().source.key, "lights.0.edge_v");
  set(description, "lights.0.enabled", "false");
  EXPECT_TRUE(try_commit(description).ok());
  set(description, "volumes.plume.bounds.max", "-5,1,1");
  EXPECT_EQ(try_commit(description).error().source.key, "volumes.plume.bounds.max");
  set(description, "volumes.plume.bounds.max", "1,1,1");
  set(description, "volumes.plume.transform.scale", "1,0,1");
  EXPECT_EQ(try_commit(description).error().source.key, "volumes.plume.transform.scale");
  set(description, "volumes.plume.transform.scale", "1,1,1");
  set(description, "camera.up", "0,0,0");
  EXPECT_EQ(try_commit(description).error().source.key, "camera.up");
}

TEST(Commit, EveryKindOfVolumeAndLightCanBeCommittedFromItsDefaults) {
  for (const ParamTable* table : volume_family().tables) {
    bool needs_a_file = false;
    for (const Param& p : table->params) needs_a_file |= p.required;
    Node description = empty_scene();
    add_volume(description, table->key);
    const auto scene = try_commit(description);
    EXPECT_EQ(scene.ok(), !needs_a_file) << table->key;
    if (!scene.ok()) continue;
    const RayEstimate e = estimate(**scene, (*scene)->camera.ray(0.5f, 0.5f, 1), 10);
    EXPECT_EQ(e.non_finite, 0u) << table->key;
    EXPECT_GT(e.statistics.march.segments, 0u) << table->key << " is not where a default camera looks";
  }
}

TEST(FrameBounds, PutsTheWholeSphereRoundTheBoundsIntoThePicture) {
  for (const double aspect : {0.5, 1.0, 2.0}) {
    Node camera(*camera_family().tables.front());
    const Bounds3 bounds{{10, 20, 30}, {14, 22, 31}};
    frame_bounds(camera, bounds, aspect);
    const auto made = make_camera(camera, {});
    ASSERT_TRUE(made.ok());
    const Ray middle = made->ray(0.5f, 0.5f, static_cast<float>(aspect));
    const Vec3d to_center = bounds.center() - Vec3d(middle.origin);
    EXPECT_NEAR(length(cross(normalize(to_center), Vec3d(middle.direction))), 0, 2e-3);  // four digits of the position
    // All corners are inside the picture.
    const Vec3d forward = normalize(to_center);
    const double half = std::tan(camera.number("vfov_deg") * 3.14159265 / 360);
    for (int i = 0; i < 8; ++i) {
      const Vec3d to_corner = bounds.corner(i) - Vec3d(middle.origin);
      const double depth = dot(to_corner, forward), aside = length(to_corner - forward * depth);
      EXPECT_LT(aside / depth, half * std::min(1.0, aspect) * 1.15);
    }
  }
}

}  // namespace
}  // namespace brume
