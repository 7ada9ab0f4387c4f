// All that a description can hold, for those who document it.
#pragma once

#include <vector>

#include "renderer/params/node.h"

namespace brume {

/// The root and every family below it, each once, parents before children, in the order of their slots.
std::vector<const Family*> reachable_families(const Family& root);

}  // namespace brume
