#include "app/cli/chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/cli/console.h"
#include "app/cli/interrupt.h"
#include "app/cli/output_file.h"
#include "app/cli/progress_line.h"
#include "app/cli/text_table.h"
#include "app/headless/chart_file.h"
#include "app/session/user_folders.h"
#include "app/ui/formatted.h"
#include "renderer/analysis/chart_layout.h"
#include "renderer/experiments/sweep_chart.h"
#include "renderer/integrators/registry.h"
#include "renderer/scene_io/scene_file.h"

namespace brume {
namespace {

Error unknown(const std::string& flag, const std::string& what, const std::string& word,
              const std::vector<std::string>& valid) {
  return bad_input(unknown_name(what, word, valid), {"", 0, 0, flag});
}

Result<void> check(const ChartOptions& o) {
  for (const std::string& output : o.outputs)
    if (auto done = check_output(output, {".svg", ".png", ".csv"}); !done) return done;
  if (!o.best.empty())
    if (auto done = check_output(o.best, {".json"}); !done) return done;
  if (!find_sweep_axis(o.x)) return unknown("--x", "quantity", o.x, sweep_axis_keys());
  if (!find_sweep_axis(o.y)) return unknown("--y", "quantity", o.y, sweep_axis_keys());
  if (!o.variants.empty() && !o.methods.empty())
    return bad_input("found --variants as well, expected one of the two", {"", 0, 0, "--methods"});
  if ((o.front || o.target || !o.best.empty()) &&
      (o.x != "cpu_seconds" || find_sweep_axis(o.y)->kind != SweepAxis::Kind::Error))
    return bad_input(
        "found a chart of " + o.y + " against " + o.x + ", expected an error against cpu_seconds to choose the best",
        {"", 0, 0, "--pareto"});
  return {};
}

/// Those of `all` that are named, in the order of the names.
Result<std::vector<SweepVariant>> named(std::vector<SweepVariant> all, const std::vector<std::string>& names,
                                        const std::string& flag, const std::string& what) {
  if (names.empty() || names == std::vector<std::string>{"all"}) return all;
  std::vector<std::string> valid;
  for (const SweepVariant& v : all) valid.push_back(v.name);
  std::vector<SweepVariant> chosen;
  for (const std::string& name : names) {
    const auto found = std::find(valid.begin(), valid.end(), name);
    if (found == valid.end()) return unknown(flag, what, name, valid);
    chosen.push_back(all[static_cast<std::size_t>(found - valid.begin())]);
  }
  return chosen;
}

Result<std::vector<SweepVariant>> variants_to_chart(const ChartOptions& o, Node scene) {
  // Costs are compared at like steps: the shadow's are those of the camera.
  if (o.x == "steps")
    if (auto done = set_by_path(scene, "render.shadow_step_size", "auto"); !done) return done.error();
  Result<std::vector<SweepVariant>> variants = std::vector<SweepVariant>();
  if (o.methods.empty()) {
    const auto own = variants_of(scene);
    if (!own) return own.error();
    variants = named(sweep_of(*own), o.variants, "--variants", "variant");
  } else {
    variants = named(all_methods(scene), o.methods, "--methods", "method");
  }
  const auto sweep_over = [&](const char* flag, const char* path, const std::vector<std::string>& values) {
    if (!variants || values.empty()) return;
    auto more = swept(*variants, path, values);
    if (!more) more = Error{bad_input(more.error().message, {"", 0, 0, flag})};
    variants = std::move(more);
  };
  sweep_over("--steps", "render.step_size", o.steps);
  sweep_over("--light-samples", "render.light_samples", o.light_samples);
  sweep_over("--bounces", "render.bounces", o.bounces);
  return variants;
}

void stop_if_interrupted(std::stop_source& work) {
  if (InterruptGuard::requested()) work.request_stop();
}

/// The true picture of the scene and, where bounces are swept, that of each number of them; variants are told theirs.
Result<std::vector<Reference>> truths(const ChartOptions& o, const Node& scene, SceneCache& cache, WorkerPool& pool,
                                      std::vector<SweepVariant>& variants, std::stop_source& cancel) {
  const FilmSettings film = read_film_settings(scene.child("film"));
  std::vector<Reference> truths;
  if (!o.reference.empty()) {
    auto given = load_reference(o.reference, film.width, film.height);
    if (!given) return given.error();
    truths.push_back(std::move(*given));
    return truths;
  }
  std::vector<int> bounces;
  if (o.bounces.empty()) bounces.push_back(scene.child("render").integer("bounces"));
  for (SweepVariant& v : variants) {
    const int own = o.bounces.empty() ? bounces.front() : v.description.child("render").integer("bounces");
    v.truth = static_cast<std::size_t>(std::find(bounces.begin(), bounces.end(), own) - bounces.begin());
    if (v.truth == bounces.size()) bounces.push_back(own);
  }
  for (const int n : bounces) {
    Node lit = scene;
    if (auto done = lit.child("render").set("bounces", std::int64_t{n}); !done) return done.error();
    ProgressLine line("reference");
    auto made = make_reference(lit, cache, pool,
                               {.width = film.width,
                                .height = film.height,
                                .cpu_seconds = o.reference_seconds,
                                .folder = reference_folder(),
                                .progress =
                                    [&](double done) {
                                      stop_if_interrupted(cancel);
                                      line.update({done});
                                    },
                                .cancel = cancel.get_token()});
    if (!made) return made.error();
    truths.push_back(std::move(*made));
  }
  return truths;
}

Result<void> write_outputs(const ChartOptions& o, const Sweep& sweep, const Chart& chart) {
  const ChartSize size{static_cast<float>(o.width), static_cast<float>(o.height), 14,
                       o.light ? Ground::Light : Ground::Dark};
  const Drawing drawing = lay_out(chart, size).drawing;
  for (const std::string& path : o.outputs)
    if (auto done = write_chart(path, drawing, sweep); !done) return done;
  return {};
}

std::string table_of(const Sweep& sweep) {
  std::vector<std::vector<std::string>> rows{{"variant", "samples", "CPU s", "RMSE", "median of tiles", "mean bias"}};
  for (const SweepRow& r : sweep.rows)
    if (r.last)
      rows.push_back({sweep.variants[r.variant].name, std::to_string(r.samples_per_pixel),
                      formatted("%.2f", r.cpu_seconds), formatted("%.3g", r.errors.rmse),
                      formatted("%.3g", r.errors.median_of_tiles),
                      formatted("%+.2f %%", 100 * r.errors.relative_mean_bias)});
  return format_table(rows, "lrrrrr", 0);
}

/// The scene with the settings of the best variant, and a sentence about it.
Result<std::string> choose_best(const ChartOptions& o, const Sweep& sweep, const Node& scene) {
  const SweepAxis& error = *find_sweep_axis(o.y);
  const auto best = best_row(sweep, error, o.target);
  if (!best)
    return "No variant came to the target of " + format_value(*o.target) + "; allow more time with --budget.\n";
  const SweepRow& row = sweep.rows[*best];
  const SweepVariant& winner = sweep.variants[row.variant];
  char text[160];
  std::snprintf(text, sizeof text, ": %s %.3g after %.2f CPU seconds and %d samples per pixel.\n", error.key.c_str(),
                error.value(sweep, row), row.cpu_seconds, row.samples_per_pixel);
  if (!o.best.empty()) {
    const Node chosen = with_variants_of(winner.description, scene);
    if (auto done = write_scene_file(o.best, chosen); !done) return done.error();
  }
  return "Best: " + winner.name + text;
}

}  // namespace

Result<ExitCode> run_chart(const ChartOptions& o) {
  if (auto done = check(o); !done) return done.error();
  SceneCache cache;
  auto loaded = load_scene(o.scene, cache, {});
  if (!loaded) return loaded.error();
  const Node& scene = loaded->description;
  auto variants = variants_to_chart(o, scene);
  if (!variants) return variants.error();
  const FilmSettings film = read_film_settings(scene.child("film"));

  const InterruptGuard guard;
  std::stop_source cancel;
  WorkerPool pool(o.threads);
  auto references = truths(o, scene, cache, pool, *variants, cancel);
  if (InterruptGuard::requested()) return ExitCode::Interrupted;
  if (!references) return references.error();
  Result<Sweep> sweep = Sweep{};
  {
    ProgressLine line("charting");
    sweep = run_sweep(std::move(*variants), std::move(*references), cache, pool,
                      {.width = film.width,
                       .height = film.height,
                       .cpu_seconds = o.seconds,
                       .max_samples = o.samples.value_or(1 << 24),
                       .progress =
                           [&](double done, const SweepVariant& v) {
                             stop_if_interrupted(cancel);
                             line.update({done, v.name});
                           },
                       .cancel = cancel.get_token()});
  }
  if (InterruptGuard::requested()) return ExitCode::Interrupted;
  if (!sweep) return sweep.error();

  const SweepAxis &x = *find_sweep_axis(o.x), &y = *find_sweep_axis(o.y);
  Chart chart = chart_of(*sweep, x, y, o.title.empty() ? y.label + " against " + x.label : o.title);
  chart.subtitle = loaded->file.substr(loaded->file.rfind('/') + 1) + ", " + std::to_string(film.width) + " x " +
                   std::to_string(film.height);
  const bool choosing = o.front || o.target || !o.best.empty();
  if (choosing) add_front(*sweep, y, o.target, chart);
  if (auto done = write_outputs(o, *sweep, chart); !done) return done.error();
  std::string text = table_of(*sweep);
  if (choosing) {
    const auto best = choose_best(o, *sweep, scene);
    if (!best) return best.error();
    text += *best;
  }
  if (auto done = print_result(text); !done) return done.error();
  const bool reached = !o.target || best_row(*sweep, y, o.target);
  return reached ? ExitCode::Ok : ExitCode::CheckFailed;
}

}  // namespace brume
