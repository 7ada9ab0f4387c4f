#include "renderer/engine/worker_pool.h"

#include "renderer/core/parallel.h"

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace brume {
namespace {

/// Denormals, the tails of exp, are taken as 0: they would make a core many times slower.
void flush_denormals() {
#if defined(__SSE__)
  _mm_setcsr(_mm_getcsr() | 0x8040);  // flush to zero, denormals are zero
#endif
}

}  // namespace

WorkerPool::WorkerPool(int threads, WorkClock clock)
    : workers_(static_cast<std::size_t>(threads > 0 ? threads : hardware_threads())),
      clock_(clock ? std::move(clock) : [](const Worker&) { return thread_cpu_seconds(); }) {
  for (Worker& worker : workers_)
    threads_.emplace_back([this, &worker](const std::stop_token& stop) { serve(stop, worker); });
}

WorkerPool::~WorkerPool() = default;

void WorkerPool::serve(const std::stop_token& stop, Worker& worker) {
  flush_denormals();
  std::uint64_t seen = 0;
  while (true) {
    std::unique_lock lock(mutex_);
    if (!start_.wait(lock, stop, [&] { return loop_ != seen; })) return;
    seen = loop_;
    const auto& body = *body_;
    const int count = count_;
    lock.unlock();

    const double before = clock_(worker);
    for (int i = next_++; i < count; i = next_++) body(i, worker);
    worker.cpu_seconds += clock_(worker) - before;

    lock.lock();
    if (--working_ == 0) done_.notify_all();
  }
}

void WorkerPool::run(int n, const std::function<void(int, Worker&)>& body) {
  std::unique_lock lock(mutex_);
  body_ = &body;
  count_ = n;
  next_ = 0;
  working_ = threads();
  ++loop_;
  start_.notify_all();
  done_.wait(lock, [&] { return working_ == 0; });
}

WorkerPool::Totals WorkerPool::take_totals() {
  Totals totals;
  for (Worker& worker : workers_) {
    totals.statistics += worker.statistics;
    totals.cpu_seconds += worker.cpu_seconds;
    totals.arena_high_water_bytes = std::max(totals.arena_high_water_bytes, worker.arena.high_water_bytes());
    worker.statistics = {};
    worker.cpu_seconds = 0;
  }
  return totals;
}

}  // namespace brume
