// Pictures of the user interface compared with stored ones.
#pragma once

#include <gtest/gtest.h>

#include "renderer/film/image.h"

namespace brume {

/// Part of a picture, in pixels.
struct Region {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Compares with tests/ui/baselines/<name>.png. Inside `rendered` (the picture in the viewport) the mean FLIP error may
/// be 0.02, outside at most 0.1 % of the pixels may differ. On failure the picture, and a picture of the differences,
/// are kept beside the other test output. With BRUME_UPDATE_BASELINES=1 in the environment the stored picture is
/// rewritten instead.
testing::AssertionResult matches_baseline(const Image8& picture, const std::string& name, const Region& rendered);

}  // namespace brume
