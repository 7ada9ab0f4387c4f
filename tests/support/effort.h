// How much work a test of random things may do.
#pragma once

#include <cstdlib>
#include <string_view>

namespace brume {

/// BRUME_TEST_FULL=1 in the environment: more samples and less noise than in the tests of every change.
inline bool full_effort() {
  const char* value = std::getenv("BRUME_TEST_FULL");
  return value && std::string_view(value) == "1";
}

/// Divides numbers of samples where a sanitizer makes the code tens of times slower.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr int kFewer = 16;
#else
inline constexpr int kFewer = 1;
#endif

}  // namespace brume
