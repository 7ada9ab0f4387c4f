// What the program tells the person at the terminal, and what it hands to the next program.
#pragma once

#include <string>
#include <string_view>

#include "renderer/core/error.h"

namespace brume {

/// Each is one line on stderr, "brume: error: scene.json:3:7: lights[0]: ...". Bytes that would move the cursor become
/// "?": names of files and grids come from strangers.
void print_error(const Error& error);
void print_warning(const std::string& text);
void print_note(const std::string& text);

/// The result of a command, on stdout. An error when it cannot be written to its end (a full disk).
Result<void> print_result(std::string_view text);

/// A person watches stderr.
bool stderr_is_terminal();

}  // namespace brume
