// Plain words when there is nothing to see.
#pragma once

#include <optional>

#include "renderer/engine/engine.h"

namespace brume {

/// One sentence that says why the picture is black and what to do; nothing when it is not.
std::optional<std::string> explain_black(const Scene& scene, const Picture& picture);

}  // namespace brume
