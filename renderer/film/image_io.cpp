#include "renderer/film/image_io.h"

#include <algorithm>

#include "renderer/core/input_file.h"

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

}  // namespace brume::detail
