#include "app/cli/output_file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "renderer/core/atomic_file.h"
#include "renderer/core/input_file.h"
#include "renderer/params/param.h"

namespace brume {

Result<void> check_writable(const std::string& path) {
  // Goes as far as creating the temporary file, then gives up, so the conditions are the very same.
  const auto rehearsal = write_file_atomically(path, [](const std::string&) -> Result<void> {
    return Error{ErrorCode::Cancelled, "a rehearsal"};
  });
  if (!rehearsal && rehearsal.error().code != ErrorCode::Cancelled) return rehearsal;
  return {};
}

Result<void> check_output(const std::string& path, const std::vector<std::string>& extensions) {
  const std::string extension = lower_case_extension(path);
  if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
    return bad_input(
        (extension.empty() ? "found a name without extension" : "found the extension \"" + extension + "\"") +
            ", expected " + join(extensions, " or "),
        {path, 0, 0, path.empty() ? "--output" : ""});
  return check_writable(path);
}

}  // namespace brume
