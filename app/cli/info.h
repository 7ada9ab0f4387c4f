// brume info: what a file holds.
#pragma once

#include <string>

#include "app/cli/exit_code.h"

namespace brume {

struct InfoOptions {
  std::string file;  ///< a scene, grids, or a picture that Brume wrote
  bool json = false;
};

Result<ExitCode> run_info(const InfoOptions& options);

}  // namespace brume
