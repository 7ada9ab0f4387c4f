// Files that appear complete or not at all.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "renderer/core/error.h"

namespace brume {

/// Calls `write` with the path of a new, empty file in the folder of `path`; when it succeeds, flushes that file to the
/// disk and renames it to `path`, which POSIX rename() does in one step: a reader sees the old content or the new one.
/// A file that was at `path` stays as it was until then, and keeps its permissions afterwards; a symbolic link is
/// followed, not replaced. The temporary file is removed on every failure, also when `write` throws.
/// @return an error with `path` as its source and the system's reason: missing folder, no permission, disk full, `path`
///         is a folder or a device; or the error that `write` returned, unchanged.
/// Threads: any; two writers of one path do not disturb each other, the later rename wins.
Result<void> write_file_atomically(const std::string& path,
                                   const std::function<Result<void>(const std::string& temporary_path)>& write);

/// The same with `text` (any bytes) as the content.
Result<void> write_text_atomically(const std::string& path, std::string_view text);

}  // namespace brume
