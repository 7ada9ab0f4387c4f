// What the probed pixel is made of.
#pragma once

#include "app/panels/view_state.h"
#include "app/session/session.h"

namespace brume {

/// Figures of the pixel and a plot along its ray. Fills the rest of the current window.
/// @param measured  false leaves out the numbers
void draw_probe_panel(const Session& session, const ViewState& view, bool measured);

}  // namespace brume
