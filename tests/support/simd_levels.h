// Tests that run once for each instruction set of this machine.
#pragma once

#include <gtest/gtest.h>

#include "renderer/core/simd.h"

namespace brume {

/// To be instantiated with testing::ValuesIn(simd_levels()) and named by simd_level_name.
class AtSimdLevel : public testing::TestWithParam<std::string> {
 protected:
  AtSimdLevel() { EXPECT_TRUE(force_simd_level(GetParam()).ok()); }
  ~AtSimdLevel() override { EXPECT_TRUE(force_simd_level("auto").ok()); }
};

inline std::string simd_level_name(const testing::TestParamInfo<std::string>& level) { return level.param; }

}  // namespace brume
