// Pictures of surroundings for tests, and where their pixels are seen.
#pragma once

#include <cmath>
#include <limits>

#include "renderer/film/image.h"
#include "renderer/sampling/sampler.h"

namespace brume {

inline constexpr double kPiD = 3.14159265358979323846;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

inline Vec2 random_pair(std::uint32_t i, int index = 0) {
  return Sampler(SamplerKind::Independent, 18, 7, i).u2(Decision::LightPoint, 0, index);
}

/// The picture's own description: (0.5, 0.5) is +x, v = 0 is +z, u = 0.75 is -y.
inline Vec3 seen_at(double u, double v) {
  const double azimuth = 2 * kPiD * (u - 0.5), theta = kPiD * v;
  return Vec3(Vec3d(std::sin(theta) * std::cos(azimuth), -std::sin(theta) * std::sin(azimuth), std::cos(theta)));
}

struct Place {
  double u, v;
};
inline Place place_of(Vec3 w) {
  const double u = 0.5 + std::atan2(-double(w.y), double(w.x)) / (2 * kPiD);
  return {u < 1 ? u : 0, std::atan2(std::hypot(double(w.x), double(w.y)), double(w.z)) / kPiD};
}

/// Per unit of (u, v) instead of per sr, so without the pole's 1/sin(theta).
inline double per_place(double pdf_w, double v) { return pdf_w * 2 * kPiD * kPiD * std::sin(kPiD * v); }

/// Colours of four decades with black pixels between them.
inline Image patchy(int width, int height) {
  Image picture(width, height);
  for (std::uint32_t i = 0; i < picture.pixels.size(); ++i) {
    const Vec2 a = random_pair(i, 8), b = random_pair(i, 9);
    if (a.x > 0.4f) picture.pixels[i] = Color(a.x, a.y, b.x) * std::exp(9 * b.y);
  }
  return picture;
}

inline Image one_bright_pixel(int width, int height, int x, int y) {
  Image picture(width, height);
  picture.at(x, y) = {100, 200, 300};
  return picture;
}

}  // namespace brume
