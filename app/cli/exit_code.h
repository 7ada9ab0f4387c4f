// What the program's exit code says.
#pragma once

#include "renderer/core/error.h"

namespace brume {

enum class ExitCode {
  Ok = 0,
  Internal = 1,      ///< a fault of the program or the machine
  BadInput = 2,      ///< a file, scene, flag or value that the user can mend
  CheckFailed = 3,   ///< a comparison or check did not hold
  Interrupted = 130  ///< Ctrl+C: what there was has been saved (128 + SIGINT, as shells count)
};

inline ExitCode exit_code_of(const Error& error) {
  switch (error.code) {
    case ErrorCode::BadInput:
      return ExitCode::BadInput;
    case ErrorCode::Cancelled:
      return ExitCode::Interrupted;
    case ErrorCode::Internal:
      break;
  }
  return ExitCode::Internal;
}

}  // namespace brume
