// Scene files: a description as JSON, with the version of the format.
#pragma once

#include <string>
#include <string_view>

#include "renderer/params/node.h"

namespace brume {

/// Reads a scene: an object with "brume": 1 and the keys of the root family. See read_node() for the rules.
/// @param file_name  only names the source in errors.
/// @param base_dir   what relative paths of files start from; empty is the current directory.
/// @return an error with line and column for what is not JSON, not a scene, of a newer format, or wrong inside.
Result<Node> read_scene_text(std::string_view text, const std::string& file_name, const std::string& base_dir,
                             const Family& root);

/// Reads a scene file; relative paths in it start from its folder. Errors also when the file is missing, a folder,
/// unreadable, empty, no text, or larger than 16 MB.
Result<Node> read_scene_file(const std::string& path, const Family& root);

/// The scene as text meant for the folder `target_dir`; only what differs from the defaults. See node_to_json().
/// Errors when a text in it is not UTF-8 (a file name can be), since that could not be read back.
Result<std::string> write_scene_text(const Node& node, const std::string& target_dir);

/// Writes a scene file: it appears complete or not at all. Errors as write_scene_text(), and when the file cannot be
/// written.
Result<void> write_scene_file(const std::string& path, const Node& node);

}  // namespace brume
