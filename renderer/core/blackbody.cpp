#include "renderer/core/blackbody.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace brume {
namespace {

/// A bell with different widths on its two sides.
double lobe(double x, double middle, double left, double right) {
  const double t = (x - middle) * (x < middle ? left : right);
  return std::exp(-0.5 * t * t);
}

}  // namespace

Color blackbody_color(double kelvin) {
  constexpr double kSecondRadiation = 1.438776877e7;  // h c / k, nm K
  double xyz[3] = {};
  for (double nm = 380; nm <= 780; nm += 5) {
    // Relative to 560 nm, so that neither 500 K nor 20000 K leaves the range of numbers.
    const double exponent = kSecondRadiation / (nm * kelvin), at_560 = kSecondRadiation / (560 * kelvin);
    const double planck =
        std::pow(560 / nm, 5) * std::exp(at_560 - exponent) * std::expm1(-at_560) / std::expm1(-exponent);
    xyz[0] += planck * (1.056 * lobe(nm, 599.8, 0.0264, 0.0323) + 0.362 * lobe(nm, 442.0, 0.0624, 0.0374) -
                        0.065 * lobe(nm, 501.1, 0.0490, 0.0382));
    xyz[1] += planck * (0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322));
    xyz[2] += planck * (1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725));
  }
  const double x = xyz[0] / xyz[1], z = xyz[2] / xyz[1];  // y is 1
  // ITU-R BT.709-6 primaries, D65.
  const double rgb[3] = {3.2409699 * x - 1.5373832 - 0.4986108 * z, -0.9692436 * x + 1.8759675 + 0.0415551 * z,
                         0.0556301 * x - 0.2039770 + 1.0569715 * z};
  Color color;
  for (int c = 0; c < 3; ++c) color[c] = static_cast<float>(std::max(0.0, rgb[c]));
  return color * (1 / luminance(color));
}

Color blackbody_glow(float kelvin) {
  constexpr int kStep = 20, kHottest = 12000;
  static const std::vector<Color> colors = [] {
    std::vector<Color> all{blackbody_color(kStep)};
    for (int k = kStep; k <= kHottest; k += kStep) all.push_back(blackbody_color(k));
    return all;
  }();
  if (!(kelvin > 500)) return {};
  const float place = std::min(kelvin, static_cast<float>(kHottest - 1)) / kStep, part = place - std::floor(place);
  const auto i = static_cast<std::size_t>(place);
  const float start = std::min((kelvin - 500) / 500, 1.0f), fade = start * start * (3 - 2 * start);
  const float hot = kelvin / 3000;
  return (colors[i] * (1 - part) + colors[i + 1] * part) * (fade * hot * hot * hot * hot);
}

}  // namespace brume
