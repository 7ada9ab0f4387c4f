// Where the fonts are.
#pragma once

#include <string>
#include <vector>

namespace brume {

/// Files that came with Brume: beside the program, in ../share/brume of where it stands.
std::vector<std::string> ui_font_paths();

/// A file under share/brume beside the program's folder; empty when there is none.
std::string find_shared_file(const std::string& relative_path);

}  // namespace brume
