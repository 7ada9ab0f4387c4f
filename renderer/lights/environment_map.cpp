#include "renderer/lights/environment_map.h"

#include <stb_image.h>

#include <algorithm>
#include <filesystem>

#include "renderer/film/image_io.h"

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

Result<Image> read_radiance_hdr(const std::string& path) {
  if (auto done = detail::check_readable(path); !done) return done.error();
  int width = 0, height = 0, channels = 0;
  const bool sized = stbi_is_hdr(path.c_str()) && stbi_info(path.c_str(), &width, &height, &channels);
  if (sized && static_cast<std::int64_t>(width) * height > kMaxImagePixels)
    return detail::file_error(path, "found " + std::to_string(width) + "x" + std::to_string(height) +
                                        " pixels, expected at most " + std::to_string(kMaxImagePixels) + " in all");
  float* values = sized ? stbi_loadf(path.c_str(), &width, &height, &channels, 3) : nullptr;
  if (!values) return detail::file_error(path, "found no Radiance picture, expected an .hdr file");
  Image picture(width, height);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    picture.pixels[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  stbi_image_free(values);
  return picture;
}

}  // namespace

EnvironmentMap::EnvironmentMap(Image picture) : picture_(std::move(picture)) {
  for (Color& c : picture_.pixels)
    for (int k = 0; k < 3; ++k)
      if (!(c[k] >= 0 && std::isfinite(c[k]))) c[k] = 0, ++mended_;

  // Mean of the bilinear function over each pixel: 6/8 of a pixel's own value and 1/8 of each neighbour's, both ways.
  constexpr float kShare[3] = {0.125f, 0.75f, 0.125f};
  std::vector<float> weights;
  weights.reserve(picture_.pixels.size());
  double sum = 0, squares = 0;
  for (int y = 0; y < picture_.height; ++y) {
    const double low = static_cast<double>(y) / picture_.height, high = (y + 1.0) / picture_.height;
    const double pi = 3.14159265358979323846;
    const double sr = (std::cos(pi * low) - std::cos(pi * high)) * 2 * pi / picture_.width;
    for (int x = 0; x < picture_.width; ++x) {
      float mean = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) mean += kShare[i + 1] * kShare[j + 1] * luminance(pixel(picture_, x + i, y + j));
      weights.push_back(mean * static_cast<float>(sr));
      sum += static_cast<double>(mean) * sr;
      squares += static_cast<double>(mean) * static_cast<double>(mean) * sr;
    }
  }
  solid_angle_ = static_cast<float>(squares > 0 ? sum * sum / squares : 0);
  distribution_ = PiecewiseConstant2D(picture_.width, picture_.height, weights);
}

Result<std::shared_ptr<const EnvironmentMap>> EnvironmentMap::read(const std::string& path) {
  std::string kind = std::filesystem::path(path).extension().string();
  for (char& c : kind) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  Image picture;
  if (kind == ".exr") {
    auto file = read_exr(path);
    if (!file) return file.error();
    picture = std::move(file->image);
  } else if (kind == ".hdr") {
    auto file = read_radiance_hdr(path);
    if (!file) return file.error();
    picture = std::move(*file);
  } else {
    return detail::file_error(path, "found the extension \"" + kind + "\", expected a picture in .exr or .hdr");
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
