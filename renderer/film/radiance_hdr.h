// Pictures in the Radiance format.
#pragma once

#include <string>

#include "renderer/core/error.h"
#include "renderer/film/image.h"

namespace brume {

/// An .hdr or .pic file: RGBE, flat or run-length coded, rows from top to bottom (the "-Y height +X width" that nearly
/// all have). Ward 1991, "Real Pixels", Graphics Gems II. Ours, because stb_image waits for ever on a file that was cut
/// off. Errors name the file: none there, another format, too large, truncated or damaged.
Result<Image> read_hdr(const std::string& path);

}  // namespace brume
