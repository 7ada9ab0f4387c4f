// The difference a person would see when flipping between two pictures.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/core/error.h"
#include "renderer/film/image.h"

namespace brume {

/// Pixels per degree of visual angle, distance * resolution / width * pi / 180.
/// Andersson et al. 2020, viewing conditions of the contrast sensitivity filters.
/// @param distance, monitor_width  in the same unit of length, e.g. metres.    @param monitor_pixels  across the width.
constexpr double pixels_per_degree(double distance, double monitor_pixels, double monitor_width) {
  return distance * monitor_pixels / monitor_width * (3.14159265358979323846 / 180);
}

struct FlipSettings {
  /// [4, 1000], else an error. 67.02: a monitor 0.7 m and 3840 pixels wide, seen from 0.7 m.
  double pixels_per_degree = brume::pixels_per_degree(0.7, 3840, 0.7);
};

struct FlipResult {
  int width = 0, height = 0;
  std::vector<float> error;  ///< [height][width], row 0 at top; [0, 1], 0 where no difference is seen
  double mean = 0;           ///< of `error`: the number to quote
};

/// LDR-FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom & Fairchild 2020, "FLIP: A Difference Evaluator for
/// Alternating Images". It answers what a metric in radiance cannot: is the difference visible on a monitor,
/// at this distance. Symmetric in its arguments.
///   colour pipeline   contrast sensitivity filters in YCxCz, clamp to the monitor's gamut, L*a*b* with Hunt's
///   adjustment,
///                     HyAB distance, compressed to [0, 1]
///   feature pipeline  edges and points of the unfiltered luminance by derivatives of a Gaussian
///   together          colour^(1 - feature): a difference in structure amplifies a difference in colour
/// @param test, reference  sRGB-encoded; alpha is ignored.
/// Errors: extents that differ, no pixels, settings out of range. Any thread; 0.4 s for 1280x720 on one core (EPYC).
Result<FlipResult> flip(const Image8& test, const Image8& reference, const FlipSettings& settings = {});

/// The same of the light that a monitor emits, 1 at most per channel, before any rounding to bytes: for pictures that
/// a tone mapper has brought to its range. Not of radiance, which has no exposure yet: see flip_at() and hdr_flip().
/// @param test, reference  linear, Rec. 709 primaries; values beyond [0, 1] are clamped.
/// Errors: those of flip(), a NaN or an infinity. Any thread; as fast.
Result<FlipResult> flip_linear(const Image& test, const Image& reference, const FlipSettings& settings = {});

/// A colour for a value of [0, 1] (clamped; NaN as 0) whose luminance grows with it, so it also reads in black and
/// white: black, purple, orange, pale yellow. Nine colours of "magma" (van der Walt & Smith 2015, public domain),
/// straight lines between them.
std::array<std::uint8_t, 3> heat_color(float value);

/// heat_color() of every error, RGB8, to show the difference image.
Image8 heat_map(const FlipResult& result);

}  // namespace brume
