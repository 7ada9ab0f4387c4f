#include "renderer/experiments/sweep.h"

#include <algorithm>

#include "renderer/engine/survey.h"
#include "renderer/integrators/registry.h"

namespace brume {

std::vector<SweepVariant> sweep_of(const std::vector<Variant>& variants) {
  std::vector<SweepVariant> sweep;
  for (const Variant& v : variants) sweep.push_back({v.name, v.name, v.description});
  return sweep;
}

std::vector<SweepVariant> all_methods(const Node& scene) {
  std::vector<SweepVariant> methods;
  for (const IntegratorType& type : integrator_types()) {
    Node description = without_variants(scene);
    Node& render = description.child("render");
    render = render.converted_to(type.table);
    const Param* distances = type.table.key == "decoupled" ? type.table.find("distance_sampling") : nullptr;
    if (!distances) {
      methods.push_back({type.table.key, type.table.key, description});
      continue;
    }
    for (const Choice& choice : distances->choices) {
      static_cast<void>(render.set("distance_sampling", choice.key).ok());
      methods.push_back({choice.key, choice.key, description});
    }
  }
  return methods;
}

Result<std::vector<SweepVariant>> swept(const std::vector<SweepVariant>& variants, const std::string& path,
                                        const std::vector<std::string>& values) {
  std::vector<SweepVariant> all;
  std::optional<Error> missing;
  bool found = false;
  for (const SweepVariant& variant : variants) {
    Node description = variant.description;
    if (const auto param = find_param(description, path); !param) {
      missing = param.error();
      all.push_back(variant);
      continue;
    }
    found = true;
    for (const std::string& value : values) {
      description = variant.description;
      if (const auto done = set_by_path(description, path, value); !done) return done.error();
      all.push_back({variant.name + ", " + path.substr(path.rfind('.') + 1) + " " + value, variant.series, description,
                     variant.truth});
    }
  }
  if (!found && missing) return *missing;
  return all;
}

namespace {

/// A half, 1, 2 and 4 of the step that the scene takes by default.
Result<std::vector<std::string>> steps_to_search(Node marched, SceneCache& cache) {
  if (const auto done = set_by_path(marched, "render.step_size", "auto"); !done) return done.error();
  const auto scene = commit(marched, cache, {});
  if (!scene) return scene.error();
  std::vector<std::string> steps;
  for (const double factor : {0.5, 1.0, 2.0, 4.0})
    steps.push_back(short_number(factor * static_cast<double>((*scene)->step_size)));
  return steps;
}

bool has(const SweepVariant& variant, const char* param) {
  Node description = variant.description;
  return find_param(description, param).ok();
}

}  // namespace

Result<std::vector<SweepVariant>> settings_to_search(const Node& scene, SceneCache& cache) {
  std::vector<SweepVariant> methods = all_methods(scene);
  const auto marched =
      std::find_if(methods.begin(), methods.end(), [](const SweepVariant& v) { return has(v, "render.step_size"); });
  const auto steps = steps_to_search(marched->description, cache);  // the same of all
  if (!steps) return steps.error();
  std::vector<SweepVariant> all;
  for (SweepVariant& method : methods) {
    const bool marches = has(method, "render.step_size"),
               is_decoupled = method.description.child("render").kind() == "decoupled";
    Result<std::vector<SweepVariant>> of_method = std::vector<SweepVariant>{std::move(method)};
    if (marches) of_method = swept(*of_method, "render.step_size", *steps);
    if (of_method && is_decoupled) of_method = swept(*of_method, "render.light_samples", {"1", "2", "4", "8"});
    if (!of_method) return of_method.error();
    all.insert(all.end(), of_method->begin(), of_method->end());
  }
  return all;
}

bool is_measured(int samples_per_pixel) {
  int power = 1;
  while (2 * power <= samples_per_pixel) power *= 2;
  return samples_per_pixel == power || 2 * samples_per_pixel == 3 * power;
}

namespace {

/// The rows of one variant.
Result<std::vector<SweepRow>> measure(std::size_t index, const Scene& scene, const Reference& truth, WorkerPool& pool,
                                      const SweepOptions& options, const std::function<void(double)>& progress) {
  // What is touched for the first time, memory and code, costs time that is nobody's.
  Image warm;
  const auto integrator = make_integrator(scene);
  render_preview(scene, *integrator, options.width, options.height, 4, warm, pool, {});

  std::vector<SweepRow> rows;
  std::optional<Error> error;
  Film film(options.width, options.height);
  render_batch(scene, options.max_samples, film, pool, [&](const BatchProgress& p) {
    const RenderStatistics& s = p.statistics;
    if (options.cancel.stop_requested()) return false;
    const bool last = s.cpu_seconds >= options.cpu_seconds || s.samples_per_pixel == options.max_samples;
    if (last || is_measured(s.samples_per_pixel)) {
      const auto errors = errors_of(p.film.mean_image(), truth.image);
      if (errors)
        rows.push_back({index, s.samples_per_pixel, s.cpu_seconds, *errors, truth.variance, last});
      else
        error = errors.error();
    }
    progress(std::max(s.cpu_seconds / options.cpu_seconds, double(s.samples_per_pixel) / options.max_samples));
    return !last && !error;
  });
  if (error) return *error;
  return rows;
}

}  // namespace

Result<Sweep> run_sweep(std::vector<SweepVariant> variants, std::vector<Reference> references, SceneCache& cache,
                        WorkerPool& pool, const SweepOptions& options) {
  Sweep sweep{std::move(variants), {}, {}, std::move(references)};
  for (const SweepVariant& v : sweep.variants) {
    auto scene = commit(v.description, cache, {.cancel = options.cancel});
    if (!scene) return under(v.name, scene.error());
    sweep.scenes.push_back(std::move(*scene));
  }
  for (std::size_t i = 0; i < sweep.variants.size(); ++i) {
    const auto progress = [&](double done) {
      if (!options.progress) return;
      const double n = static_cast<double>(sweep.variants.size());
      options.progress((static_cast<double>(i) + std::min(done, 1.0)) / n, sweep.variants[i]);
    };
    auto rows = measure(i, *sweep.scenes[i], sweep.references[sweep.variants[i].truth], pool, options, progress);
    if (!rows) return rows.error();
    if (options.cancel.stop_requested()) return Error{ErrorCode::Cancelled, "the sweep was cancelled"};
    sweep.rows.insert(sweep.rows.end(), rows->begin(), rows->end());
  }
  return sweep;
}

}  // namespace brume
