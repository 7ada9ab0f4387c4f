// Pictures as plain values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/core/vec.h"

namespace brume {

/// Scene-linear radiance, Rec. 709 primaries: `pixels` is [height][width], row 0 at top.
struct Image {
  int width = 0, height = 0;
  std::vector<Color> pixels;

  Image() = default;
  /// @param width_, height_  at least 0.
  Image(int width_, int height_, Color fill = {})
      : width(width_), height(height_), pixels(static_cast<std::size_t>(width_) * height_, fill) {}

  /// @param x  in [0, width).    @param y  in [0, height).
  Color& at(int x, int y) { return pixels[index(x, y)]; }
  const Color& at(int x, int y) const { return pixels[index(x, y)]; }
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }

  bool empty() const { return pixels.empty(); }
  bool operator==(const Image&) const = default;
};

/// Display-encoded bytes (sRGB unless said otherwise): `bytes` is [height][width][channels], row 0 at top.
struct Image8 {
  int width = 0, height = 0;
  int channels = 3;  ///< 3: red, green, blue; 4: and alpha, not premultiplied
  std::vector<std::uint8_t> bytes;

  Image8() = default;
  /// @param width_, height_  at least 0.    @param channels_  3 or 4.
  Image8(int width_, int height_, int channels_, std::uint8_t fill = 0)
      : width(width_),
        height(height_),
        channels(channels_),
        bytes(static_cast<std::size_t>(width_) * height_ * channels_, fill) {}

  /// The first channel of a pixel; the others follow. x in [0, width), y in [0, height).
  std::uint8_t* at(int x, int y) { return bytes.data() + index(x, y); }
  const std::uint8_t* at(int x, int y) const { return bytes.data() + index(x, y); }
  std::size_t index(int x, int y) const { return (static_cast<std::size_t>(y) * width + x) * channels; }

  bool empty() const { return bytes.empty(); }
  bool operator==(const Image8&) const = default;
};

/// More pixels than this (8192 x 8192, 0.8 GB as an Image) are taken for a damaged or hostile file by the readers.
constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 26;

/// The storage has the size that width, height (and channels) promise. The writers and metrics refuse anything else.
bool is_consistent(const Image& image);
bool is_consistent(const Image8& image);

}  // namespace brume
