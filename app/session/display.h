// Display settings of a film.
#pragma once

#include "renderer/film/display_transform.h"
#include "renderer/params/node.h"

namespace brume {

/// @param film  of film_family()
DisplaySettings display_settings(const Node& film);

}  // namespace brume
