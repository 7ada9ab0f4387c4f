// Many variants of a scene, each measured against the truth while it is rendered.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "renderer/analysis/metrics.h"
#include "renderer/experiments/reference.h"
#include "renderer/scene/compare.h"

namespace brume {

// ---- What is swept --------------------------------------------------------------------------------------------------

/// A variant, and what it has in common with others of the sweep.
struct SweepVariant {
  std::string name;    ///< "density, step_size 0.1"
  std::string series;  ///< its name without what was swept: variants of one series are one line of a chart
  Node description;
  std::size_t truth = 0;  ///< which of the sweep's references it is held against
};

/// The variants as they are, each a series of its own.
std::vector<SweepVariant> sweep_of(const std::vector<Variant>& variants);

/// Every method on the scene: all integrators, and the decoupled one with each distance sampling. Named by their keys:
/// "product", "density", ..., "ray_march", ...
std::vector<SweepVariant> all_methods(const Node& scene);

/// Each variant once for each value of a parameter ("render.step_size": "0.1", "0.2"); what does not have the
/// parameter stays as it is.  Errors: no variant has it, or takes the value.
Result<std::vector<SweepVariant>> swept(const std::vector<SweepVariant>& variants, const std::string& path,
                                        const std::vector<std::string>& values);

/// What is worth trying on a scene: all methods, those that march at a half, 1, 2 and 4 of the steps that they take by
/// default, the decoupled ones with 1, 2, 4 and 8 samples of each light.  Errors: the scene cannot be committed.
Result<std::vector<SweepVariant>> settings_to_search(const Node& scene, SceneCache& cache);

// ---- Measuring ------------------------------------------------------------------------------------------------------

/// One look at a picture that is being rendered.
struct SweepRow {
  std::size_t variant = 0;
  int samples_per_pixel = 0;
  double cpu_seconds = 0;  ///< of its own work, preparation included
  Errors errors;
  double reference_variance = 0;  ///< of the reference that it was held against
  bool last = false;              ///< of its variant
};

struct SweepOptions {
  int width = 0, height = 0;
  double cpu_seconds = 5;     ///< for each variant; the pass under way is ended
  int max_samples = 1 << 24;  ///< per pixel
  /// Called after every pass: fraction of all, the variant under way.
  std::function<void(double, const SweepVariant&)> progress = {};
  std::stop_token cancel = {};
};

struct Sweep {
  std::vector<SweepVariant> variants;
  std::vector<std::shared_ptr<const Scene>> scenes;  ///< as committed, with steps and samples resolved
  std::vector<SweepRow> rows;                        ///< variant by variant, in the order of time
  std::vector<Reference> references;
};

/// Renders one variant after the other and measures after 1, 2, 3, 4, 6, 8, 12, ... samples per pixel and at the end.
/// The time of a measurement counts for nobody.
/// Errors: a variant that cannot be committed; a reference of another size; cancelled.
Result<Sweep> run_sweep(std::vector<SweepVariant> variants, std::vector<Reference> references, SceneCache& cache,
                        WorkerPool& pool, const SweepOptions& options);

/// Whether a picture of so many samples is looked at: 1, 2, 3, 4, 6, 8, 12, 16, ...
bool is_measured(int samples_per_pixel);

}  // namespace brume
