// The command line: what was typed becomes a call of one command.
#pragma once

namespace brume {

/// Parses, runs, reports. Results go to stdout, everything else to stderr.
/// @return the program's exit code, see ExitCode
int run_command_line(int argc, char** argv);

}  // namespace brume
