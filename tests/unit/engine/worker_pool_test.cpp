#include "renderer/engine/worker_pool.h"

#include <gtest/gtest.h>

#include <set>

namespace brume {
namespace {

TEST(WorkerPool, RunsEveryIterationOnce) {
  for (const int threads : {1, 2, 7}) {
    WorkerPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    for (const int n : {0, 1, 5, 1000}) {
      std::vector<std::atomic<int>> runs(static_cast<std::size_t>(n));
      pool.run(n, [&](int i, Worker&) { ++runs[static_cast<std::size_t>(i)]; });
      for (const auto& r : runs) ASSERT_EQ(r, 1);
    }
  }
}

TEST(WorkerPool, ZeroThreadsMeanAllOfTheMachine) { EXPECT_GE(WorkerPool(0).threads(), 1); }

TEST(WorkerPool, ManyShortLoopsInARowNeitherHangNorOverlap) {
  WorkerPool pool(4);
  std::atomic<int> inside = 0;
  int done = 0;
  for (int loop = 0; loop < 2000; ++loop) {
    pool.run(8, [&](int, Worker&) { ++inside; });
    ASSERT_EQ(inside.exchange(0), 8);
    ++done;
  }
  EXPECT_EQ(done, 2000);
}

TEST(WorkerPool, AWorkerIsNeverUsedByTwoThreadsAtOnce) {
  WorkerPool pool(4);
  std::mutex mutex;
  std::set<const Worker*> busy;
  bool shared = false;
  pool.run(400, [&](int, Worker& worker) {
    {
      const std::lock_guard lock(mutex);
      shared |= !busy.insert(&worker).second;
    }
    std::this_thread::yield();
    const std::lock_guard lock(mutex);
    busy.erase(&worker);
  });
  EXPECT_FALSE(shared);
}

TEST(WorkerPool, TotalsAddUpOverTheWorkersAndBeginAgainAfterTheyWereTaken) {
  WorkerPool pool(3);
  pool.run(100, [](int i, Worker& worker) {
    worker.statistics.rays += 1;
    worker.statistics.march.lookups += static_cast<std::uint64_t>(i);
    const ArenaScope scope(worker.arena);
    worker.arena.alloc_span<float>(1000)[0] = 0;
  });
  const WorkerPool::Totals totals = pool.take_totals();
  EXPECT_EQ(totals.statistics.rays, 100u);
  EXPECT_EQ(totals.statistics.march.lookups, 4950u);
  EXPECT_EQ(totals.arena_high_water_bytes, 4032u);
  EXPECT_GE(totals.cpu_seconds, 0);
  EXPECT_EQ(pool.take_totals().statistics.rays, 0u);
}

TEST(WorkerPool, ThreadsTakeDenormalNumbersAsZero) {
#if defined(__SSE__)
  WorkerPool pool(2);
  std::atomic<bool> flushed = true;
  pool.run(16, [&](int, Worker&) {
    volatile float small = 1e-30f;
    const volatile float product = small * 1e-10f;
    if (product != 0) flushed = false;
  });
  EXPECT_TRUE(flushed);
#else
  GTEST_SKIP() << "only set up for SSE";
#endif
}

}  // namespace
}  // namespace brume
