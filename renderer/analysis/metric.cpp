#include "renderer/analysis/metric.h"

#include <algorithm>

#include "renderer/analysis/hdr_flip.h"
#include "renderer/analysis/metrics.h"
#include "renderer/film/display_transform.h"

namespace brume {
Result<FlipResult> flip_at(const Image& test, const Image& reference, float exposure) {
  const DisplaySettings display{.exposure_stops = exposure};
  return flip(to_display(test, display), to_display(reference, display));
}

namespace {

Result<double> mean_flip(const Image& test, const Image& reference, const Viewing& viewing) {
  const auto result = flip_at(test, reference, viewing.exposure);
  if (!result) return result.error();
  return result->mean;
}

Result<double> mean_hdr_flip(const Image& test, const Image& reference, const Viewing& viewing) {
  const auto result = hdr_flip(
      test, reference, {.ldr = {}, .start_exposure = viewing.start_exposure, .stop_exposure = viewing.stop_exposure});
  if (!result) return result.error();
  return result->flip.mean;
}

}  // namespace

const std::vector<Metric>& metrics() {
  static const std::vector<Metric> all{
      {"rmse", "RMSE", "radiance", "Root of the mean squared error; one firefly can rule it.",
       [](const Image& t, const Image& r, const Viewing&) { return rmse(t, r); }},
      {"relative_mse", "Relative MSE", "", "Squared error over the squared reference, so that dark parts count too.",
       [](const Image& t, const Image& r, const Viewing&) { return relative_mse(t, r); }},
      {"mean_bias", "Mean bias", "radiance", "Mean of the difference, in which noise cancels.",
       [](const Image& t, const Image& r, const Viewing&) { return mean_bias(t, r); }},
      {"relative_mean_bias", "Relative mean bias", "", "The same over the mean of the reference.",
       [](const Image& t, const Image& r, const Viewing&) { return relative_mean_bias(t, r); }},
      {"median_of_tiles", "Median of tiles", "radiance",
       "Median over tiles of their root mean squared error, which fireflies in less than half of them cannot move.",
       [](const Image& t, const Image& r, const Viewing&) { return median_of_tiles(t, r); }},
      {"flip", "FLIP", "", "The difference that a person sees who flips between the pictures on a monitor, 0 to 1.",
       mean_flip},
      {"hdr_flip", "HDR-FLIP", "", "The largest difference that a person sees at any exposure of a range, 0 to 1.",
       mean_hdr_flip}};
  return all;
}

std::vector<std::string> metric_keys() {
  std::vector<std::string> keys;
  for (const Metric& m : metrics()) keys.push_back(m.key);
  return keys;
}

const Metric* find_metric(const std::string& key) {
  const auto& all = metrics();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Metric& m) { return m.key == key; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace brume
