// The metrics by name: what commands, charts and panels can measure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/analysis/flip.h"

namespace brume {

/// At which exposures people look at pictures, stops; only metrics of what is seen ask.
struct Viewing {
  float exposure = 0;                                            ///< of flip
  std::optional<float> start_exposure = {}, stop_exposure = {};  ///< of hdr_flip, as HdrFlipSettings
};

/// One number for the difference of two pictures.
struct Metric {
  std::string key;    ///< "rmse"
  std::string label;  ///< "RMSE"
  std::string unit;   ///< "" where it has none
  std::string doc;    ///< one sentence
  /// @param test, reference  scene-linear
  Result<double> (*measure)(const Image& test, const Image& reference, const Viewing& viewing);
};

/// rmse, relative_mse, mean_bias, relative_mean_bias, median_of_tiles, flip, hdr_flip.
const std::vector<Metric>& metrics();

std::vector<std::string> metric_keys();

/// Null when there is none of that name.
const Metric* find_metric(const std::string& key);

/// LDR-FLIP of the pictures as a display shows them at an exposure, in stops.
Result<FlipResult> flip_at(const Image& test, const Image& reference, float exposure);

}  // namespace brume
