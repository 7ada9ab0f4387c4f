// The parameters of what is selected.
#pragma once

#include "app/panels/node_path.h"
#include "app/session/session.h"

namespace brume {

/// Draws every parameter of the object and of the objects inside it, from their tables; edits go to the session.
/// @return the object whose file the user wants to choose, if any
std::optional<NodePath> draw_inspector(Session& session, const NodePath& selected);

}  // namespace brume
