// brume bench: how fast this machine renders.
#pragma once

#include <string>

#include "app/cli/exit_code.h"

namespace brume {

struct BenchCommandOptions {
  std::string only;  ///< part of the names of what is measured; empty: everything
  bool json = false;
  bool markdown = false;
  std::string csv_file;  ///< written besides; empty: none
};

Result<ExitCode> run_bench_command(const BenchCommandOptions& options);

}  // namespace brume
