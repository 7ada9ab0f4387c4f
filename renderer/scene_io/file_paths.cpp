#include "renderer/scene_io/file_paths.h"

#include <filesystem>
#include <functional>

namespace brume {
namespace {

namespace fs = std::filesystem;

using PathEdit = std::function<std::string(const std::string&)>;

/// @param tree  what settings belong to
void edit_settings(Node& node, const Node& tree, const PathEdit& edit) {
  for (const Param& p : node.table().params) {
    if (p.type != ParamType::SettingList) continue;
    Settings settings = node.settings(p.key);
    Node set = tree;  // one setting after the other: the first may make the object that has the next
    for (Setting& s : settings) {
      if (const auto found = find_param(set, s.path); found && found->param->type == ParamType::File)
        s.value = edit(s.value);
      static_cast<void>(set_by_path(set, s.path, s.value).ok());
    }
    static_cast<void>(node.set(p.key, std::move(settings)).ok());
  }
  for (const Slot& slot : node.table().slots) {
    if (!slot.list) {
      edit_settings(node.child(slot.key), tree, edit);
      continue;
    }
    for (Node& element : node.list(slot.key)) edit_settings(element, tree, edit);
  }
}

}  // namespace

std::string absolute_path(const std::string& path, const std::string& base_dir) {
  if (path.empty() || fs::path(path).is_absolute()) return path;
  std::error_code error;
  const fs::path joined = fs::absolute(fs::path(base_dir) / path, error);
  return error ? path : joined.lexically_normal().string();
}

std::string relative_path(const std::string& path, const std::string& target_dir) {
  const fs::path original(path);
  if (target_dir.empty() || !original.is_absolute()) return path;
  std::error_code error;
  const fs::path absolute = fs::absolute(target_dir, error);
  if (error) return path;
  const fs::path target = (absolute / "").lexically_normal();  // ends with a slash, whatever `target_dir` ends with

  const fs::path relative = original.lexically_relative(target);
  int up = 0;
  for (const fs::path& part : relative) up += part == "..";
  // A folder below the root has only the root in common with everything else: that is not near.
  int depth = 0;
  for (const fs::path& part : target.relative_path()) depth += !part.empty();
  const bool near = !relative.empty() && (up == 0 || (up <= 2 && up < depth));
  return near && (target / relative).lexically_normal().string() == path ? relative.string() : path;
}

void make_settings_absolute(Node& root, const std::string& base_dir) {
  const Node tree = root;
  edit_settings(root, tree, [&](const std::string& path) { return absolute_path(path, base_dir); });
}

void make_settings_relative(Node& root, const std::string& target_dir) {
  const Node tree = root;
  edit_settings(root, tree, [&](const std::string& path) { return relative_path(path, target_dir); });
}

}  // namespace brume
