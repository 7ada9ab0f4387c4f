#include "renderer/scene_io/utf8.h"

#include <gtest/gtest.h>

namespace brume {
namespace {

TEST(Utf8, TakesCharactersOfEveryLength) {
  EXPECT_EQ(utf8_length("a", 0), 1u);
  EXPECT_EQ(utf8_length("\xC3\xA4", 0), 2u);
  EXPECT_EQ(utf8_length("\xE2\x82\xAC", 0), 3u);
  EXPECT_EQ(utf8_length("\xF0\x9F\x94\xA5", 0), 4u);
  EXPECT_EQ(utf8_length("\xF4\x8F\xBF\xBF", 0), 4u);  // U+10FFFF
  EXPECT_EQ(utf8_length("\xED\x9F\xBF", 0), 3u);      // U+D7FF
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(is_utf8("h\xC3\xB6he \xF0\x9F\x94\xA5"));
}

TEST(Utf8, RefusesIllFormedBytes) {
  EXPECT_EQ(utf8_length("", 0), 0u);
  EXPECT_EQ(utf8_length("\x80", 0), 0u);              // continuation alone
  EXPECT_EQ(utf8_length("\xC0\x80", 0), 0u);          // overlong
  EXPECT_EQ(utf8_length("\xE0\x80\x80", 0), 0u);      // overlong
  EXPECT_EQ(utf8_length("\xF0\x80\x80\x80", 0), 0u);  // overlong
  EXPECT_EQ(utf8_length("\xED\xA0\x80", 0), 0u);      // surrogate
  EXPECT_EQ(utf8_length("\xF4\x90\x80\x80", 0), 0u);  // above U+10FFFF
  EXPECT_EQ(utf8_length("\xFF", 0), 0u);
  EXPECT_EQ(utf8_length("\xE2\x82", 0), 0u);  // cut
  EXPECT_EQ(utf8_length("\xE2\x82x", 0), 0u);
  EXPECT_FALSE(is_utf8("a\xE4"));
}

}  // namespace
}  // namespace brume
