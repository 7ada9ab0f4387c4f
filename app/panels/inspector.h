// The parameters of what is selected.
#pragma once

#include "app/panels/edit_target.h"

namespace brume {

/// A parameter of an object that names a file, which the user wants to choose.
struct FileWish {
  NodePath object;
  std::string key;
};

/// Draws every parameter of the object and of the objects inside it, from their tables; edits go to the target.
/// @return the file that the user wants to choose, if any
std::optional<FileWish> draw_inspector(EditTarget& target, const NodePath& selected);

}  // namespace brume
