// Pictures of the surroundings, read from files.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "renderer/film/image_io.h"
#include "renderer/lights/environment_map.h"
#include "tests/unit/lights/environment_pictures.h"

namespace brume {
namespace {

namespace fs = std::filesystem;

class EnvironmentMapFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "brume_environment_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string put(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

  fs::path folder_;
};

/// A Radiance picture's head for -Y height +X width: rows from the top, columns from the left.
std::string hdr_head(int width, int height) {
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
}

std::string bytes(std::initializer_list<int> values) {
  std::string out;
  for (const int v : values) out += static_cast<char>(v);
  return out;
}

TEST_F(EnvironmentMapFile, ExrIsReadAsItWasWritten) {
  const Image picture = patchy(12, 6);
  ASSERT_TRUE(write_exr(path("sky.exr"), picture).ok());
  const auto map = EnvironmentMap::read(path("sky.exr"));
  ASSERT_TRUE(map.ok()) << map.error().to_string();
  EXPECT_EQ((*map)->width(), 12);
  EXPECT_EQ((*map)->height(), 6);
  const EnvironmentMap direct(picture);
  for (std::uint32_t i = 0; i < 200; ++i) {
    const auto s = direct.sample(random_pair(i));
    EXPECT_EQ((*map)->radiance(s.direction), direct.radiance(s.direction));
    EXPECT_EQ((*map)->pdf_w(s.direction), direct.pdf_w(s.direction));
  }
}

TEST_F(EnvironmentMapFile, HdrOfPlainPixelsIsRead) {
  // Shared exponent: mantissa * 2^(e - 136). The upper row first.
  const std::string file = put("sky.hdr", hdr_head(3, 2) + bytes({128, 64, 32, 129, 255, 0, 0, 136, 0, 0, 0, 0}) +
                                              bytes({128, 128, 128, 128, 1, 2, 3, 136, 200, 100, 50, 140}));
  const auto map = EnvironmentMap::read(file);
  ASSERT_TRUE(map.ok()) << map.error().to_string();
  EXPECT_EQ((*map)->width(), 3);
  EXPECT_EQ((*map)->height(), 2);
  EXPECT_EQ((*map)->mended(), 0u);
  const Color expected[2][3] = {{{1, 0.5f, 0.25f}, {255, 0, 0}, {0, 0, 0}},
                                {{0.5f, 0.5f, 0.5f}, {1, 2, 3}, {3200, 1600, 800}}};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) {
      const Color c = (*map)->radiance(seen_at((x + 0.5) / 3, (y + 0.5) / 2));
      // Places are rounded by 3e-7 of a pixel, between values of up to 3200.
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], expected[y][x][k], 5e-3f) << x << ", " << y;
    }
}

TEST_F(EnvironmentMapFile, HdrOfRunLengthsIsReadWhateverTheCaseOfItsName) {
  // New run lengths, from a width of 8 on: 2, 2, width, then each channel: 128 + n and the byte of n equal ones.
  const std::string row = bytes({2, 2, 0, 8, 128 + 8, 128, 128 + 8, 64, 4, 32, 32, 0, 0, 128 + 4, 0, 128 + 8, 130});
  const auto map = EnvironmentMap::read(put("SKY.HDR", hdr_head(8, 1) + row));
  ASSERT_TRUE(map.ok()) << map.error().to_string();
  EXPECT_EQ((*map)->width(), 8);
  const Color left = (*map)->radiance(seen_at(1.5 / 8, 0.5)), right = (*map)->radiance(seen_at(6.5 / 8, 0.5));
  EXPECT_NEAR(left.r, 2, 1e-5f);
  EXPECT_NEAR(left.g, 1, 1e-5f);
  EXPECT_NEAR(left.b, 0.5, 1e-5f);
  EXPECT_NEAR(right.r, 2, 1e-5f);
  EXPECT_NEAR(right.b, 0, 1e-5f);
}

TEST_F(EnvironmentMapFile, WhatIsNotAPictureIsRefusedByItsName) {
  fs::create_directory(path("folder.hdr"));
  for (const std::string& file :
       {path("missing.exr"), path("missing.hdr"), put("text.hdr", "Dear reader,\nthis is no picture.\n"),
        put("text.exr", "nor is this\n"), put("empty.hdr", ""), path("folder.hdr"),
        put("huge.hdr", hdr_head(100000, 100000)), put("sky.png", "\x89PNG"), put("sky", hdr_head(1, 1) + "abcd")}) {
    const auto map = EnvironmentMap::read(file);
    ASSERT_FALSE(map.ok()) << file;
    EXPECT_EQ(map.error().code, ErrorCode::BadInput) << file;
    EXPECT_EQ(map.error().source.file, file);
    EXPECT_FALSE(map.error().message.empty()) << file;
    EXPECT_EQ(map.error().message.find('\n'), std::string::npos) << "one sentence: " << map.error().message;
  }
  EXPECT_NE(EnvironmentMap::read(path("sky.png")).error().message.find(".png"), std::string::npos);
  EXPECT_NE(EnvironmentMap::read(path("text.hdr")).error().message.find("Radiance"), std::string::npos);
}

TEST_F(EnvironmentMapFile, ACutOffHdrIsRefused) {
  const std::string flat = hdr_head(3, 2) + bytes({128, 64, 32, 129, 255, 0, 0, 136, 0, 0, 0, 0, 9, 9, 9, 130});
  ASSERT_FALSE(EnvironmentMap::read(put("flat.hdr", flat)).ok()) << "two pixels are missing";
  // Here stb_image 2.27 takes the zeros that it reads beyond the end for empty runs and loops for ever.
  const std::string runs = hdr_head(8, 2) + bytes({2, 2, 0, 8, 128 + 8, 128, 128 + 8, 64, 128 + 8});
  EXPECT_FALSE(EnvironmentMap::read(put("runs.hdr", runs)).ok()) << "most of the picture is missing";
}

}  // namespace
}  // namespace brume
