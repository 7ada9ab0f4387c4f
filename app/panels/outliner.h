// What the scene holds: choose, add, remove, switch on and off.
#pragma once

#include "app/panels/node_path.h"
#include "app/session/session.h"

namespace brume {

void draw_outliner(Session& session, NodePath& selected);

}  // namespace brume
