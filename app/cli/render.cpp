#include "app/cli/render.h"

#include <cstdio>
#include <filesystem>
#include <limits>

#include "app/cli/console.h"
#include "app/cli/interrupt.h"
#include "app/cli/output_file.h"
#include "app/cli/progress_line.h"
#include "app/cli/render_report.h"
#include "renderer/core/atomic_file.h"
#include "renderer/engine/black_picture.h"

namespace brume {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
  return text;
}

Result<void> check_outputs(const RenderOptions& options) {
  if (auto done = check_output(options.output, {".exr", ".png"}); !done) return done;
  if (options.statistics_file.empty()) return {};
  if (auto done = check_writable(options.statistics_file); !done) return done;
  std::error_code unknown;
  const auto whole = [&](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, unknown), unknown);
  };
  if (whole(options.output) == whole(options.statistics_file))
    return bad_input("found the picture's own file, expected another one", {"", 0, 0, "--stats"});
  return {};
}

/// The film, the picture made of it and the bytes of its file must fit into the machine.
Result<void> check_size(const FilmSettings& film) {
  const auto pixels = static_cast<std::int64_t>(film.width) * film.height;
  const std::string found = "found " + std::to_string(film.width) + "x" + std::to_string(film.height) + ", ";
  const ErrorSource source{"", 0, 0, "film.resolution"};
  if (pixels > kMaxImagePixels)
    return bad_input(found + "expected at most " + std::to_string(kMaxImagePixels) + " pixels in all", source);
  constexpr int kBytesPerPixel = 64 + 12 + 12 + 12;  // film, mean, the encoded file in memory and its compression
  if (!check_memory(static_cast<std::uint64_t>(pixels) * kBytesPerPixel))
    return bad_input(found + "which needs more memory than this machine has; make the picture smaller", source);
  return {};
}

/// When to stop, and how far that is.
class Budget {
 public:
  explicit Budget(const RenderOptions& options) : seconds_(options.seconds) {
    passes_ = seconds_ ? std::numeric_limits<int>::max() : options.samples.value_or(kDefaultSamples);
  }

  int passes() const { return passes_; }

  /// With a time, the end is the pass that ends nearest to it.
  bool used_up(const RenderStatistics& s) const {
    if (!seconds_) return s.samples_per_pixel >= passes_;
    const double half_a_pass = 0.5 * s.wall_seconds / s.samples_per_pixel;
    return s.wall_seconds + half_a_pass >= *seconds_;
  }

  double fraction(const RenderStatistics& s) const {
    return seconds_ ? s.wall_seconds / *seconds_ : static_cast<double>(s.samples_per_pixel) / passes_;
  }

  std::string done(const RenderStatistics& s) const {
    const std::string samples = std::to_string(s.samples_per_pixel);
    return seconds_ ? samples + " samples" : samples + "/" + std::to_string(passes_) + " samples";
  }

 private:
  std::optional<double> seconds_;
  int passes_;
};

RenderStatistics render_with_progress(const Scene& scene, const Budget& budget, Film& film, WorkerPool& pool) {
  ProgressLine line("rendering");
  line.update({0, budget.done({})});
  auto noise_measured = Clock::now();
  std::string noise;
  return render_batch(scene, budget.passes(), film, pool, [&](const BatchProgress& p) {
    if (InterruptGuard::requested() || budget.used_up(p.statistics)) return false;
    // The estimate reads the whole film, which would slow very short passes down.
    constexpr double kNoiseInterval = 0.5;
    if (stderr_is_terminal() && seconds_since(noise_measured) >= kNoiseInterval) {
      noise = "noise " + percent(p.film.noise_estimate());
      noise_measured = Clock::now();
    }
    line.update({budget.fraction(p.statistics), budget.done(p.statistics), noise});
    return true;
  });
}

void print_summary(const RenderOptions& options, const Scene& scene, const RenderStatistics& s, double noise,
                   bool interrupted) {
  for (const auto& [count, text] : {std::pair{s.rays.non_finite, " samples were not finite and were left out"},
                                    std::pair{s.rays.march.capped,
                                              " marches were too long for the step size and took "
                                              "longer steps; raise step_size"}})
    if (count > 0) print_warning(std::to_string(count) + text);
  std::string text = interrupted ? "interrupted; " : "";
  text += "wrote " + options.output + ": " + std::to_string(scene.film.width) + "x" +
          std::to_string(scene.film.height) + ", " + std::to_string(s.samples_per_pixel) +
          (s.samples_per_pixel == 1 ? " sample" : " samples") + " per pixel in " + format_duration(s.wall_seconds);
  if (noise > 0) text += ", noise " + percent(noise);
  print_note(text);
}

}  // namespace

Result<ExitCode> run_render(const RenderOptions& options) {
  if (auto done = check_outputs(options); !done) return done.error();

  const auto start = Clock::now();
  SceneCache cache;
  std::shared_ptr<const Scene> scene;
  std::optional<LoadedScene> loaded;
  {
    ProgressLine line("reading");
    const LoadOptions load{.progress = [&](float done) { line.update({done}); }};
    auto read = load_scene(options.scene, cache, load);
    if (!read) return read.error();
    loaded = std::move(*read);
    if (auto done = check_size(read_film_settings(loaded->description.child("film"))); !done) return done.error();
    auto committed = commit_loaded(*loaded, cache, {.progress = load.progress});
    if (!committed) return committed.error();
    scene = *committed;
  }
  for (const std::string& note : loaded->notes) print_note(note);
  for (const std::string& warning : scene->warnings) print_warning(warning);
  const double load_seconds = seconds_since(start);

  Film film(scene->film.width, scene->film.height);
  WorkerPool pool(options.threads);
  const Budget budget(options);
  const InterruptGuard guard;
  const RenderStatistics statistics = render_with_progress(*scene, budget, film, pool);
  const bool interrupted = InterruptGuard::requested() && !budget.used_up(statistics);

  const double noise = film.noise_estimate();
  Picture picture;
  picture.image = film.mean_image();
  picture.statistics = statistics;
  if (auto done = write_picture(options.output, picture, loaded->description); !done) return done.error();
  if (const auto why = explain_black(*scene, picture)) print_warning("the picture is black. " + *why);
  if (!options.statistics_file.empty()) {
    const RenderReport report{options.scene.file, options.output, *scene, statistics, noise, load_seconds, interrupted};
    if (auto done = write_text_atomically(options.statistics_file, format_report(report)); !done) return done.error();
  }
  print_summary(options, *scene, statistics, noise, interrupted);
  return interrupted ? ExitCode::Interrupted : ExitCode::Ok;
}

}  // namespace brume
