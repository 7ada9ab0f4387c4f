#include "renderer/scene_io/scene_file.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "renderer/core/atomic_file.h"
#include "renderer/scene_io/file_paths.h"
#include "renderer/scene_io/json_print.h"
#include "renderer/scene_io/read_node.h"
#include "renderer/scene_io/scene_format.h"
#include "renderer/scene_io/utf8.h"
#include "renderer/scene_io/write_node.h"

namespace brume {
namespace {

namespace fs = std::filesystem;

std::string expected_format() {
  return std::string("expected \"") + kSceneFormatKey + "\": " + std::to_string(kSceneFormat);
}

/// Takes the version out of the object, so that what is left has only the keys of the root family.
Result<void> take_format(JsonValue& json, const std::string& file) {
  const auto wrong = [&](const JsonValue& where, std::string key, std::string message) {
    return bad_input(std::move(message), {file, where.line, where.column, std::move(key)});
  };
  if (json.kind != JsonValue::Kind::Object)
    return wrong(json, "",
                 "this is not a Brume scene: found " + describe(json) + ", expected an object with \"" +
                     kSceneFormatKey + "\": " + std::to_string(kSceneFormat));
  const JsonMember* format = json.find(kSceneFormatKey);
  if (!format) return wrong(json, "", "this is not a Brume scene: " + expected_format());
  const JsonValue& version = format->value;
  if (version.kind != JsonValue::Kind::Number || !version.integer || *version.integer < 1)
    return wrong(version, kSceneFormatKey, "found " + describe(version) + ", " + expected_format());
  if (*version.integer > kSceneFormat)
    return wrong(version, kSceneFormatKey,
                 "made by a newer Brume (format " + std::to_string(*version.integer) + ", this one reads " +
                     std::to_string(kSceneFormat) + ")");
  json.members.erase(json.members.begin() + (format - json.members.data()));
  return {};
}

Error cannot_read(const std::string& path, const std::string& reason) { return bad_input(reason, {path, 0, 0, ""}); }

/// The whole file, if it can be a text.
Result<std::string> read_text(const std::string& path) {
  constexpr std::size_t kLargest = 16u << 20;  // a scene names its large data; a megabyte of JSON is already unusual
  std::error_code error;
  if (path.empty()) return bad_input("found an empty file name, expected the path of a scene");
  if (path.find('\0') != std::string::npos) return bad_input("found a zero byte in a file name, expected a path");
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return cannot_read(path, "this file does not exist");
  if (fs::is_directory(status)) return cannot_read(path, "this is a folder, expected a scene file");

  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) return cannot_read(path, "cannot read this file: " + std::generic_category().message(errno ? errno : EIO));
  std::string text;
  char block[1 << 16];
  while (in.read(block, sizeof block), in.gcount() > 0) {
    text.append(block, static_cast<std::size_t>(in.gcount()));
    // OpenVDB files begin with these bytes; people drop them where a scene is asked for.
    if (text.starts_with(std::string_view(" BDV\0\0\0\0", 8)))
      return cannot_read(path, "this is an OpenVDB file, expected a scene, which names such a file in a volume");
    if (text.size() > kLargest) return cannot_read(path, "this file is larger than 16 MB, too large for a scene");
  }
  if (in.bad())
    return cannot_read(path,
                       "cannot read this file to its end: " + std::generic_category().message(errno ? errno : EIO));
  if (text.empty()) return cannot_read(path, "this file is empty, expected a scene");
  const bool utf16 = text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");  // has its own message
  if (!utf16 && text.find('\0') != std::string::npos)
    return cannot_read(path, "this is not a text file, expected a scene");
  return text;
}

/// A family for the root alone: it has one kind, and the file does not name it.
Family family_of(const Node& root) { return {"scene", "", {&root.table()}}; }

std::string folder_of(const std::string& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  return error ? std::string() : absolute.parent_path().lexically_normal().string();
}

Result<void> check_utf8(const Node& node, const std::string& path) {
  const auto below = [&](const std::string& key) { return path.empty() ? key : path + "." + key; };
  for (const Param& p : node.table().params) {
    const std::string text = format_value(node.value(p.key));
    if (!is_utf8(text))
      return bad_input(
          "found " + quote_for_message(text) + ", which is not UTF-8 and cannot be kept in a scene file; rename it",
          {"", 0, 0, below(p.key)});
  }
  for (const Slot& s : node.table().slots) {
    if (!s.list) {
      if (auto done = check_utf8(node.child(s.key), below(s.key)); !done) return done;
      continue;
    }
    const auto list = node.list(s.key);
    for (std::size_t i = 0; i < list.size(); ++i)
      if (auto done = check_utf8(list[i], below(s.key) + "[" + std::to_string(i) + "]"); !done) return done;
  }
  return {};
}

}  // namespace

Result<Node> read_scene_text(std::string_view text, const std::string& file_name, const std::string& base_dir,
                             const Family& root) {
  auto json = parse_json(text, file_name);
  if (!json) return json.error();
  if (auto done = take_format(*json, file_name); !done) return done.error();
  auto node = read_node(*json, root, {file_name, base_dir});
  if (node) make_settings_absolute(*node, base_dir);
  return node;
}

Result<Node> read_scene_file(const std::string& path, const Family& root) {
  const auto text = read_text(path);
  if (!text) return text.error();
  return read_scene_text(*text, path, folder_of(path), root);
}

Result<std::string> write_scene_text(const Node& node, const std::string& target_dir) {
  if (auto done = check_utf8(node, ""); !done) return done.error();
  JsonValue json = JsonValue::object();
  json.add(kSceneFormatKey, kSceneFormat);
  Node portable = node;
  make_settings_relative(portable, target_dir);
  JsonValue content = node_to_json(portable, family_of(portable), {target_dir});
  for (JsonMember& m : content.members) json.members.push_back(std::move(m));
  return format_json(json, true) + "\n";
}

Result<void> write_scene_file(const std::string& path, const Node& node) {
  const auto text = write_scene_text(node, folder_of(path));
  if (!text) {
    Error error = text.error();
    error.source.file = path;
    return error;
  }
  return write_text_atomically(path, *text);
}

}  // namespace brume
