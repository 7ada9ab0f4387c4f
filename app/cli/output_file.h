// Asking early whether a result can be kept.
#pragma once

#include <string>
#include <vector>

#include "renderer/core/error.h"

namespace brume {

/// Whether write_file_atomically() could write `path` now; leaves no trace. An hour of rendering must not end with
/// "no such folder".
Result<void> check_writable(const std::string& path);

/// The same, and that the extension is one of `extensions` (".exr"), in any case.
Result<void> check_output(const std::string& path, const std::vector<std::string>& extensions);

}  // namespace brume
