#include "renderer/core/parallel.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <ctime>
#include <thread>
#include <vector>

namespace brume {

int hardware_threads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

std::size_t last_cache_bytes() {
  const long bytes = sysconf(_SC_LEVEL3_CACHE_SIZE);
  return bytes > 0 ? static_cast<std::size_t>(bytes) : std::size_t{16} << 20;
}

// Plain threads rather than TBB: the loops are few and coarse (converting a grid), and the thread sanitizer sees
// through std::thread but not through an uninstrumented libtbb.
double parallel_for(int n, const std::function<void(int)>& body) {
  std::atomic<int> next = 0;
  std::atomic<double> seconds = 0;
  const auto work = [&] {
    const double before = thread_cpu_seconds();
    for (int i = next++; i < n; i = next++) body(i);
    seconds += thread_cpu_seconds() - before;
  };
  {
    std::vector<std::jthread> helpers;
    for (int k = 1; k < std::min(n, hardware_threads()); ++k) helpers.emplace_back(work);
    work();
  }
  return seconds;
}

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace brume
