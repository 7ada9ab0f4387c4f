// The one place where a loop is spread over threads (outside the engine's own workers).
#pragma once

#include <cstddef>
#include <functional>

namespace brume {

/// Calls body(i) for every i in [0, n), in any order, on up to all hardware threads; returns when all are done.
/// `body` must not throw and must write only what belongs to its own i.
/// @return processor time of all threads together, seconds
double parallel_for(int n, const std::function<void(int)>& body);

/// Processor time that the calling thread has had, seconds.
double thread_cpu_seconds();

/// Threads the machine offers; at least 1.
int hardware_threads();

/// Size of the cache before memory; 16 MiB where the machine does not tell.
std::size_t last_cache_bytes();

}  // namespace brume
