// What product sampling is worth where it counts: with a lamp inside the medium.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/support/scenes.h"

namespace brume {
namespace {

/// Mean over the pixels of the variance of a sample, without the one pixel in fifty where it is highest: next to a lamp
/// a few fireflies would decide.
double trimmed_variance(const std::string& mode, const char* lamp_at) {
  Node description = shipped_scene("smoke");
  set(description, "render.sampler", "independent");
  set(description, "render.bounces", "0");
  set(description, "render.light_samples", "1");  // with more the edges of the smoke inside the pixels decide
  set(description, "render.distance_sampling", mode);
  set(description, "lights.lamp.position", lamp_at);
  const auto scene = committed(description);
  WorkerPool pool;
  Film film(64, 48);
  constexpr int kPasses = 48;
  render_batch(*scene, kPasses, film, pool);
  std::vector<double> variances;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x)
      if (luminance(film.mean(x, y)) > 0) variances.push_back(kPasses * double(luminance(film.variance(x, y))));
  EXPECT_GT(variances.size(), 300u) << "no smoke to be seen";
  std::sort(variances.begin(), variances.end());
  variances.resize(variances.size() * 49 / 50);
  double sum = 0;
  for (const double v : variances) sum += v;
  return sum / static_cast<double>(variances.size());
}

TEST(ProductGain, AThirdOfTheVarianceOfTheBestOtherWithALampInside) {
  for (const char* lamp_at : {"0.9,0.7,2", "1.2,0.9,1.2"}) {
    std::map<std::string, double> variance;
    double best = std::numeric_limits<double>::infinity();
    for (const char* mode : {"density", "equi_angular", "mis"})
      best = std::min(best, variance[mode] = trimmed_variance(mode, lamp_at));
    const double product = trimmed_variance("product", lamp_at);
    std::printf("lamp at %s: product %.3g, density %.3g, equi-angular %.3g, MIS %.3g: %.1f times\n", lamp_at, product,
                variance["density"], variance["equi_angular"], variance["mis"], best / product);
    EXPECT_GT(best / product, 3) << lamp_at;
  }
}

}  // namespace
}  // namespace brume
