#include "renderer/media/load_options.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <mutex>

#include "renderer/core/parallel.h"

namespace brume {
namespace {

std::string gigabytes(std::uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GB", static_cast<double>(bytes) * 1e-9);
  return text;
}

}  // namespace

LoadOptions part_of(const LoadOptions& options, float from, float to) {
  LoadOptions part{{}, options.cancel, options.full_precision};
  if (options.progress) part.progress = [&options, from, to](float p) { options.progress(from + (to - from) * p); };
  return part;
}

Error loading_cancelled() { return {ErrorCode::Cancelled, "loading was cancelled"}; }

bool parallel_load(std::int64_t n, const LoadOptions& options, float from, float to,
                   const std::function<void(std::int64_t)>& body) {
  constexpr std::int64_t kChunk = 256;  // bricks: about 100 microseconds
  const int chunks = static_cast<int>((n + kChunk - 1) / kChunk);
  std::mutex mutex;
  int done = 0;
  parallel_for(chunks, [&](int c) {
    if (options.cancel.stop_requested()) return;
    for (std::int64_t i = c * kChunk; i < std::min(n, (c + 1) * kChunk); ++i) body(i);
    if (!options.progress) return;
    const std::lock_guard lock(mutex);
    ++done;
    options.progress(from + (to - from) * static_cast<float>(done) / static_cast<float>(chunks));
  });
  return !options.cancel.stop_requested();
}

Result<void> check_memory(std::uint64_t bytes) {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page <= 0) return {};
  const std::uint64_t machine = static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page);
  if (bytes <= machine) return {};
  return bad_input("the grid needs " + gigabytes(bytes) + " of memory, but the machine has " + gigabytes(machine) +
                   "; crop it or halve its resolution");
}

}  // namespace brume
