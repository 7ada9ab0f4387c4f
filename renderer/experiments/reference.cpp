#include "renderer/experiments/reference.h"

#include <xxhash.h>

#include <charconv>
#include <cstdio>
#include <filesystem>

#include "renderer/analysis/comparable.h"
#include "renderer/film/image_io.h"
#include "renderer/scene/compare.h"
#include "renderer/scene_io/write_node.h"

namespace brume {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kReferenceSeed = 0x5EED;  // any but the seeds that people choose

/// What a file's contents are known by without reading them.
std::string files_of(const Node& node) {
  std::string text;
  for (const Param& p : node.table().params) {
    if (p.type != ParamType::File || node.text(p.key).empty()) continue;
    std::error_code unknown;
    const fs::path path(node.text(p.key));
    text += path.string() + " " + std::to_string(fs::file_size(path, unknown)) + " " +
            std::to_string(fs::last_write_time(path, unknown).time_since_epoch().count()) + "\n";
  }
  for (const Slot& s : node.table().slots) {
    if (!s.list) text += files_of(node.child(s.key));
    if (s.list)
      for (const Node& n : node.list(s.key)) text += files_of(n);
  }
  return text;
}

double number_in(const ImageMetadata& metadata, const std::string& key) {
  const auto found = metadata.extra.find(key);
  double value = 0;
  if (found != metadata.extra.end())
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), value);
  return value;
}

}  // namespace

Reference read_reference(const std::string& path, int width, int height) {
  const auto file = read_exr(path);
  if (!file || file->image.width != width || file->image.height != height) return {};
  Reference kept{file->image, number_in(file->metadata, "variance"),
                 static_cast<int>(number_in(file->metadata, "samples_per_pixel")),
                 number_in(file->metadata, "cpu_seconds")};
  const bool whole = kept.samples_per_pixel > 0 && kept.cpu_seconds > 0 && !not_comparable(kept.image, kept.image);
  return whole ? kept : Reference{};
}

void keep_reference(const std::string& path, const Reference& reference) {
  ImageMetadata metadata;
  metadata.extra["variance"] = format_value(reference.variance);
  metadata.extra["samples_per_pixel"] = std::to_string(reference.samples_per_pixel);
  metadata.extra["cpu_seconds"] = format_value(reference.cpu_seconds);
  std::error_code error;
  fs::create_directories(fs::path(path).parent_path(), error);
  // It is rendered anew the next time where it cannot be kept.
  static_cast<void>(write_exr(path, reference.image, metadata).ok());
}

Reference merged(const Reference& a, const Reference& b) {
  if (a.samples_per_pixel == 0) return b;
  Reference sum = b;
  sum.samples_per_pixel = a.samples_per_pixel + b.samples_per_pixel;
  sum.cpu_seconds = a.cpu_seconds + b.cpu_seconds;
  const double share = static_cast<double>(a.samples_per_pixel) / sum.samples_per_pixel;
  sum.variance = share * share * a.variance + (1 - share) * (1 - share) * b.variance;
  for (std::size_t i = 0; i < sum.image.pixels.size(); ++i)
    sum.image.pixels[i] =
        a.image.pixels[i] * static_cast<float>(share) + b.image.pixels[i] * static_cast<float>(1 - share);
  return sum;
}

Node reference_description(const Node& scene) {
  Node description = without_variants(scene);
  description.child("film") = Node(scene.child("film").table());  // how it is shown does not matter
  Node& render = description.child("render");
  static_cast<void>(set_by_path(description, "render.integrator", "null_scattering").ok());
  static_cast<void>(render.set("sampler", std::string("independent")).ok());
  static_cast<void>(render.set("seed", kReferenceSeed).ok());
  return description;
}

std::string reference_key(const Node& description, int width, int height) {
  const Family root{"scene", "", {&description.table()}};
  const std::string text = "1\n" + write_node(description, root, {.target_dir = "", .all = true}) +
                           files_of(description) + std::to_string(width) + "x" + std::to_string(height);
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  char digits[40];
  std::snprintf(digits, sizeof digits, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return digits;
}

std::string reference_path(const std::string& folder, const Node& description, int width, int height) {
  if (folder.empty()) return "";
  return (fs::path(folder) / (reference_key(description, width, height) + ".exr")).string();
}

Result<Reference> make_reference(const Node& scene, SceneCache& cache, WorkerPool& pool,
                                 const ReferenceOptions& options) {
  const Node description = reference_description(scene);
  const std::string path = reference_path(options.folder, description, options.width, options.height);
  const Reference kept = path.empty() ? Reference{} : read_reference(path, options.width, options.height);
  if (kept.cpu_seconds >= options.cpu_seconds) return kept;

  const auto committed = commit(description, cache, {.cancel = options.cancel});
  if (!committed) return committed.error();
  Film film(options.width, options.height);
  const RenderStatistics statistics = render_batch(
      **committed, 1 << 24, film, pool,
      [&](const BatchProgress& p) {
        const double seconds = kept.cpu_seconds + p.statistics.cpu_seconds;
        if (options.progress) options.progress(std::min(1.0, seconds / options.cpu_seconds));
        // Two passes at least, or nothing is known of the variance.
        return !options.cancel.stop_requested() &&
               (seconds < options.cpu_seconds || p.statistics.samples_per_pixel < 2);
      },
      static_cast<std::uint32_t>(kept.samples_per_pixel));
  if (statistics.samples_per_pixel < 2)
    return kept.samples_per_pixel > 0 ? Result<Reference>(kept)
                                      : Error{ErrorCode::Cancelled, "the reference was cancelled"};
  Reference reference =
      merged(kept, {film.mean_image(), film.mean_variance(), statistics.samples_per_pixel, statistics.cpu_seconds});
  if (!path.empty()) keep_reference(path, reference);
  return reference;
}

Result<Reference> load_reference(const std::string& path, int width, int height) {
  auto file = read_exr(path);
  if (!file) return file.error();
  if (auto error = not_comparable(Image(width, height), file->image)) {
    error->source.file = path;
    return *error;
  }
  return Reference{std::move(file->image), number_in(file->metadata, "variance"),
                   static_cast<int>(number_in(file->metadata, "samples_per_pixel")), 0};
}

}  // namespace brume
