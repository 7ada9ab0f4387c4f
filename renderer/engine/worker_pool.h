// Threads that render.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "renderer/core/arena.h"
#include "renderer/integrators/integrator.h"

namespace brume {

/// What one render thread owns: nothing in it is shared while a loop runs.
struct alignas(128) Worker {  // two cache lines, which are fetched in pairs: no thread writes to another's
  Arena arena;
  RayStatistics statistics;
  double cpu_seconds = 0;  ///< of this thread, inside loops
};

/// Seconds of work that a worker has done, from any beginning; read by the worker's own thread.
using WorkClock = std::function<double(const Worker&)>;

/// A fixed set of threads that run a loop together. The results of a loop whose iterations write only what is theirs do
/// not depend on the number of threads.
class WorkerPool {
 public:
  /// @param threads  0: as many as the machine has
  /// @param clock  none: the processor time of the thread; tests count work instead
  explicit WorkerPool(int threads = 0, WorkClock clock = {});
  ~WorkerPool();

  int threads() const { return static_cast<int>(workers_.size()); }

  /// Calls body(i, worker) for every i in [0, n), in any order; returns when all are done. One caller at a time.
  void run(int n, const std::function<void(int, Worker&)>& body);

  /// What the workers have done since the last call, added up; call between loops.
  struct Totals {
    RayStatistics statistics;
    double cpu_seconds = 0;
    std::size_t arena_high_water_bytes = 0;  ///< largest of the threads, since they began
  };
  Totals take_totals();

 private:
  void serve(const std::stop_token& stop, Worker& worker);

  std::vector<Worker> workers_;
  WorkClock clock_;
  std::mutex mutex_;
  std::condition_variable_any start_, done_;
  const std::function<void(int, Worker&)>* body_ = nullptr;
  std::uint64_t loop_ = 0;  // number of the current loop
  int count_ = 0;           // its iterations
  std::atomic<int> next_ = 0;
  int working_ = 0;                    // threads that have not finished it
  std::vector<std::jthread> threads_;  // last: they end before what they use
};

}  // namespace brume
