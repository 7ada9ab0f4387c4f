// A scene that is turned, scaled, mirrored or moved as a whole, with its lights and its camera, looks the same.
#include <gtest/gtest.h>

#include "renderer/march/shadow_march.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

constexpr int kWidth = 16, kHeight = 12, kBlock = 4;

struct Whole {
  const char* what;
  Affined map;
  double scale;  // lengths grow by this
};

std::string text_of(Vec3d v) { return format_value(Numbers{v.x, v.y, v.z}); }

std::string matrix_text(const Affined& m) {
  Numbers n;
  for (int i = 0; i < 3; ++i) n.insert(n.end(), {m.row[i].x, m.row[i].y, m.row[i].z, m.offset[i]});
  n.insert(n.end(), {0, 0, 0, 1});
  return format_value(n);
}

void add_volume_at(Node& scene, const Whole& whole, const std::string& shader, double density,
                   const std::string& albedo) {
  Node& v = add_volume(scene, shader);
  set(v, "transform.matrix", matrix_text(whole.map));
  set(v, "density_scale", format_value(density / whole.scale));
  set(v, "albedo", albedo);
  set(v, "phase.type", "henyey_greenstein");
  set(v, "phase.g", "0.4");
}

/// Two overlapping media without any symmetry, four kinds of light, everything carried along by `whole`.
std::shared_ptr<const Scene> scene_under(const Whole& whole, int seed) {
  const Affined& m = whole.map;
  Node scene = empty_scene();
  set(scene, "render.sampler", "independent");
  set(scene, "render.seed", std::to_string(seed));
  set(scene, "render.bounces", "1");
  set(scene, "render.light_samples", "2");
  set(scene, "render.step_size", format_value(0.05 * whole.scale));
  set(scene, "camera.position", text_of(m.point({1, -4, 1.5})));
  set(scene, "camera.look_at", text_of(m.point({0, 0, 0.1})));
  set(scene, "camera.up", text_of(m.vector({0, 0, 1})));
  add_volume_at(scene, whole, "linear", 1.5, "0.9,0.7,0.5");
  set(scene, "volumes.0.gradient", "0.3,0.2,0.4");
  set(scene, "volumes.0.emission_scale", format_value(0.05 / whole.scale));
  add_volume_at(scene, whole, "homogeneous", 0.8, "0.3,0.8,0.9");
  set(scene, "volumes.1.bounds.min", "-1.5,-0.3,-0.6");
  set(scene, "volumes.1.bounds.max", "0.4,0.9,1.4");

  Node& lamp = add_light(scene, "point");
  set(lamp, "position", text_of(m.point({0.3, -0.4, 1.9})));
  set(lamp, "intensity", format_value(Numbers(3, 2 * whole.scale * whole.scale)));
  Node& quad = add_light(scene, "quad");
  const bool mirrored = m.determinant() < 0;  // cross(edge_u, edge_v) then points the other way
  set(quad, "corner", text_of(m.point({-2, -1, -1})));
  set(quad, mirrored ? "edge_v" : "edge_u", text_of(m.vector({0, 1, 0})));
  set(quad, mirrored ? "edge_u" : "edge_v", text_of(m.vector({0, 0, 1.5})));
  Node& sun = add_light(scene, "directional");
  set(sun, "direction", text_of(m.vector({-1, 0.4, -0.3})));
  set(sun, "irradiance", "0.3,0.5,0.7");
  set(add_light(scene, "environment"), "radiance", "0.05,0.02,0.01");
  return committed(scene);
}

Film picture_of(const Scene& scene) {
  WorkerPool pool;
  Film film(kWidth, kHeight);
  render_batch(scene, 200, film, pool);
  return film;
}

/// Mean of a block of pixels and its variance; `mirrored` counts the columns from the right.
std::pair<double, double> block(const Film& film, int column, int row, int channel, bool mirrored) {
  double sum = 0, variance = 0;
  for (int y = row * kBlock; y < (row + 1) * kBlock; ++y)
    for (int x = column * kBlock; x < (column + 1) * kBlock; ++x) {
      const int from = mirrored ? kWidth - 1 - x : x;
      sum += double(film.mean(from, y)[channel]);
      variance += double(film.variance(from, y)[channel]);
    }
  const double n = kBlock * kBlock;
  return {sum / n, variance / (n * n)};
}

// O10 of the catalogue.
TEST(Invariance, PicturesOfTurnedScaledMirroredAndMovedScenesAreTheSame) {
  const Whole same{"as it is", {}, 1};
  const Whole wholes[] = {
      {"turned", rotation_deg({30, -50, 70}), 1},
      {"three times the size", scaling({3, 3, 3}), 3},
      {"a hundredth of the size", scaling({0.01, 0.01, 0.01}), 0.01},
      {"mirrored", scaling({-1, 1, 1}), 1},
      {"moved a little", translation({20, -10, 5}), 1},
      {"turned and moved by a million", translation({1e6, -2e6, 3e6}) * rotation_deg({-20, 140, 80}), 1},
      {"mirrored, scaled, turned and moved", translation({3, 4, 5}) * rotation_deg({10, 20, 30}) * scaling({2, -2, 2}),
       2}};
  const Film reference = picture_of(*scene_under(same, 1));
  const int columns = kWidth / kBlock, rows = kHeight / kBlock;
  const double bound = sidak_z(1e-3, static_cast<int>(std::size(wholes)) * columns * rows * 3);
  int seed = 2;
  double largest = 0;
  for (const Whole& whole : wholes) {
    const Film film = picture_of(*scene_under(whole, seed++));
    const bool mirrored = whole.map.determinant() < 0;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column)
        for (int c = 0; c < 3; ++c) {
          const auto [a, variance_a] = block(reference, column, row, c, false);
          const auto [b, variance_b] = block(film, column, row, c, mirrored);
          const double z = (a - b) / std::sqrt(variance_a + variance_b);
          largest = std::max(largest, std::abs(z));
          EXPECT_LT(std::abs(z), bound) << whole.what << ", block " << column << ' ' << row << ", channel " << c << ": "
                                        << a << " and " << b;
        }
  }
  // The test can tell pictures apart at all: half a block to the side is another picture.
  const Film turned = picture_of(*scene_under({"a few degrees off", rotation_deg({0, 0, 0}), 1.1}, 50));
  double difference = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const auto [a, variance_a] = block(reference, column, row, 0, false);
      const auto [b, variance_b] = block(turned, column, row, 0, false);
      difference = std::max(difference, std::abs(a - b) / std::sqrt(variance_a + variance_b));
    }
  EXPECT_GT(difference, bound) << "a scene of other coefficients passes, too";
  std::printf("largest |z| of %d blocks: %.2f (allowed %.2f); of another scene: %.1f\n",
              static_cast<int>(std::size(wholes)) * columns * rows * 3, largest, bound, difference);
}

// O10 of the catalogue: transmittance is a matter of lengths in the world, whatever the map of the volume does to them.
TEST(Invariance, TransmittanceUnderAnyAffineMapIsThatOfTheLengthInTheWorld) {
  const Affined shear{{{1, 0.7, -0.3}, {0, 1, 0.5}, {0, 0, 1}}, {0.2, -0.1, 0.3}};
  const std::pair<const char*, Affined> maps[] = {
      {"scaled unequally", scaling({3, 0.2, 1})},
      {"turned", rotation_deg({25, 60, -100})},
      {"mirrored", scaling({1, -1, 1})},
      {"sheared", shear},
      {"all at once", translation({2, 1, -1}) * rotation_deg({5, 60, 20}) * shear * scaling({-2, 0.5, 1})},
      {"and a million away",
       translation({1e6, 1e6, -1e6}) * rotation_deg({5, 60, 20}) * shear * scaling({-2, 0.5, 1})}};
  for (const auto& [what, map] : maps)
    for (const char* shader : {"homogeneous", "linear"}) {  // the ramp is level: marched, but the same medium
      Node description = empty_scene();
      Node& v = add_volume(description, shader);
      if (std::string(shader) == "linear") set(v, "gradient", "0,0,0");
      set(v, "transform.matrix", matrix_text(map));
      set(v, "sigma_s", "0,0,0");
      set(v, "sigma_a", "0.7,0.7,0.7");
      const auto scene = committed(description);
      int met = 0;
      for (std::uint32_t i = 0; i < 200; ++i) {
        // From outside through a random point of the volume.
        const Sampler sampler(SamplerKind::Independent, 3, i, 0);
        const auto number = [&](int k) { return 2 * double(sampler.u1(Decision::Pixel, k)) - 1; };
        const Vec3d target = map.point({0.9 * number(0), 0.9 * number(1), 0.9 * number(2)});
        const Vec3d direction(normalize(Vec3(Vec3d(number(3), number(4), number(5)))));
        const Vec3d origin = target - direction * 15.0;
        const Ray ray{Vec3(origin - scene->origin), Vec3(direction)};
        // The chord, in double: the ray carried into the unit box keeps its t. Its float origin is what is rendered.
        const Affined to_local = *inverse(map);
        const Vec3d o = to_local.point(Vec3d(ray.origin) + scene->origin), d = to_local.vector(direction);
        double begin = 0, end = 1e30;
        for (int axis = 0; axis < 3; ++axis) {
          const double a = (-1 - o[axis]) / d[axis], b = (1 - o[axis]) / d[axis];
          begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
        }
        if (end <= begin) continue;
        ++met;
        Arena arena;
        MarchCounts counts;
        const float tau = shadow_optical_depth<1>(scene->media, ray, {0.1f, 0.3f, 0}, arena, counts)[0];
        // Ends at t near 15 are floats 1e-6 apart; the map in float is off by 1e-7 of its entries, some 1e-5 of the
        // chord.
        ASSERT_NEAR(double(tau), 0.7 * (end - begin), 1e-4 * std::max(1.0, end - begin)) << what << ", ray " << i;
      }
      EXPECT_GT(met, 150);
    }
}

}  // namespace
}  // namespace brume
