// What the low-discrepancy sampler is worth against independent numbers, on a scene that ships.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/support/scenes.h"

namespace brume {
namespace {

constexpr int kWidth = 64, kHeight = 64, kBlock = 4;

Film rendered(const char* sampler, int passes, int seed) {
  Node description = shipped_scene("smoke");
  set(description, "render.sampler", sampler);
  set(description, "render.seed", std::to_string(seed));
  set(description, "render.bounces", "0");
  set(description, "render.light_samples", "4");
  set(description, "camera.vfov_deg", "16");  // smoke in all pixels
  const auto scene = committed(description);
  WorkerPool pool;
  Film film(kWidth, kHeight);
  render_batch(*scene, passes, film, pool);
  return film;
}

struct Errors {
  double pixels = 0;            // mean squared error of pixels
  double blocks = 0;            // of the means of blocks of pixels
  double right = 0, below = 0;  // mean product of the errors of neighbours in a block
};

Errors errors(const Film& film, const Film& truth) {
  Errors e;
  for (int by = 0; by < kHeight; by += kBlock)
    for (int bx = 0; bx < kWidth; bx += kBlock) {
      double sum = 0;
      for (int y = by; y < by + kBlock; ++y)
        for (int x = bx; x < bx + kBlock; ++x) {
          const double error = static_cast<double>(luminance(film.mean(x, y)) - luminance(truth.mean(x, y)));
          e.pixels += error * error;
          const auto error_at = [&](int i, int j) {
            return static_cast<double>(luminance(film.mean(i, j)) - luminance(truth.mean(i, j)));
          };
          if (x % 2 == 0) e.right += 2 * error * error_at(x + 1, y);
          if (y % 2 == 0) e.below += 2 * error * error_at(x, y + 1);
          sum += error;
        }
      e.blocks += sum * sum / (kBlock * kBlock * kBlock * kBlock);
    }
  for (double* sum : {&e.pixels, &e.right, &e.below}) *sum /= kWidth * kHeight;
  e.blocks /= kWidth * kHeight / (kBlock * kBlock);
  return e;
}

TEST(SamplerGain, SobolPointsBeatIndependentNumbersMoreWithEveryPass) {
  const Film truth = rendered("sobol", 512, 99);
  double gain_before = 1;
  for (const int passes : {1, 4, 16, 64}) {
    Errors sobol, independent;
    for (const int seed : {1, 2, 3, 4}) {
      const Errors s = errors(rendered("sobol", passes, seed), truth);
      const Errors i = errors(rendered("independent", passes, seed), truth);
      sobol.pixels += s.pixels, sobol.blocks += s.blocks, sobol.right += s.right, sobol.below += s.below;
      independent.pixels += i.pixels, independent.blocks += i.blocks;
    }
    const double gain = independent.pixels / sobol.pixels, blue = sobol.pixels / 16 / sobol.blocks;
    const double right = sobol.right / sobol.pixels, below = sobol.below / sobol.pixels;
    std::printf(
        "%2d passes: variance %.1f times below independent numbers; of 4x4 pixels, %.1f times below white noise; "
        "neighbours correlate %+.2f to the right, %+.2f below\n",
        passes, gain, blue, right, below);
    // Whatever is shared out, neighbours must not err alike: that would be seen as a texture.
    EXPECT_LT(right, 0.15);
    EXPECT_LT(below, 0.15);
    // Samples of one march are spread in both; it is over the passes that the sequence pays.
    EXPECT_GT(gain, passes == 1 ? 0.9 : 1.3 * gain_before);
    // White noise averages out as 1 over the number of pixels; noise that neighbours share out does so faster.
    if (passes == 1) EXPECT_GT(blue, 2);
    // Independent numbers have no such thing: the yardstick of the sentence above.
    EXPECT_NEAR(independent.pixels / 16 / independent.blocks, 1, 0.25);
    gain_before = gain;
  }
}

/// Seen deviations of the pixels, mean of |error| sqrt(pi/2), over the mean of the picture.
TEST(SamplerGain, NoiseIsEstimatedFromIndependentRandomisationsAndSoForSobolPointsToo) {
  const Film truth = rendered("sobol", 512, 99);
  for (const char* sampler : {"sobol", "independent"})
    for (const int passes : {1, 16}) {
      double estimated = 0, seen = 0, scatter = 0;
      constexpr int kRuns = 8;  // 64 twins each
      for (int run = 0; run < kRuns; ++run) {
        const Film film = rendered(sampler, passes, run);
        estimated += film.noise_estimate() / kRuns;
        double error = 0, light = 0, of_samples = 0;
        for (int y = 0; y < kHeight; ++y)
          for (int x = 0; x < kWidth; ++x) {
            error += std::abs(double(luminance(film.mean(x, y)) - luminance(truth.mean(x, y))));
            of_samples += std::sqrt(double(luminance(film.variance(x, y))));
            light += double(luminance(film.mean(x, y)));
          }
        seen += std::sqrt(std::numbers::pi / 2) * error / light / kRuns;
        scatter += of_samples / light / kRuns;
      }
      std::printf("%-12s %2d passes: estimated %.5f, seen %.5f, from the scatter of samples %.5f\n", sampler, passes,
                  estimated, seen, scatter);
      // 512 pairs: 0.034 of relative deviation, pixels of unlike noise add to it; the truth's own noise is below 0.01.
      EXPECT_NEAR(estimated / seen, 1, 0.15) << sampler << " " << passes;
    }
}

}  // namespace
}  // namespace brume
