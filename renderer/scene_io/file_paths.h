// Paths of files in scenes: absolute in memory, relative on disk.
#pragma once

#include <string>

#include "renderer/params/node.h"

namespace brume {

/// Lexically normal. An empty or absolute path stays as it is.  @param base_dir  empty is the current directory
std::string absolute_path(const std::string& path, const std::string& base_dir);

/// Relative to `target_dir` when that is short and certain to lead back; otherwise `path` unchanged.
std::string relative_path(const std::string& path, const std::string& target_dir);

/// The same for the files that settings name, which only the whole tree tells from other texts.
void make_settings_absolute(Node& root, const std::string& base_dir);
void make_settings_relative(Node& root, const std::string& target_dir);

}  // namespace brume
