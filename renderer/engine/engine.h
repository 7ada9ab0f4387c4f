// Renders in the background and shows the newest picture.
#pragma once

#include <chrono>
#include <memory>

#include "renderer/engine/fair_share.h"
#include "renderer/engine/pass.h"
#include "renderer/scene/scene.h"

namespace brume {

/// What has been spent on a picture.
struct RenderStatistics {
  int samples_per_pixel = 0;
  double wall_seconds = 0;  ///< of the turns that this picture had
  double cpu_seconds = 0;   ///< of the render threads, on this picture
  RayStatistics rays;
  std::size_t pool_high_water_bytes = 0;  ///< of the thread that needed most
  int threads = 0;
};

/// A published picture; never changes.
struct Picture {
  Image image;  ///< mean radiance; smaller than width x height while the picture is coarse
  int width = 0, height = 0;
  int divisor = 1;       ///< 1: full resolution
  bool preview = false;  ///< as render_preview(): not a sample per pixel yet
  std::uint64_t generation = 0;
  double noise = 0;       ///< relative, as Film::noise_estimate; 0 of previews
  double variance = 0;    ///< as Film::mean_variance; 0 of previews
  bool finished = false;  ///< the budget is used up
  RenderStatistics statistics;
};

/// One picture to render.
struct Job {
  std::shared_ptr<const Scene> scene;
  int width = 0, height = 0;
  int max_samples = 1 << 24;       ///< per pixel
  std::uint32_t first_sample = 0;  ///< number of the first pass, for a picture that goes on where another one ended

  bool operator==(const Job&) const = default;  ///< the very same scene
};

struct EngineOptions {
  int threads = 0;                        ///< 0: as many as the machine has
  std::function<void()> on_picture = {};  ///< called from a render thread after a picture is published; must not block
  WorkClock clock = {};                   ///< as WorkerPool's
};

/// Owns the render threads. The caller's thread (the UI) never waits: submit() leaves a wish, the newest wins and is
/// taken up as soon as the pass under way has been cancelled (within a row of a tile) or, if that is the first coarse
/// pass of an edit, completed and published; so pictures keep coming while edits do.
/// Several jobs take turns of a tenth of a second, in the middle of a pass if need be, so that a slow one does not keep
/// the others waiting. The picture of each is bit for bit what it is when rendered alone.
class Engine {
 public:
  explicit Engine(const EngineOptions& options = {});
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Replaces all jobs. What is the same as before keeps its samples, whatever its place in the list, unless
  /// everything is to start again.
  void submit(std::vector<Job> jobs, bool restart = false);

  /// How jobs share the threads from now on.
  void set_share(Share share);

  /// Samples are kept; edits made meanwhile are still shown coarsely.
  void pause(bool paused);
  bool paused() const;

  /// The newest picture of a job; null before the first.
  std::shared_ptr<const Picture> picture(std::size_t job = 0) const;

  int threads() const { return pool_.threads(); }

 private:
  struct Progress;  // of one job

  void direct(const std::stop_token& stop);
  std::optional<std::size_t> next_job(const std::vector<Progress>& jobs) const;
  void take_up_wishes(std::vector<Progress>& jobs);
  Cancelled cancelled() const;
  void render_next(Progress& job, std::size_t jobs);
  /// Both return the number of camera rays, 0 when they were cancelled.
  double render_next_preview(Progress& job, std::size_t jobs);
  double render_slice(Progress& job, std::size_t jobs);
  void start_film(Progress& job);
  void publish(Progress& job, FilmView view, int preview);
  void account(Progress& job, std::chrono::steady_clock::time_point start);

  WorkerPool pool_;
  std::function<void()> on_picture_;
  mutable std::mutex mutex_;  // guards the members up to the next comment
  std::condition_variable_any changed_;
  std::vector<Job> wishes_;
  bool wished_ = false, restart_ = false;  // there are wishes to take up; they want nothing kept
  std::optional<Job> running_;             // has a turn now
  Share share_ = Share::EqualTime;
  bool paused_ = false;
  std::vector<std::shared_ptr<const Picture>> pictures_;

  std::atomic<bool> cancel_ = false;  // what has a turn now is not wanted any more
  std::atomic<bool> news_ = false;    // = wished_, for workers: what has a turn now ends it soon
  std::atomic<bool> stopping_ = false;
  // The rest is the director's own.
  std::size_t first_look_ = 0;           // job that may show its first picture next
  std::vector<double> seconds_per_ray_;  // CPU cost of a camera ray of each job, measured on its last turn
  std::jthread director_;                // last: it ends before what it uses
};

/// The same passes, one after the other, on the caller's thread and the pool's: the batch renderer, and what tests
/// compare the engine with. Same scene, size and samples give the same bits as the engine.
/// @param after_pass  called after every pass with what there is; false ends the rendering
/// @param first_sample  number of the first pass, for a picture that goes on where another one ended
struct BatchProgress {
  const Film& film;
  const RenderStatistics& statistics;
};
RenderStatistics render_batch(const Scene& scene, int samples, Film& film, WorkerPool& pool,
                              const std::function<bool(const BatchProgress&)>& after_pass = {},
                              std::uint32_t first_sample = 0);

}  // namespace brume
