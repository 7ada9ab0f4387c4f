// Brume, a preview of light in volumes.
#include <cstdlib>

#include "app/cli/command_line.h"
#include "app/cli/console.h"
#include "app/cli/exit_code.h"
#include "renderer/core/simd.h"

int main(int argc, char** argv) {
  // Tests and bug reports name the vector instructions: BRUME_SIMD=sse4 brume ...
  if (const char* level = std::getenv("BRUME_SIMD")) {
    if (const auto done = brume::force_simd_level(level); !done) {
      brume::Error error = done.error();
      error.source.key = "BRUME_SIMD";
      brume::print_error(error);
      return static_cast<int>(brume::exit_code_of(error));
    }
  }
  return brume::run_command_line(argc, argv);
}
