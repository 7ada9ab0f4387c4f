// What every comparison of two pictures asks of them.
#pragma once

#include <optional>

#include "renderer/core/error.h"
#include "renderer/film/image.h"

namespace brume {

/// The error of a comparison of these pictures, none when they can be compared: no pixels, extents that differ or, of
/// radiance, a NaN or an infinity (the message names image and pixel).
std::optional<Error> not_comparable(const Image& test, const Image& reference);
std::optional<Error> not_comparable(const Image8& test, const Image8& reference);

}  // namespace brume
