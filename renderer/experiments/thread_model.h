// How a pass would scale to more threads than this machine has.
#pragma once

#include <vector>

#include "renderer/scene/scene.h"

namespace brume {

/// Seconds of every tile of one pass, in the order in which threads take them. On one thread.
std::vector<double> tile_seconds(const Scene& scene, int width, int height);

/// Seconds of a loop over `tasks` on that many threads that each take the next one when they are done with theirs.
double loop_seconds(const std::vector<double>& tasks, int threads);

}  // namespace brume
