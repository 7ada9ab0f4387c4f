#include "app/cli/compare.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/cli/console.h"
#include "app/cli/output_file.h"
#include "app/cli/text_table.h"
#include "renderer/core/input_file.h"
#include "renderer/film/display_transform.h"
#include "renderer/film/image_io.h"
#include "renderer/params/param.h"

namespace brume {
namespace {

/// A picture with values that are no numbers cannot be compared.
Result<Image> checked(Image image, const std::string& path) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (!is_finite(image.at(x, y)))
        return bad_input("found a value that is not a finite number at pixel (" + std::to_string(x) + ", " +
                             std::to_string(y) + "), expected numbers everywhere",
                         {path, 0, 0, ""});
  return image;
}

/// Scene-linear. A PNG's bytes are taken as sRGB.
Result<Image> read_picture(const std::string& path) {
  if (lower_case_extension(path) != ".png") {
    auto file = read_exr(path);
    if (!file) return file.error();
    return checked(std::move(file->image), path);
  }
  const auto file = read_png(path);
  if (!file) return file.error();
  Image image(file->image.width, file->image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<float>(srgb_decode(file->image.at(x, y)[c] / 255.0));
  return image;
}

Result<std::vector<const Metric*>> chosen(const CompareOptions& options) {
  std::vector<const Metric*> list;
  if (options.metrics.empty())
    for (const Metric& m : metrics()) list.push_back(&m);
  for (const std::string& key : options.metrics) {
    const Metric* metric = find_metric(key);
    if (!metric)
      return bad_input("found \"" + key + "\", expected one of " + join(metric_keys()), {"", 0, 0, "--metric"});
    list.push_back(metric);
  }
  const Viewing& v = options.viewing;
  if (v.start_exposure && v.stop_exposure && *v.start_exposure >= *v.stop_exposure)
    return bad_input("found " + format_value(static_cast<double>(*v.stop_exposure)) +
                         ", expected more than --start-exposure, which is " +
                         format_value(static_cast<double>(*v.start_exposure)),
                     {"", 0, 0, "--stop-exposure"});
  if (options.threshold && list.size() != 1)
    return bad_input("found no single metric, expected --metric with one to hold against it",
                     {"", 0, 0, "--threshold"});
  return list;
}

/// What a person would see, as colours from black to pale yellow.
Result<void> write_difference(const CompareOptions& options, const Image& test, const Image& reference) {
  const auto seen = flip_at(test, reference, options.viewing.exposure);
  if (!seen) return seen.error();
  return write_png(options.output, heat_map(*seen));
}

}  // namespace

Result<ExitCode> run_compare(const CompareOptions& options) {
  const auto list = chosen(options);
  if (!list) return list.error();
  if (!options.output.empty())
    if (auto ok = check_output(options.output, {".png"}); !ok) return ok.error();
  const auto test = read_picture(options.test);
  if (!test) return test.error();
  const auto reference = read_picture(options.reference);
  if (!reference) return reference.error();

  auto json = nlohmann::ordered_json::object();
  std::vector<std::vector<std::string>> rows;
  bool holds = true;
  for (const Metric* metric : *list) {
    const auto value = metric->measure(*test, *reference, options.viewing);
    if (!value && (!options.metrics.empty() || metric->key == "rmse")) {
      Error error = value.error();
      if (error.source.file.empty()) error.source.file = options.test;
      return error;
    }
    // Asked for all, one that these pictures do not have (black has no relative bias) is left empty.
    json[metric->key] = value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
    rows.push_back({metric->key, value ? short_number(*value, 6) : "-", metric->unit, metric->doc});
    if (!value) continue;
    holds = !options.threshold || std::abs(*value) <= *options.threshold;
  }
  if (!options.output.empty())
    if (auto done = write_difference(options, *test, *reference); !done) return done.error();
  if (auto done = print_result(options.json ? json.dump(2) + "\n" : format_table(rows, "lrll", 0)); !done)
    return done.error();
  return holds ? ExitCode::Ok : ExitCode::CheckFailed;
}

}  // namespace brume
