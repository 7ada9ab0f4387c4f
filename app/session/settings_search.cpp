#include "app/session/settings_search.h"

#include <algorithm>

namespace brume {
namespace {

constexpr int kWidth = 192;              // pixels of the picture that is measured
constexpr double kReferenceTime = 20;    // CPU seconds
constexpr double kTimeOfVariant = 0.3;   // the same
constexpr double kReferenceShare = 0.3;  // of the progress

}  // namespace

void SettingsSearch::start(const Node& scene, SceneCache& cache, const Options& options) {
  cancel();
  if (thread_.joinable()) thread_.join();  // within a pass of a small picture
  {
    const std::lock_guard lock(mutex_);
    progress_ = Progress{0, "reference"};
    found_.reset();
    problem_.clear();
  }
  thread_ = std::jthread([this, scene, &cache, options](const std::stop_token& stop) {
    search(scene, cache, options, stop);
    {
      const std::lock_guard lock(mutex_);
      progress_.reset();
    }
    if (on_news_) on_news_();
  });
}

void SettingsSearch::cancel() { thread_.request_stop(); }

std::optional<SettingsSearch::Progress> SettingsSearch::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

std::shared_ptr<const Sweep> SettingsSearch::found() const {
  const std::lock_guard lock(mutex_);
  return found_;
}

std::string SettingsSearch::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

void SettingsSearch::tell(double done, std::string what) {
  {
    const std::lock_guard lock(mutex_);
    progress_ = Progress{done, std::move(what)};
  }
  if (on_news_) on_news_();
}

void SettingsSearch::search(const Node& scene, SceneCache& cache, const Options& options, const std::stop_token& stop) {
  const auto fail = [this](const Error& error) {
    const std::lock_guard lock(mutex_);
    if (error.code != ErrorCode::Cancelled) problem_ = error.to_string();
  };
  const Numbers& resolution = scene.child("film").numbers("resolution");
  const int height = std::max(1, static_cast<int>(std::lround(kWidth * resolution[1] / resolution[0])));
  WorkerPool pool(options.threads);
  auto variants = settings_to_search(scene, cache);
  if (!variants) return fail(variants.error());
  auto reference = make_reference(scene, cache, pool,
                                  {.width = kWidth,
                                   .height = height,
                                   .cpu_seconds = kReferenceTime * options.effort,
                                   .folder = options.folder,
                                   .progress = [this](double done) { tell(kReferenceShare * done, "reference"); },
                                   .cancel = stop});
  if (!reference) return fail(reference.error());
  auto sweep = run_sweep(
      std::move(*variants), {std::move(*reference)}, cache, pool,
      {.width = kWidth,
       .height = height,
       .cpu_seconds = kTimeOfVariant * options.effort,
       .progress = [this](double done,
                          const SweepVariant& v) { tell(kReferenceShare + (1 - kReferenceShare) * done, v.name); },
       .cancel = stop});
  if (!sweep) return fail(sweep.error());
  const std::lock_guard lock(mutex_);
  found_ = std::make_shared<const Sweep>(std::move(*sweep));
}

}  // namespace brume
