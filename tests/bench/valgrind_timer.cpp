// Loaded into the program when Valgrind counts its instructions.
#include <cstdint>

namespace hwy::platform {

/// Highway 1.0 measures its timer whenever it is loaded, though nothing of Brume asks for it, with an instruction that
/// Valgrind 3.19 does not know (RDTSCP). This takes its place.
__attribute__((visibility("default"))) std::uint64_t TimerResolution() { return 1; }

}  // namespace hwy::platform
