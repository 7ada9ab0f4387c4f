// One line: what the picture has cost and how good it is.
#pragma once

#include "app/session/session.h"

namespace brume {

/// @param measured  false leaves out what differs between runs (times, rates), for pictures that tests compare
void draw_status_bar(const Session& session, bool measured);

}  // namespace brume
