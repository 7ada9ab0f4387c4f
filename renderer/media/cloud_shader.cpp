#include "renderer/media/cloud_shader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "renderer/core/check.h"
#include "renderer/media/registry.h"

// Highway includes this file once more for every SIMD level.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/media/cloud_shader.cpp"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace brume::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kBlock = 16;  // points that are skipped together; arrays are padded to this
using F = hn::CappedTag<float, kBlock>;
using VF = hn::Vec<F>;

/// Writes room = coverage - |q|^2, which is what the noise may carve from. At most 32 blocks.
/// @return bit b is set when some point of block b has room. What follows the last point counts too.
std::uint32_t find_room(const CloudShader::Shape& shape, const PointBatch& points, float* HWY_RESTRICT room) {
  const F f;
  const Affine& m = shape.q_from_scene;
  const auto coordinate = [f, &m](int axis, VF x, VF y, VF z) HWY_ATTR {
    const VF z_part = hn::MulAdd(hn::Set(f, m.row[axis].z), z, hn::Set(f, m.offset[axis]));
    return hn::MulAdd(hn::Set(f, m.row[axis].x), x, hn::MulAdd(hn::Set(f, m.row[axis].y), y, z_part));
  };
  const VF coverage = hn::Set(f, shape.coverage), minus_stretch = hn::Set(f, -shape.bottom_stretch);
  std::uint32_t has_room = 0;
  for (int block = 0; block < points.n; block += kBlock) {
    VF most = hn::Zero(f);
    for (int i = block; i < block + kBlock; i += static_cast<int>(hn::Lanes(f))) {
      const VF x = hn::LoadU(f, points.x + i), y = hn::LoadU(f, points.y + i), z = hn::LoadU(f, points.z + i);
      const VF qx = coordinate(0, x, y, z), qy = coordinate(1, x, y, z), qz = coordinate(2, x, y, z);
      const VF height = hn::Max(qz, hn::Mul(qz, minus_stretch));  // |q_z|, stretched below
      const VF square = hn::MulAdd(qx, qx, hn::MulAdd(qy, qy, hn::Mul(height, height)));
      const VF r = hn::Sub(coverage, square);
      hn::StoreU(r, f, room + i);
      most = hn::Max(r, most);
    }
    if (!hn::AllTrue(f, hn::Le(most, hn::Zero(f)))) has_room |= 1u << (block / kBlock);
  }
  return has_room;
}

/// Turns noise into density where it stands.
void carve(const CloudShader::Shape& shape, const float* HWY_RESTRICT room, int n, float* HWY_RESTRICT noise) {
  const F f;
  const VF zero = hn::Zero(f), half = hn::Set(f, 0.5f), one = hn::Set(f, 1.0f);
  const VF roughness = hn::Set(f, shape.roughness), inv_softness = hn::Set(f, shape.inv_softness);
  for (int i = 0; i < n; i += static_cast<int>(hn::Lanes(f))) {
    const VF erosion = hn::Min(hn::Max(hn::NegMulAdd(half, hn::LoadU(f, noise + i), half), zero), one);
    const VF left = hn::NegMulAdd(roughness, erosion, hn::LoadU(f, room + i));
    hn::StoreU(hn::Min(hn::Max(hn::Mul(left, inv_softness), zero), one), f, noise + i);
  }
}

}  // namespace
}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {
namespace {

HWY_EXPORT(find_room);
HWY_EXPORT(carve);

constexpr int kPadding = 16;           // as in shader.h
constexpr int kChunk = 32 * kPadding;  // points whose room stays on the stack: as many blocks as a word has bits

/// Half the wavelength of the highest octave, limited: see traits().
double finest_scale(const Affined& local_from_scene, const CloudSettings& settings) {
  const auto scene_from_local = inverse(local_from_scene);
  BRUME_CHECK(scene_from_local.has_value(), ==, true);
  const double highest = settings.noise.frequency * std::pow(settings.noise.lacunarity, settings.noise.octaves - 1);
  double wavelength = std::numeric_limits<double>::infinity(), diameter = wavelength;
  for (int axis = 0; axis < 3; ++axis) {
    const double unit = length(scene_from_local->axis(axis));
    wavelength = std::min(wavelength, unit / highest);
    diameter = std::min(diameter, unit * 2 * settings.size[axis]);
  }
  return std::max(wavelength / 2, diameter / 100);
}

}  // namespace

CloudShader::CloudShader(const Affined& local_from_scene, const CloudSettings& settings)
    : noise_(local_from_scene.cast<float>(), settings.noise),
      finest_scale_(static_cast<float>(finest_scale(local_from_scene, settings))) {
  const Vec3d size(settings.size), center(settings.center);
  const Affined q_from_local = scaling({1 / size.x, 1 / size.y, 1 / size.z}) * translation(-center);
  shape_ = {.q_from_scene = (q_from_local * local_from_scene).cast<float>(),
            .bottom_stretch = 1 / (1 - settings.flat_bottom),
            .coverage = settings.coverage,
            .roughness = settings.roughness,
            .inv_softness = 1 / settings.softness};
}

void CloudShader::density(const PointBatch& points, float* density) const {
  alignas(64) float room[kChunk];
  for (int first = 0; first < points.n; first += kChunk) {
    const int n = std::min(kChunk, points.n - first);
    const PointBatch chunk{points.x + first, points.y + first, points.z + first, n, points.time};
    float* const out = density + first;
    // Bit by bit from the low end: runs of blocks with room, and runs without.
    const std::uint32_t has_room = HWY_DYNAMIC_DISPATCH(find_room)(shape_, chunk, room);
    for (int begin = 0; begin < n;) {
      const std::uint32_t rest = has_room >> (begin / kPadding);
      const bool empty = (rest & 1) == 0;
      const int count = std::min(kPadding * (empty ? std::countr_zero(rest) : std::countr_one(rest)), n - begin);
      if (empty) {
        std::fill_n(out + begin, count, 0.0f);
      } else {
        noise_.evaluate({chunk.x + begin, chunk.y + begin, chunk.z + begin, count, points.time}, out + begin);
        HWY_DYNAMIC_DISPATCH(carve)(shape_, room + begin, count, out + begin);
      }
      begin += count;
    }
  }
}

namespace {

Result<MadeShader> make_cloud_shader(const Node& volume, const ShaderContext& context) {
  if (!inverse(context.local_from_scene))
    return bad_input("found a transform that flattens space, expected an invertible one", {"", 0, 0, "transform"});
  const auto real = [&volume](const char* key) { return static_cast<float>(volume.number(key)); };
  CloudSettings settings;
  settings.center = Vec3(volume.vec3("center"));
  settings.size = Vec3(volume.vec3("size"));
  settings.coverage = real("coverage");
  settings.flat_bottom = real("flat_bottom");
  settings.roughness = real("roughness");
  settings.softness = real("softness");
  settings.noise = {.frequency = real("frequency"),
                    .octaves = volume.integer("octaves"),
                    .lacunarity = real("lacunarity"),
                    .gain = real("gain"),
                    .seed = static_cast<std::uint32_t>(volume.integer("seed")),
                    .billow = real("billow")};
  return MadeShader{std::make_shared<CloudShader>(context.local_from_scene, settings)};
}

}  // namespace

ShaderType cloud_shader_type() {
  using namespace param;
  return {
      "cloud",
      "Cloud",
      "A procedural cumulus cloud, carved out of an ellipsoid by fractal noise; z is up.",
      {point("center", "Centre", 0, 0, 0).says("Centre of the ellipsoid."),
       vector("size", "Half extents", 1, 0.8, 0.6)
           .more_than(0)
           .slider(0.1, 10)
           .in("world units")
           .says("Half extents of the ellipsoid that holds the cloud."),
       number("coverage", "Coverage", 1).between(0, 1).says("How much cloud is left: less thins out the border first."),
       number("flat_bottom", "Flat bottom", 0.8)
           .between(0, 0.99)
           .says("Share of the lower half's height that is taken away."),
       number("roughness", "Roughness", 1)
           .between(0, 4)
           .slider(0, 2)
           .says("How deep the noise carves; 0 leaves a smooth ellipsoid."),
       number("softness", "Softness", 0.15)
           .between(0.001, 1)
           .log_slider(0.01, 1)
           .says("Width of the border over which the density rises from 0 to 1."),
       number("frequency", "Frequency", 1.6)
           .more_than(0)
           .log_slider(0.1, 20)
           .in("cycles/world unit")
           .says("Frequency of the largest lumps."),
       integer("octaves", "Octaves", 7).between(1, 12).slider(1, 12).says("Sizes of lumps, each finer than the last."),
       number("lacunarity", "Lacunarity", 2.1).between(1, 4).slider(1.5, 3).says("Ratio of neighbouring frequencies."),
       number("gain", "Gain", 0.55).between(0, 1).says("Ratio of neighbouring amplitudes: more is rougher in detail."),
       number("billow", "Billow", 1).between(0, 1).says("From smooth swells (0) to round lumps between creases (1)."),
       integer("seed", "Seed", 8).between(0, 2147483647).slider(0, 100).says("Which of many clouds of the same kind.")},
      false,
      make_cloud_shader,
      true};
}

}  // namespace brume
#endif  // HWY_ONCE
