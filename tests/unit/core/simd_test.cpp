#include "renderer/core/simd.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace brume {
namespace {

class Simd : public testing::Test {
 protected:
  ~Simd() override { EXPECT_TRUE(force_simd_level("auto").ok()); }
};

TEST_F(Simd, BestLevelIsInUseUnlessAnotherIsForced) {
  ASSERT_TRUE(force_simd_level("auto").ok());
  ASSERT_FALSE(simd_levels().empty());
  EXPECT_EQ(simd_level(), simd_levels().front());
}

TEST_F(Simd, EachLevelCanBeForcedAndTheListStaysWhole) {
  const auto all = simd_levels();
  for (const std::string& level : all) {
    ASSERT_TRUE(force_simd_level(level).ok());
    EXPECT_EQ(simd_level(), level);
    EXPECT_EQ(simd_levels(), all);
  }
}

TEST_F(Simd, NamesAreReadInAnyCaseAndByTheirUsualAliases) {
  const auto all = simd_levels();
  std::string upper = all.front();
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  EXPECT_TRUE(force_simd_level(upper).ok());
  EXPECT_TRUE(force_simd_level("sse2").ok());
  EXPECT_EQ(simd_level(), all.back());
  if (std::find(all.begin(), all.end(), "avx3") != all.end()) {
    EXPECT_TRUE(force_simd_level("avx512").ok());
    EXPECT_EQ(simd_level(), "avx3");
  }
}

TEST_F(Simd, UnknownLevelIsRefusedListsTheValidOnesAndChangesNothing) {
  ASSERT_TRUE(force_simd_level(simd_levels().back()).ok());
  const auto refused = force_simd_level("mmx");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(simd_level(), simd_levels().back());
  for (const std::string& level : simd_levels()) EXPECT_NE(refused.error().message.find(level), std::string::npos);
}

}  // namespace
}  // namespace brume
