// Where samples become a picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/core/vec.h"
#include "renderer/film/image.h"

namespace brume {

/// Mean, variance and count of the samples of every pixel, [height][width], row 0 at top.
///
/// Running mean and sum of squared deviations: Welford 1962, "Note on a Method for Calculating Corrected Sums of
/// Squares and Products", eqs. 1 and 2. The textbook sum of squares minus square of the sum loses every digit of a
/// small variance on a bright pixel. All sums are double: a float mean stops moving after some millions of samples, and
/// a finite float sample cannot overflow the square of a double. Samples are added in call order, so the bits depend
/// only on the order of the samples within each pixel, never on the thread that brought them.
///
/// Threads: add_sample() may run at the same time on different pixels, without locks; a pixel is one cache line, so
/// neighbouring tiles do not slow each other down. Everything else must not overlap with add_sample().
class Film {
 public:
  Film() = default;
  /// @param width, height  at least 0.
  Film(int width, int height) { resize(width, height); }

  int width() const { return width_; }
  int height() const { return height_; }

  /// New extents, no samples.
  void resize(int width, int height);
  /// Forgets all samples, keeps the extents and the memory.
  void clear();
  /// The same for one row; different rows at the same time.
  void clear_row(int y);

  /// Adds one radiance sample to pixel (x, y), x in [0, width), y in [0, height).
  /// @return false when a channel is NaN or infinite: the sample is dropped and the pixel left as it was. The caller
  ///         counts and reports it (style.md, "Errors").
  bool add_sample(int x, int y, Color sample);

  std::uint32_t sample_count(int x, int y) const { return pixel(x, y).count; }
  /// Mean of the samples; black when there are none.
  Color mean(int x, int y) const;
  /// Unbiased estimate of the variance of the mean, M2 / (n (n - 1)), per channel; 0 for fewer than two samples.
  Color variance(int x, int y) const;

  /// Mean of variance() over pixels and channels: the squared error that is to be expected of the picture, where its
  /// samples are independent.
  double mean_variance() const;

  Image mean_image() const;
  /// Variance of the mean, see variance().
  Image variance_image() const;
  /// Into an image that is kept between calls: no allocation unless the size has changed.
  void mean_image(Image& image) const;

  /// Whether this pixel is one of the few, one in each block of 8x8 at a place of its own, that are rendered twice.
  /// Its twin is rendered with other random numbers and never shown: only from independent randomisations can the
  /// error of low-discrepancy samples be told, whose scatter is much larger than the error of their mean (Owen 1997,
  /// "Monte Carlo Variance of Scrambled Net Quadrature").
  static bool has_twin(int x, int y);
  /// add_sample() for the twin of the pixel (x, y).
  bool add_twin_sample(int x, int y, Color sample);

  /// Noise of the whole picture relative to its brightness (0.05 reads as "5 %"): standard deviation of a pixel's
  /// luminance, mean over the pixels that have a twin, divided by the mean luminance. From |a - b| of a pixel and its
  /// twin, whose mean is 2/sqrt(pi) standard deviations of either where the error is normal. A mean of absolute values
  /// and not of squares, because one firefly next to a lamp would outweigh all the pixels that people look at.
  /// @return 0 when no twin has a sample or when the picture is black.
  double noise_estimate() const;

  /// Both of them row by row; different rows at the same time.
  struct NoiseSums {
    double luminance = 0, difference = 0;
    double variance = 0;  ///< of the mean, summed over channels
    std::size_t pixels = 0, pairs = 0;

    void add(const NoiseSums& other);
    double estimate() const;
    double mean_variance() const;
  };
  NoiseSums noise_of_row(int y) const;
  NoiseSums noise_sums() const;
  /// @param image  of the film's size
  void mean_row(int y, Image& image) const;

 private:
  /// One cache line.
  struct alignas(64) Pixel {
    double mean[3] = {};
    double m2[3] = {};          ///< sum of squared deviations from the mean
    double twin_luminance = 0;  ///< mean of the twin's samples
    std::uint32_t count = 0, twin_count = 0;
  };

  const Pixel& pixel(int x, int y) const { return pixels_[static_cast<std::size_t>(y) * width_ + x]; }

  int width_ = 0, height_ = 0;
  std::vector<Pixel> pixels_;
};

}  // namespace brume
