// brume docs: every parameter of a scene, as a Markdown page.
#pragma once

#include "app/cli/exit_code.h"

namespace brume {

Result<ExitCode> run_docs();

}  // namespace brume
