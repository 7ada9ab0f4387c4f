// brume schema: the JSON Schema of scene files.
#pragma once

#include "app/cli/exit_code.h"

namespace brume {

Result<ExitCode> run_schema();

}  // namespace brume
