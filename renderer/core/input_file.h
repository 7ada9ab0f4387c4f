// Files that somebody gave us: what can be said of them before they are read.
#pragma once

#include <string>

#include "renderer/core/error.h"

namespace brume {

/// An error with the file as its source.
Error file_error(const std::string& path, std::string message, ErrorCode code = ErrorCode::BadInput);

/// Why `path` cannot be opened for reading, or success when it is a readable ordinary file.
Result<void> check_readable(const std::string& path);

/// ".exr" of "Sky.EXR"; empty when there is none.
std::string lower_case_extension(const std::string& path);

/// The file's first bytes are `magic`.
bool begins_with(const std::string& path, const std::string& magic);

/// Third-party text, which may echo bytes of a hostile file, as part of a sentence: printable, no line breaks, at most
/// 200 bytes.
std::string quoted_reason(const std::string& text);

}  // namespace brume
