#include "renderer/film/image_io.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

namespace brume::detail {
namespace {

const std::string kPrefix = "brume:";
const std::string kSceneKey = "scene";
constexpr std::size_t kMaxKeyLength = 64;  // a PNG keyword has at most 79 bytes, prefix included

bool is_valid_key(const std::string& key) {
  const auto printable = [](char c) { return c > ' ' && c <= '~'; };
  return !key.empty() && key.size() <= kMaxKeyLength && key != kSceneKey &&
         std::all_of(key.begin(), key.end(), printable);
}

}  // namespace

Error file_error(const std::string& path, std::string message, ErrorCode code) {
  ErrorSource source;
  source.file = path;
  return {code, std::move(message), std::move(source)};
}

Result<void> check_metadata(const std::string& path, const ImageMetadata& metadata) {
  for (const auto& [key, text] : metadata.extra)
    if (!is_valid_key(key))
      return file_error(path,
                        "found the metadata key \"" + quoted_reason(key) +
                            "\", expected 1 to 64 printable ASCII characters without blanks, other than \"scene\"");
  for (const auto& [name, text] : to_entries(metadata))
    if (text.find('\0') != std::string::npos)
      return file_error(path, "found a zero byte in the metadata \"" + name + "\", expected text");
  return {};
}

std::map<std::string, std::string> to_entries(const ImageMetadata& metadata) {
  std::map<std::string, std::string> entries;
  for (const auto& [key, text] : metadata.extra) entries[kPrefix + key] = text;
  if (!metadata.scene_json.empty()) entries[kPrefix + kSceneKey] = metadata.scene_json;
  return entries;
}

void add_entry(ImageMetadata& metadata, const std::string& name, const std::string& text) {
  if (name.compare(0, kPrefix.size(), kPrefix) != 0) return;
  const std::string key = name.substr(kPrefix.size());
  if (key == kSceneKey)
    metadata.scene_json = text;
  else if (is_valid_key(key))
    metadata.extra[key] = text;
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

}  // namespace brume::detail
