#include "renderer/lights/environment_map.h"

#include <algorithm>

#include "renderer/core/input_file.h"
#include "renderer/film/image_io.h"
#include "renderer/film/radiance_hdr.h"

namespace brume {
namespace {

/// Place in the picture, in [0,1)^2.
Vec2 place_of(Vec3 direction) {
  float u = 0.5f - std::atan2(direction.y, direction.x) / (2 * kPi);
  u -= std::floor(u);
  // From the side that is nearer to the pole: an angle of the arc cosine alone would be rough there.
  const float v = std::atan2(std::hypot(direction.x, direction.y), direction.z) / kPi;
  return {std::min(u, 0x1.fffffep-1f), std::clamp(v, 0.0f, 0x1.fffffep-1f)};
}

Vec3 direction_of(Vec2 place) {
  const float phi = 2 * kPi * (0.5f - place.x), theta = kPi * place.y;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// The picture continues over its left and right edges; beyond the poles it does not.
const Color& pixel(const Image& picture, int x, int y) {
  x = x < 0 ? x + picture.width : x >= picture.width ? x - picture.width : x;
  return picture.at(x, std::clamp(y, 0, picture.height - 1));
}

}  // namespace

EnvironmentMap::EnvironmentMap(Image picture) : picture_(std::move(picture)) {
  for (Color& c : picture_.pixels)
    for (int k = 0; k < 3; ++k)
      if (!(c[k] >= 0 && std::isfinite(c[k]))) c[k] = 0, ++mended_;

  // Mean of the bilinear function over each pixel: 6/8 of a pixel's own value and 1/8 of each neighbour's, both ways.
  constexpr double kShare[3] = {0.125, 0.75, 0.125};
  std::vector<double> weights;
  weights.reserve(picture_.pixels.size());
  double sum = 0, squares = 0;
  for (int y = 0; y < picture_.height; ++y) {
    const double low = static_cast<double>(y) / picture_.height, high = (y + 1.0) / picture_.height;
    const double pi = 3.14159265358979323846;
    const double sr = (std::cos(pi * low) - std::cos(pi * high)) * 2 * pi / picture_.width;
    for (int x = 0; x < picture_.width; ++x) {
      double mean = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
          mean += kShare[i + 1] * kShare[j + 1] * static_cast<double>(luminance(pixel(picture_, x + i, y + j)));
      weights.push_back(mean * sr);
      sum += mean * sr;
      squares += mean * mean * sr;
    }
  }
  solid_angle_ = static_cast<float>(squares > 0 ? sum * sum / squares : 0);
  // Only their ratios count; the largest is made 1, so that none is too large for a float.
  const double largest = *std::max_element(weights.begin(), weights.end());
  std::vector<float> relative;
  for (const double w : weights) relative.push_back(static_cast<float>(largest > 0 ? w / largest : 0));
  distribution_ = PiecewiseConstant2D(picture_.width, picture_.height, relative);
}

Result<std::shared_ptr<const EnvironmentMap>> EnvironmentMap::read(const std::string& path) {
  const std::string kind = lower_case_extension(path);
  Image picture;
  if (kind == ".exr") {
    auto file = read_exr(path);
    if (!file) return file.error();
    picture = std::move(file->image);
  } else if (kind == ".hdr") {
    auto file = read_hdr(path);
    if (!file) return file.error();
    picture = std::move(*file);
  } else {
    return file_error(path, "found the extension \"" + kind + "\", expected a picture in .exr or .hdr");
  }
  return std::make_shared<const EnvironmentMap>(std::move(picture));
}

Color EnvironmentMap::radiance(Vec3 direction) const {
  const Vec2 place = place_of(direction);
  const float x = place.x * static_cast<float>(picture_.width) - 0.5f;
  const float y = place.y * static_cast<float>(picture_.height) - 0.5f;
  const float fx = x - std::floor(x), fy = y - std::floor(y);
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  return (pixel(picture_, i, j) * (1 - fx) + pixel(picture_, i + 1, j) * fx) * (1 - fy) +
         (pixel(picture_, i, j + 1) * (1 - fx) + pixel(picture_, i + 1, j + 1) * fx) * fy;
}

EnvironmentMap::Sample EnvironmentMap::sample(Vec2 u) const {
  const auto drawn = distribution_.sample(u);
  // d_omega = 2 pi^2 sin(theta) du dv.
  const float sin_theta = std::sin(kPi * drawn.position.y);
  return {direction_of(drawn.position), sin_theta > 0 ? drawn.pdf / (2 * kPi * kPi * sin_theta) : 0};
}

float EnvironmentMap::pdf_w(Vec3 direction) const {
  const float sin_theta = std::hypot(direction.x, direction.y);
  return sin_theta > 0 ? distribution_.pdf(place_of(direction)) / (2 * kPi * kPi * sin_theta) : 0;
}

}  // namespace brume
