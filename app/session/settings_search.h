// The cheapest settings for a scene, looked for in the background.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "renderer/experiments/sweep.h"

namespace brume {

/// Measures methods x steps x light samples on a small picture of the scene against its reference. All functions: any
/// thread, without waiting.
class SettingsSearch {
 public:
  /// @param on_news  called from the searching thread when there is something new; must not block
  explicit SettingsSearch(std::function<void()> on_news = {}) : on_news_(std::move(on_news)) {}

  /// Ends a search that is under way. What was found before is forgotten.
  struct Options {
    int threads = 0;
    std::string folder = {};  ///< where references are kept; empty: nowhere
    double effort = 1;        ///< share of the usual time
  };
  /// @param cache  outlives the search
  void start(const Node& scene, SceneCache& cache, const Options& options);
  void cancel();

  struct Progress {
    double done;       ///< 0..1
    std::string what;  ///< "reference", "product, step_size 0.02, light_samples 4"
  };
  /// Nothing when no search is under way.
  std::optional<Progress> progress() const;
  /// Of the last search; null before its end.
  std::shared_ptr<const Sweep> found() const;
  /// Why it has failed; empty when it has not.
  std::string problem() const;

 private:
  void search(const Node& scene, SceneCache& cache, const Options& options, const std::stop_token& stop);
  void tell(double done, std::string what);

  std::function<void()> on_news_;
  mutable std::mutex mutex_;  // guards what follows
  std::optional<Progress> progress_;
  std::shared_ptr<const Sweep> found_;
  std::string problem_;
  std::jthread thread_;  // last: it ends before what it uses
};

}  // namespace brume
