// Renders in the background and shows the newest picture.
#pragma once

#include <chrono>
#include <memory>

#include "renderer/engine/pass.h"
#include "renderer/scene/scene.h"

namespace brume {

/// What has been spent on a picture.
struct RenderStatistics {
  int samples_per_pixel = 0;
  double wall_seconds = 0;  ///< since the scene was taken up, without pauses
  double cpu_seconds = 0;   ///< of the render threads, on this picture
  RayStatistics rays;
  std::size_t pool_high_water_bytes = 0;  ///< of the thread that needed most
  int threads = 0;
};

/// A published picture; never changes.
struct Picture {
  Image image;  ///< mean radiance; smaller than width x height while the picture is coarse
  int width = 0, height = 0;
  int divisor = 1;  ///< 1: full resolution
  std::uint64_t generation = 0;
  double noise = 0;       ///< relative, as Film::noise_estimate; 0 while coarse
  bool finished = false;  ///< the budget is used up
  RenderStatistics statistics;
};

/// One picture to render.
struct Job {
  std::shared_ptr<const Scene> scene;
  int width = 0, height = 0;
  int max_samples = 1 << 24;  ///< per pixel
};

/// Owns the render threads. The caller's thread (the UI) never waits: submit() leaves a wish, the newest wins and is
/// taken up as soon as the pass under way has been cancelled (within a row of a tile) or, if that is the first coarse
/// pass of an edit, completed and published; so pictures keep coming while edits do.
/// Jobs share the threads in turn: the one with the fewest samples is next.
class Engine {
 public:
  /// @param threads  0: as many as the machine has
  /// @param on_picture  called from a render thread when a picture has been published; must not block
  explicit Engine(int threads = 0, std::function<void()> on_picture = {});
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Replaces all jobs.
  void submit(std::vector<Job> jobs);

  /// Samples are kept; edits made meanwhile are still shown coarsely.
  void pause(bool paused);
  bool paused() const;

  /// The newest picture of a job; null before the first.
  std::shared_ptr<const Picture> picture(std::size_t job = 0) const;

  int threads() const { return pool_.threads(); }

 private:
  struct Progress;  // of one job

  void direct(const std::stop_token& stop);
  bool wishes_changed() const;
  void render_next(Progress& job);
  void start_film(Progress& job);
  void publish(Progress& job, FilmView view, int divisor);
  void account(Progress& job, std::chrono::steady_clock::time_point start);

  WorkerPool pool_;
  std::function<void()> on_picture_;
  mutable std::mutex mutex_;  // guards the members up to the next comment
  std::condition_variable_any changed_;
  std::vector<Job> wishes_;
  std::uint64_t wish_number_ = 0;
  bool paused_ = false;
  std::vector<std::shared_ptr<const Picture>> pictures_;

  std::atomic<std::uint64_t> newest_wish_ = 0;  // = wish_number_, for workers
  std::atomic<bool> stopping_ = false;
  std::uint64_t current_wish_ = 0;  // what the director works on
  double seconds_per_ray_;          // CPU cost of a camera ray, measured on the last pass
  std::jthread director_;           // last: it ends before what it uses
};

/// The same passes, one after the other, on the caller's thread and the pool's: the batch renderer, and what tests
/// compare the engine with. Same scene, size and samples give the same bits as the engine.
/// @param after_pass  called after every pass with what there is; false ends the rendering
struct BatchProgress {
  const Film& film;
  const RenderStatistics& statistics;
};
RenderStatistics render_batch(const Scene& scene, int samples, Film& film, WorkerPool& pool,
                              const std::function<bool(const BatchProgress&)>& after_pass = {});

}  // namespace brume
