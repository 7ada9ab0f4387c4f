// How far a picture is from its reference, in one number.
#pragma once

#include "renderer/core/error.h"
#include "renderer/film/image.h"

namespace brume {

// In all metrics t is the image under test, r the reference, N the number of values: width * height * 3, every channel
// of every pixel with the same weight. Sums are double, in row order, so a result does not depend on threads. Errors,
// of all: extents that differ, no pixels, a NaN or an infinity (the message names image and pixel: one such value would
// silently decide the result).

/// Root of the mean squared error, sqrt(sum (t - r)^2 / N), in units of radiance. One firefly can rule it: show
/// relative_mse() and median_of_tiles() beside it.
Result<double> rmse(const Image& test, const Image& reference);

/// Of relative_mse(): the customary value, in radiance squared.
constexpr double kRelativeMseEpsilon = 0.01;

/// sum ((t - r)^2 / (r^2 + epsilon)) / N, dimensionless: errors count relative to the brightness where they are.
/// Rousselle, Knaus & Zwicker 2011, "Adaptive Sampling and Rendering using Greedy Error Minimization", section 6.
/// Where r^2 is far below epsilon it is only a scaled squared error, so pictures much darker than 0.1 need a smaller
/// one, and two results compare only under the same exposure and epsilon.
/// @param epsilon  greater than 0, else an error.
Result<double> relative_mse(const Image& test, const Image& reference, double epsilon = kRelativeMseEpsilon);

/// sum (t - r) / N, in units of radiance, signed: positive when the test is too bright. Noise cancels in it, so it is
/// what remains of an error when samples are added.
Result<double> mean_bias(const Image& test, const Image& reference);

/// sum (t - r) / sum r, dimensionless: 0.02 reads as "2 % too bright". Also an error when the reference sums to 0.
Result<double> relative_mean_bias(const Image& test, const Image& reference);

/// Splits the image into square tiles from the upper left corner (those at the right and bottom edge may be smaller),
/// takes the mean squared error of each and returns the square root of their median, in units of radiance: an RMSE that
/// fireflies in less than half of the tiles cannot move. For an even number of tiles, the mean of the middle two. Tiles
/// that are black in both images are left out: smoke before a black background would have a median of 0. All black: 0.
/// The idea is the median of means: Nemirovsky & Yudin 1983, "Problem Complexity and Method Efficiency in
/// Optimization".
/// @param tile_size  in pixels, at least 1, else an error.
Result<double> median_of_tiles(const Image& test, const Image& reference, int tile_size = 16);

/// The metrics that cost one look at every pixel, together.
struct Errors {
  double rmse = 0, relative_mse = 0, mean_bias = 0, relative_mean_bias = 0, median_of_tiles = 0;
};
/// Errors as those of the metrics; a black reference has no relative mean bias, which is 0 then.
Result<Errors> errors_of(const Image& test, const Image& reference);

}  // namespace brume
