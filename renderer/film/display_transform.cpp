#include "renderer/film/display_transform.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "renderer/core/check.h"

namespace brume {
namespace {

// Hable 2010: shoulder strength, linear strength, linear angle, toe strength, toe numerator, toe denominator.
constexpr double kA = 0.15, kB = 0.50, kC = 0.10, kD = 0.20, kE = 0.02, kF = 0.30;
constexpr double kHableWhite = 11.2, kHableExposureBias = 2;

constexpr double hable_partial(double x) {
  return (x * (kA * x + kC * kB) + kD * kE) / (x * (kA * x + kB) + kD * kF) - kE / kF;
}
constexpr double kHableWhiteScale = 1 / hable_partial(kHableWhite);

/// Solves hable_filmic(x) = y for x >= 0; y in [0, 1]. With s = y / white scale + E/F the definition becomes
/// A (1 - s) u^2 + B (C - s) u + D (E - s F) = 0 for u = bias x, whose constant term is never positive: one root >= 0.
double inverse_hable(double y) {
  const double s = y / kHableWhiteScale + kE / kF;
  const double a = kA * (1 - s), b = kB * (kC - s), c = std::min(0.0, kD * (kE - s * kF));
  const double root = std::sqrt(b * b - 4 * a * c);
  // The form without cancellation: for b > 0 the numerator -b + root would lose its digits.
  const double u = b > 0 ? -2 * c / (b + root) : (root - b) / (2 * a);
  return u / kHableExposureBias;
}

DisplaySettings in_range(DisplaySettings s) {
  s.exposure_stops = std::isnan(s.exposure_stops) ? 0 : std::clamp(s.exposure_stops, -64.0f, 64.0f);
  s.gamma = std::isnan(s.gamma) ? 2.2f : std::clamp(s.gamma, 1.0f, 4.0f);
  return s;
}

double encode(double x, const DisplaySettings& s) {
  switch (s.curve) {
    case DisplayCurve::Gamma:
      return std::pow(x, 1 / static_cast<double>(s.gamma));
    case DisplayCurve::Filmic:
      return srgb_encode(hable_filmic(x));
    case DisplayCurve::Srgb:
      break;
  }
  return srgb_encode(x);
}

double decode(double v, const DisplaySettings& s) {
  switch (s.curve) {
    case DisplayCurve::Gamma:
      return std::pow(v, static_cast<double>(s.gamma));
    case DisplayCurve::Filmic:
      return inverse_hable(srgb_decode(v));
    case DisplayCurve::Srgb:
      break;
  }
  return srgb_decode(v);
}

/// Finds the code value of a linear one by its thresholds instead of evaluating the curve: code(x) is the number of
/// thresholds that are <= x. The bits of a positive float grow with its value, so the upper bits number small buckets
/// of 1/512 of an octave, each storing the code at its beginning. All curves here have neighbouring thresholds further
/// apart than a bucket (closest: gamma 1 at the top, 1/255), so one comparison inside the bucket makes the code exact.
class CodeTable {
 public:
  /// @param offset  code c begins where the curve reaches (c - offset) / 255: 0.5 rounds, 0 truncates.
  CodeTable(const DisplaySettings& settings, double offset) {
    thresholds_[0] = 0;
    for (int code = 1; code < 256; ++code) {
      const double linear = decode((code - offset) / 255, settings);
      thresholds_[code] = std::bit_cast<std::int32_t>(static_cast<float>(linear));
    }
    thresholds_[256] = std::numeric_limits<std::int32_t>::max();

    low_ = (thresholds_[1] >> kShift) << kShift;  // everything below is code 0
    high_ = thresholds_[255];                     // everything from here on is code 255
    base_.resize(static_cast<std::size_t>((high_ - low_) >> kShift) + 1);
    int code = 0;
    for (std::size_t bucket = 0; bucket < base_.size(); ++bucket) {
      const std::int32_t begin = low_ + (static_cast<std::int32_t>(bucket) << kShift);
      while (thresholds_[code + 1] <= begin) ++code;
      base_[bucket] = static_cast<std::uint8_t>(code);
    }
  }

  /// @param x  linear value after exposure; not NaN. Negative values have negative bits and end in the first bucket.
  int code(float x) const {
    const std::int32_t bits = std::clamp(std::bit_cast<std::int32_t>(x), low_, high_);
    const int base = base_[static_cast<std::uint32_t>(bits - low_) >> kShift];
    return base + (bits >= thresholds_[base + 1] ? 1 : 0);
  }

 private:
  static constexpr int kShift = 23 - 9;  // of 23 mantissa bits, 9 belong to the bucket's number

  std::array<std::int32_t, 257> thresholds_;  ///< bits of the smallest float of every code
  std::int32_t low_ = 0, high_ = 0;
  std::vector<std::uint8_t> base_;  ///< at most 40 octaves (gamma 4) of 512 buckets
};

/// Dithering needs the place between two codes too. Within one code the curves are straight to a fraction of a percent.
class DitherTable {
 public:
  explicit DitherTable(const DisplaySettings& settings) : floor_(settings, 0) {
    for (int code = 0; code < 256; ++code) begin_[code] = static_cast<float>(decode(code / 255.0, settings));
    for (int code = 0; code < 255; ++code) inverse_step_[code] = 1 / (begin_[code + 1] - begin_[code]);
    inverse_step_[255] = 0;  // white stays white
  }
  /// @param threshold  in (0, 1): the code is rounded up when the fraction reaches it.
  int code(float x, float threshold) const {
    const int floor = floor_.code(x);
    const float fraction = (x - begin_[floor]) * inverse_step_[floor];
    return std::min(255, floor + (fraction >= threshold ? 1 : 0));
  }

 private:
  CodeTable floor_;
  std::array<float, 256> begin_, inverse_step_;
};

/// Bayer 1973, order 8, as thresholds (k + 1/2) / 64. The order of a cell interleaves the bits of x^y and y, least
/// significant first becoming most significant.
std::array<float, 64> bayer_thresholds() {
  std::array<float, 64> thresholds{};
  for (unsigned y = 0; y < 8; ++y)
    for (unsigned x = 0; x < 8; ++x) {
      unsigned order = 0;
      for (unsigned bit = 0; bit < 3; ++bit) order = order << 2 | ((x ^ y) >> bit & 1) << 1 | (y >> bit & 1);
      thresholds[y * 8 + x] = (static_cast<float>(order) + 0.5f) / 64;
    }
  return thresholds;
}

/// @param code_of  (linear value after exposure, x, y) -> code.
template <int kChannels, class CodeOf>
void encode_pixels(const Image& image, float scale, const CodeOf& code_of, std::uint8_t* out) {
  const Color* in = image.pixels.data();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x, ++in, out += kChannels) {
      const Color c = *in;
      if (is_finite(c)) {
        out[0] = static_cast<std::uint8_t>(code_of(c.r * scale, x, y));
        out[1] = static_cast<std::uint8_t>(code_of(c.g * scale, x, y));
        out[2] = static_cast<std::uint8_t>(code_of(c.b * scale, x, y));
      } else {
        out[0] = 255, out[1] = 0, out[2] = 255;
      }
      if constexpr (kChannels == 4) out[3] = 255;
    }
}

template <class CodeOf> void encode_image(const Image& image, float scale, const CodeOf& code_of, Image8& display) {
  if (display.channels == 4)
    encode_pixels<4>(image, scale, code_of, display.bytes.data());
  else
    encode_pixels<3>(image, scale, code_of, display.bytes.data());
}

}  // namespace

double srgb_encode(double x) {
  if (x <= 0) return 0;
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

double srgb_decode(double v) {
  if (v <= 0) return 0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

double hable_filmic(double x) { return hable_partial(kHableExposureBias * x) * kHableWhiteScale; }

double display_value(double x, const DisplaySettings& settings) {
  const DisplaySettings s = in_range(settings);
  if (std::isnan(x)) return x;
  const double exposed = std::exp2(static_cast<double>(s.exposure_stops)) * std::max(0.0, x);
  // From 1e6 on every curve is far beyond its clipping point; this keeps infinities out of the quotient.
  return std::clamp(encode(std::min(exposed, 1e6), s), 0.0, 1.0);
}

void to_display(const Image& image, const DisplaySettings& settings, int channels, Image8& display) {
  BRUME_CHECK(is_consistent(image), ==, true);
  BRUME_CHECK((channels == 3 || channels == 4), ==, true);
  display.width = image.width;
  display.height = image.height;
  display.channels = channels;
  display.bytes.resize(image.pixels.size() * static_cast<std::size_t>(channels));

  const DisplaySettings s = in_range(settings);
  const float scale = std::exp2(s.exposure_stops);
  if (s.dither) {
    static constexpr int kMask = 7;
    const std::array<float, 64> bayer = bayer_thresholds();
    const DitherTable table(s);
    const auto code_of = [&](float x, int px, int py) { return table.code(x, bayer[(py & kMask) * 8 + (px & kMask)]); };
    encode_image(image, scale, code_of, display);
  } else {
    const CodeTable table(s, 0.5);
    encode_image(
        image, scale, [&](float x, int, int) { return table.code(x); }, display);
  }
}

Image8 to_display(const Image& image, const DisplaySettings& settings, int channels) {
  Image8 display;
  to_display(image, settings, channels, display);
  return display;
}

}  // namespace brume
