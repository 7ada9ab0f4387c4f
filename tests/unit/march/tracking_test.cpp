#include "renderer/march/tracking.h"

#include <gtest/gtest.h>

#include "renderer/march/shadow_march.h"
#include "renderer/media/registry.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

/// A scene with one volume of the kind, made of its defaults.
Node scene_with(const std::string& shader) {
  Node scene = empty_scene();
  Node& volume = add_volume(scene, shader);
  set(volume, "density_scale", "3");
  if (shader == "vdb") set(volume, "file", BRUME_SOURCE_DIR "/scenes/vdb/smoke_plume_96_f050.vdb");
  return scene;
}

/// O4 of the catalogue. /// Majorants that are too low make a picture wrong in silence, so every shader's bound is held
/// against its density.
TEST(Majorants, NoShaderExceedsItsOwnBoundInAnyCell) {
  for (const ShaderType& type : shader_types()) {
    const auto scene = committed(scene_with(type.key));
    const Medium& medium = scene->media[0];
    const Vec3d low = scene->bounds.low, size = scene->bounds.extent();
    constexpr int kCells = 6, kPoints = 64;
    int tight = 0;
    for (int cell = 0; cell < kCells * kCells * kCells; ++cell) {
      const Vec3d corner(cell % kCells, cell / kCells % kCells, cell / kCells / kCells);
      const auto at = [&](Vec3d p) { return low + Vec3d(size.x * p.x, size.y * p.y, size.z * p.z) / double(kCells); };
      const Bounds3 box{at(corner), at(corner + Vec3d(1.0))};
      const float bound = medium.shader->max_density(box);
      ASSERT_TRUE(std::isfinite(bound)) << type.key;
      alignas(64) float x[kPoints], y[kPoints], z[kPoints], density[kPoints];
      for (int i = 0; i < kPoints; ++i) {
        const Sampler random(SamplerKind::Independent, 1, static_cast<std::uint32_t>(cell),
                             static_cast<std::uint32_t>(i));
        const Vec2 a = random.u2(Decision::Pixel), b = random.u2(Decision::LightPoint);
        const Vec3 p(at(corner + Vec3d(double(a.x), double(a.y), double(b.x))));
        x[i] = p.x, y[i] = p.y, z[i] = p.z;
      }
      medium.shader->density({x, y, z, kPoints, 0}, density);
      const float largest = *std::max_element(density, density + kPoints);
      ASSERT_LE(largest, bound * 1.00001f) << type.key << ", cell " << cell;
      tight += largest > 0.3f * bound;
    }
    EXPECT_GT(tight, 0) << type.key << ": the bound is nowhere near the density";
  }
}

TEST(Majorants, StretchesCoverTheRayInOrderAndMoreCellsBoundTighter) {
  Node scene = scene_with("vdb");
  const auto one = committed(scene);
  const Majorants fine(one->media, one->bounds, 24), coarse(one->media, one->bounds, 1);
  Arena arena;
  double saved = 0;
  for (std::uint32_t i = 0; i < 500; ++i) {
    const Sampler random(SamplerKind::Independent, 2, 0, i);
    const Vec3 origin(one->bounds.center() + Vec3d(5 * (double(random.u2(Decision::Pixel).x) - 0.5), -9.0, 0.3));
    const Vec3 target(one->bounds.low + Vec3d(one->bounds.extent().x * double(random.u2(Decision::LightPoint).x),
                                              one->bounds.extent().y * double(random.u2(Decision::LightPoint).y),
                                              one->bounds.extent().z * double(random.u2(Decision::Pixel).y)));
    const Ray ray{origin, normalize(target - origin)};
    const ArenaScope scope(arena);
    const auto whole = coarse.along(ray, arena), parts = fine.along(ray, arena);
    ASSERT_EQ(whole.size(), 1u);
    ASSERT_FALSE(parts.empty());
    EXPECT_NEAR(parts.front().span.begin, whole[0].span.begin, 1e-5f);
    EXPECT_NEAR(parts.back().span.end, whole[0].span.end, 1e-5f);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      EXPECT_LT(parts[k].span.begin, parts[k].span.end);
      EXPECT_EQ(parts[k].span.begin, k > 0 ? parts[k - 1].span.end : parts[k].span.begin);
      EXPECT_LE(parts[k].majorant.g, whole[0].majorant.g * 1.0001f);
      saved += double(whole[0].majorant.g - parts[k].majorant.g) * double(parts[k].span.length());
    }
  }
  EXPECT_GT(saved, 0);
}

/// Ratio tracking against the march, which is exact for these offsets on average, through grids and overlapping media.
TEST(Tracking, TransmittanceIsThatOfAVeryFineMarch) {
  Node description = scene_with("vdb");
  Node& ball = add_volume(description, "gaussian");
  set(ball, "density_scale", "0.7");
  set(ball, "transform.translate", "1,0.5,1");
  set(ball, "albedo", "0.2,0.5,0.9");
  const auto scene = committed(description);
  for (const int cells : {1, 20}) {
    const Majorants majorants(scene->media, scene->bounds, cells);
    Arena arena;
    MarchCounts counts;
    const Ray ray{{1, -6, 1.2f}, normalize(Vec3(0.01f, 1, 0.02f)), {0, 20}};
    const auto tau = shadow_optical_depth<3>(scene->media, ray, {1e-3f, 0.5f, 0}, arena, counts);
    RunningMean mean;
    for (std::uint32_t i = 0; i < 100000; ++i) {
      const Sampler random(SamplerKind::Independent, 3, 0, i);
      mean.add(double(
          ratio_tracking<3>(scene->media, majorants, ray, 0, {random, Decision::Flight, 0, 0}, arena, counts)[1]));
    }
    const double expected = std::exp(-double(tau[1]));
    EXPECT_GT(expected, 0.02);
    EXPECT_LT(expected, 0.9);
    EXPECT_NEAR(mean.mean(), expected, sidak_z(1e-3, 2) * mean.standard_error() + 1e-4) << cells << " cells";
  }
}

/// C1 of the catalogue: density 1 on a path of length 1, with a spike of height h over a tenth of it.
std::shared_ptr<const Scene> spike(const std::string& h) {
  Node scene = empty_scene();
  Node& v = add_volume(scene, "slabs");
  set(v, "bounds.min", "-1,-1,0");
  set(v, "bounds.max", "1,1,1");
  set(v, "axis", "z");
  set(v, "edges", "0,0.4,0.5,1");
  set(v, "values", "1," + h + ",1");
  return committed(scene);
}

/// O4: a majorant below the maximum is counted, and ratio tracking is right all the same; clamped at 0 its factors
/// would be 16, 57 and 185 % too bright.
TEST(Tracking, AMajorantThatIsTooLowIsCountedAndDoesNotBiasTheTransmittance) {
  const auto low = spike("1.5");
  for (const char* h : {"3", "6", "12"}) {
    const auto scene = spike(h);
    const Ray ray{{0, 0, -1}, {0, 0, 1}};
    Arena arena;
    MarchCounts counts;
    RunningMean mean;
    for (std::uint32_t i = 0; i < 400000; ++i) {
      const Sampler random(SamplerKind::Independent, 3, 0, i);
      mean.add(double(
          ratio_tracking<1>(scene->media, low->majorants, ray, 0, {random, Decision::Flight, 0, 0}, arena, counts)[0]));
    }
    const double expected = std::exp(-0.9 - 0.1 * std::atof(h));
    EXPECT_NEAR(mean.mean(), expected, sidak_z(1e-3, 3) * mean.standard_error()) << h;
    EXPECT_LT(mean.standard_error(), 0.1 * expected) << h;  // factors of 1 - h / 1.5 are noisy
    EXPECT_GT(counts.exceeded, 10000u) << h;
    EXPECT_EQ(counts.capped, 0u);
    MarchCounts right;
    for (std::uint32_t i = 0; i < 1000; ++i)
      ratio_tracking<1>(scene->media, scene->majorants, ray, 0,
                        {Sampler(SamplerKind::Independent, 3, 0, i), Decision::Flight, 0, 0}, arena, right);
    EXPECT_EQ(right.exceeded, 0u) << h;
  }
}

/// A majorant that nobody could walk through, with next to nothing there.
TEST(Tracking, FlightsOfARayAreBounded) {
  const auto thin = spike("0.5");
  const Ray ray{{0, 0, -1}, {0, 0, 1}};
  for (const char* h : {"1e9", "1e20", "3e38"}) {
    Arena arena;
    MarchCounts counts;
    RunningMean mean;
    for (std::uint32_t i = 0; i < 20; ++i)
      mean.add(double(ratio_tracking<1>(thin->media, spike(h)->majorants, ray, 0,
                                        {Sampler(SamplerKind::Independent, 3, 0, i), Decision::Flight, 0, 0}, arena,
                                        counts)[0]));
    EXPECT_NEAR(mean.mean(), std::exp(-0.95), 0.01) << h;
    EXPECT_EQ(counts.capped, 20u);
    EXPECT_LT(counts.lookups, 20u * 3 * kMaxFlights);
  }
}

}  // namespace
}  // namespace brume
