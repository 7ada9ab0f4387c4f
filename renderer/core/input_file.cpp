#include "renderer/core/input_file.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace brume {

Error file_error(const std::string& path, std::string message, ErrorCode code) {
  ErrorSource source;
  source.file = path;
  return {code, std::move(message), std::move(source)};
}

Result<void> check_readable(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  // A missing file sets `error` as well; the file type tells it apart.
  if (status.type() == std::filesystem::file_type::not_found) return file_error(path, "there is no such file");
  if (error) return file_error(path, "cannot read this file: " + error.message());
  if (std::filesystem::is_directory(status)) return file_error(path, "found a folder, expected a file");
  // Opening a pipe could wait for ever.
  if (!std::filesystem::is_regular_file(status))
    return file_error(path, "found a device, pipe or socket, expected a file");
  errno = 0;
  if (!std::ifstream(path, std::ios::binary).is_open())
    return file_error(path, "cannot read this file: " + std::generic_category().message(errno));
  return {};
}

bool begins_with(const std::string& path, const std::string& magic) {
  std::string start(magic.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  return file.read(start.data(), static_cast<std::streamsize>(start.size())) && start == magic;
}

std::string quoted_reason(const std::string& text) {
  constexpr std::size_t kMaxLength = 200;
  std::string reason = text.substr(0, kMaxLength);
  for (char& c : reason)
    if (c < ' ' || c > '~') c = '?';
  while (!reason.empty() && (reason.back() == '.' || reason.back() == ' ')) reason.pop_back();
  return reason;
}

std::string lower_case_extension(const std::string& path) {
  std::string kind = std::filesystem::path(path).extension().string();
  for (char& c : kind) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return kind;
}

}  // namespace brume
