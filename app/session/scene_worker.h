// Reads files and commits scenes in a thread of its own.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/session/load_scene.h"
#include "app/session/truth.h"
#include "renderer/media/vdb_file.h"
#include "renderer/scene/compare.h"

namespace brume {

/// A variant with the scene that was committed of it.
struct CommittedVariant {
  Variant variant;
  std::shared_ptr<const Scene> scene;
};

/// What the worker is asked for: to open a file, or to commit a description.
struct SceneWish {
  std::string open = {};  ///< path; empty: commit `description`
  std::optional<Node> description = {};
  std::optional<TruthKey> truth = {};  ///< a reference is wanted: what is known of it,
  int width = 0, height = 0;           ///< and the size that it must have
};

struct SceneOutcome {
  SceneWish wish;
  std::optional<LoadedScene> loaded;    ///< of a wish to open
  std::vector<CommittedVariant> shown;  ///< empty: see error
  std::optional<FoundTruth> truth;
  std::optional<Error> error;
  std::map<std::string, std::vector<GridInfo>> grid_infos;  ///< by path
};

/// All functions are the UI thread's and never wait for the work.
class SceneWorker {
 public:
  /// @param reference_folder  empty: nowhere.  @param on_news  called from the worker when take() would give something
  SceneWorker(std::string reference_folder, std::function<void()> on_news);
  ~SceneWorker();

  /// The newest wish wins: an edit supersedes a commit that waits. One made while a file waits to be opened is dropped,
  /// for the file will replace the document.
  void request(SceneWish wish);
  /// What has been finished, if anything; the next wish is then taken up.
  std::unique_ptr<SceneOutcome> take();

  struct Activity {
    std::string what;  ///< "Reading smoke.vdb"
    float progress;    ///< 0..1
    double seconds;    ///< since it began
  };
  std::optional<Activity> activity() const;
  void cancel();
  /// Nothing is wished, being done or waiting to be taken.
  bool idle() const;

  SceneCache& cache() { return cache_; }

 private:
  void serve(const std::stop_token& stop);
  SceneOutcome fulfil(const SceneWish& wish, const std::stop_token& cancel);
  Result<std::vector<CommittedVariant>> commit_variants(const Node& description, CommitOptions options);

  std::string reference_folder_;
  std::function<void()> on_news_;
  SceneCache cache_;

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable_any wished_;
  std::unique_ptr<SceneWish> wish_;  // the newest, not yet taken up
  std::unique_ptr<SceneOutcome> outcome_;
  std::string working_on_;  // empty: nothing
  std::chrono::steady_clock::time_point work_began_;
  std::stop_source cancel_work_;
  std::atomic<float> progress_ = 0;
  // The thread's own.
  std::vector<CommittedVariant> last_committed_;
  TruthFinder truth_finder_;
  std::uint64_t commits_ = 0;
  std::jthread thread_;  // last: it ends before what it uses
};

}  // namespace brume
