// The parameters of what is selected.
#pragma once

#include "app/panels/edit_target.h"

namespace brume {

/// Draws every parameter of the object and of the objects inside it, from their tables; edits go to the target.
/// @return the object whose file the user wants to choose, if any
std::optional<NodePath> draw_inspector(const EditTarget& target, const NodePath& selected);

}  // namespace brume
