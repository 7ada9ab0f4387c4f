#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <bit>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "renderer/film/image_io.h"

namespace brume {
namespace {

namespace fs = std::filesystem;

class ExrIo : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "brume_exr_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  fs::path folder_;
};

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void put(const std::string& path, const std::string& bytes) {
  fs::remove(path);  // ext4 waits for the disk when a file is cut to nothing and written again
  std::ofstream(path, std::ios::binary) << bytes;
}

Image random_image(int width, int height) {
  std::mt19937 random(5);
  std::lognormal_distribution<float> value(0, 3);
  Image image(width, height);
  for (Color& pixel : image.pixels) pixel = {value(random), value(random), -value(random)};
  return image;
}

bool same_bits(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Color)) == 0;
}

template <class T> std::string raw(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};  // OpenEXR is little-endian, and so are our machines
}

/// An uncompressed OpenEXR file made byte by byte from the format's description (openexr.com, "OpenEXR File Layout"),
/// so that the reader is not only tested against our writer.
struct HandMadeExr {
  struct Channel {
    std::int32_t type = 2;  // 0 whole number, 1 half, 2 float
    std::int32_t sampling = 1;
    std::vector<float> values = {};  // [height][width]
  };
  std::int32_t x_min = 0, y_min = 0, width = 1, height = 1;
  std::map<std::string, Channel> channels = {};  // the format wants them by alphabet

  static std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + raw(static_cast<std::int32_t>(value.size())) + value;
  }
  static std::string box(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
    return raw(x0) + raw(y0) + raw(x1) + raw(y1);
  }
  /// Enough for the values of these tests: zero and normal numbers that a half holds exactly.
  static std::uint16_t half(float value) {
    if (value == 0) return 0;
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return static_cast<std::uint16_t>((bits >> 16 & 0x8000) | (((bits >> 23 & 0xff) - 112) << 10) |
                                      (bits >> 13 & 0x3ff));
  }

  std::string bytes() const {
    std::string channel_list;
    for (const auto& [name, channel] : channels)
      channel_list +=
          name + '\0' + raw(channel.type) + raw(std::int32_t{0}) + raw(channel.sampling) + raw(channel.sampling);
    std::string file = raw(std::int32_t{20000630}) + raw(std::int32_t{2});
    file += attribute("channels", "chlist", channel_list + '\0');
    file += attribute("compression", "compression", std::string(1, '\0'));
    file += attribute("dataWindow", "box2i", box(x_min, y_min, x_min + width - 1, y_min + height - 1));
    file += attribute("displayWindow", "box2i", box(0, 0, 99, 99));
    file += attribute("lineOrder", "lineOrder", std::string(1, '\0'));
    file += attribute("pixelAspectRatio", "float", raw(1.0f));
    file += attribute("screenWindowCenter", "v2f", raw(0.0f) + raw(0.0f));
    file += attribute("screenWindowWidth", "float", raw(1.0f));
    file += '\0';

    std::vector<std::string> lines;
    for (std::int32_t y = 0; y < height; ++y) {
      std::string data;
      for (const auto& [name, channel] : channels)
        for (std::int32_t x = 0; x < width; ++x) {
          const float value = channel.values[static_cast<std::size_t>(y * width + x)];
          if (channel.type == 1)
            data += raw(half(value));
          else if (channel.type == 2)
            data += raw(value);
          else
            data += raw(static_cast<std::uint32_t>(value));
        }
      lines.push_back(raw(y_min + y) + raw(static_cast<std::int32_t>(data.size())) + data);
    }
    std::uint64_t offset = file.size() + 8 * lines.size();
    for (const std::string& line : lines) {
      file += raw(offset);
      offset += line.size();
    }
    for (const std::string& line : lines) file += line;
    return file;
  }
};

HandMadeExr hand_made(const std::vector<std::string>& names, std::int32_t type = 2) {
  HandMadeExr exr;
  for (const std::string& name : names) exr.channels[name] = {type, 1, {1}};
  return exr;
}

TEST_F(ExrIo, RoundTripKeepsEveryBit) {
  Image image = random_image(37, 41);  // more than one ZIP block of 16 lines, the last one shorter
  using Limits = std::numeric_limits<float>;
  image.at(0, 0) = {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()};
  image.at(36, 40) = {Limits::denorm_min(), -0.0f, Limits::max()};
  ASSERT_TRUE(write_exr(path("a.exr"), image));
  const Result<ImageFile> read = read_exr(path("a.exr"));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_TRUE(same_bits(read->image, image));
  EXPECT_EQ(read->metadata, ImageMetadata());
}

TEST_F(ExrIo, RoundTripKeepsMetadata) {
  ImageMetadata metadata;
  metadata.scene_json = "{\n  \"name\": \"Wölkchen 雲\", \"pad\": \"" + std::string(100000, 'x') + "\"}\n";
  metadata.extra = {
      {"samples", "64"}, {"empty", ""}, {"a.key/with-signs", " spaces  kept "}, {std::string(64, 'k'), "x"}};
  ASSERT_TRUE(write_exr(path("a.exr"), Image(2, 1), metadata));
  const Result<ImageFile> read = read_exr(path("a.exr"));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->metadata, metadata);
}

TEST_F(ExrIo, FileSaysZipFloatAndTheChromaticitiesOfRec709) {
  ASSERT_TRUE(write_exr(path("a.exr"), random_image(4, 3), {"{}", {}}));
  const std::string bytes = content(path("a.exr"));
  const auto contains = [&](const std::string& part) { return bytes.find(part) != std::string::npos; };
  std::string rec709;  // ITU-R BT.709-6: red, green, blue, white as x, y
  for (const float value : {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f}) rec709 += raw(value);
  EXPECT_TRUE(contains(HandMadeExr::attribute("chromaticities", "chromaticities", rec709)));
  EXPECT_TRUE(contains(HandMadeExr::attribute("compression", "compression", "\x03")));
  EXPECT_TRUE(contains(HandMadeExr::attribute("brume:scene", "string", "{}")));
  for (const char* name : {"B", "G", "R"})
    EXPECT_TRUE(contains(std::string(name) + '\0' + raw(2) + raw(0) + raw(1) + raw(1))) << name;
}

TEST_F(ExrIo, ReadsFilesOfOthers) {
  HandMadeExr exr;
  exr.width = 2, exr.height = 2;
  exr.channels["R"].values = {1, 2, 3, 4};
  exr.channels["G"] = {1, 1, {0.5f, -0.25f, 0, 1024}};  // halves beside floats
  exr.channels["B"].values = {9, 8, 7, 6};
  exr.channels["A"].values = {1, 1, 1, 1};
  exr.channels["Y"].values = {5, 5, 5, 5};
  exr.channels["id"] = {0, 1, {1, 2, 3, 4}};
  put(path("a.exr"), exr.bytes());
  const Result<ImageFile> read = read_exr(path("a.exr"));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->image.width, 2);
  EXPECT_EQ(read->image.pixels, (std::vector<Color>{{1, 0.5f, 9}, {2, -0.25f, 8}, {3, 0, 7}, {4, 1024, 6}}));
}

TEST_F(ExrIo, LuminanceAloneIsGrey) {
  for (const std::int32_t type : {1, 2}) {
    HandMadeExr exr;
    exr.width = 2;
    exr.channels["Y"] = {type, 1, {0.5f, 2}};
    put(path("y.exr"), exr.bytes());
    const Result<ImageFile> read = read_exr(path("y.exr"));
    ASSERT_TRUE(read) << read.error().to_string();
    EXPECT_EQ(read->image.pixels, (std::vector<Color>{Color(0.5f), Color(2)}));
  }
}

TEST_F(ExrIo, ImageIsTheDataWindow) {
  for (const std::int32_t origin : {-1000, -5, 7, 1000000}) {
    HandMadeExr exr;
    exr.x_min = origin, exr.y_min = -origin;
    exr.width = 3, exr.height = 2;
    for (const char* name : {"R", "G", "B"}) exr.channels[name].values = {1, 2, 3, 4, 5, 6};
    put(path("window.exr"), exr.bytes());
    const Result<ImageFile> read = read_exr(path("window.exr"));
    ASSERT_TRUE(read) << read.error().to_string();
    EXPECT_EQ(read->image.width, 3);
    EXPECT_EQ(read->image.height, 2);
    EXPECT_EQ(read->image.at(0, 0), Color(1));
    EXPECT_EQ(read->image.at(2, 1), Color(6));
  }
}

TEST_F(ExrIo, WrongChannelsAreNamed) {
  const auto error_of = [&](const HandMadeExr& exr) {
    put(path("a.exr"), exr.bytes());
    const Result<ImageFile> read = read_exr(path("a.exr"));
    return read ? "none" : read.error().message;
  };
  EXPECT_EQ(error_of(hand_made({"R", "G"})), "found the channels G, R, expected R, G, B or Y alone");
  EXPECT_EQ(error_of(hand_made({"Z"})), "found the channels Z, expected R, G, B or Y alone");
  EXPECT_EQ(error_of(hand_made({"Y", "RY", "BY"})), "found the channels BY, RY, Y, expected R, G, B or Y alone");
  EXPECT_EQ(error_of(hand_made({"R", "G", "B"}, 0)), "found whole numbers in channel R, expected 16- or 32-bit floats");
  HandMadeExr sparse = hand_made({"Y"});
  sparse.channels["Y"].sampling = 2;
  sparse.width = sparse.height = 2;
  sparse.channels["Y"].values = {1, 1, 1, 1};
  EXPECT_EQ(error_of(sparse), "found fewer samples than pixels in channel Y, expected one per pixel");
}

TEST_F(ExrIo, HugeExtentsAreRefusedBeforeTheyAreAllocated) {
  HandMadeExr exr = hand_made({"R", "G", "B"});
  exr.width = 50000, exr.height = 0;  // no lines are written, but the header may claim some
  std::string bytes = exr.bytes();
  const std::string window = HandMadeExr::box(0, 0, 49999, -1);
  bytes.replace(bytes.find(window), window.size(), HandMadeExr::box(0, 0, 49999, 49999));
  put(path("huge.exr"), bytes + std::string(8 * 50000, '\0'));
  const Result<ImageFile> read = read_exr(path("huge.exr"));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "found 50000 x 50000 pixels, expected 1 to 67108864 in total");
}

TEST_F(ExrIo, MorePixelsThanTheFileCanHoldAreRefused) {
  ASSERT_TRUE(write_exr(path("a.exr"), Image(8, 8)));
  std::string bytes = content(path("a.exr"));
  const std::string window = "box2i" + std::string(1, '\0') + raw(std::int32_t{16}) + HandMadeExr::box(0, 0, 7, 7);
  bytes.replace(bytes.find(window) + window.size() - 8, 4, raw(std::int32_t{3000000 - 1}));
  put(path("wide.exr"), bytes);
  const Result<ImageFile> read = read_exr(path("wide.exr"));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "this OpenEXR file is damaged: found 3000000 x 8 pixels, more than it can hold");
}

TEST_F(ExrIo, BlackPicturesShrinkAsMuchAsTheyMay) {
  const Image black(2000, 1500);
  ASSERT_TRUE(write_exr(path("black.exr"), black));
  const Result<ImageFile> read = read_exr(path("black.exr"));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->image, black);
}

TEST_F(ExrIo, AttributeLongerThanTheFileIsAnErrorAtOnce) {
  ASSERT_TRUE(write_exr(path("a.exr"), Image(1, 1), {"{}", {}}));
  std::string bytes = content(path("a.exr"));
  const std::string before = std::string("brume:scene") + '\0' + "string" + '\0';
  const std::size_t length = bytes.find(before) + before.size();
  for (const std::uint32_t claimed : {0x3d000000u, 0x7fffffffu, 0xffffffffu}) {
    bytes.replace(length, 4, raw(claimed));
    put(path("long.exr"), bytes);
    const Result<ImageFile> read = read_exr(path("long.exr"));
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().message, "this OpenEXR file is damaged or truncated: its header goes on beyond its end");
  }
}

TEST_F(ExrIo, ErrorsNameTheFileAndTheReason) {
  const auto error_of = [&](const std::string& name) { return read_exr(path(name)).error().to_string(); };
  EXPECT_EQ(error_of("missing.exr"), path("missing.exr") + ": there is no such file");
  EXPECT_EQ(error_of(""), path("") + ": found a folder, expected a file");
  put(path("empty.exr"), "");
  EXPECT_EQ(error_of("empty.exr"), path("empty.exr") + ": found another kind of file, expected an OpenEXR image");
  put(path("text.exr"), "{\"scene\": 1}");
  EXPECT_EQ(error_of("text.exr"), path("text.exr") + ": found another kind of file, expected an OpenEXR image");
  EXPECT_FALSE(read_exr(path("text.exr/inside.exr")));
  EXPECT_FALSE(read_exr(""));
}

TEST_F(ExrIo, FileCutAtAnyLengthIsAnError) {
  ASSERT_TRUE(write_exr(path("a.exr"), random_image(9, 35), {"{\"a\": 1}", {{"samples", "1"}}}));
  const std::string bytes = content(path("a.exr"));
  ASSERT_GT(bytes.size(), 1000u);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    put(path("cut.exr"), bytes.substr(0, length));
    const Result<ImageFile> read = read_exr(path("cut.exr"));
    ASSERT_FALSE(read) << length << " of " << bytes.size();
    ASSERT_EQ(read.error().source.file, path("cut.exr"));
    ASSERT_LT(read.error().message.size(), 400u);
  }
}

TEST_F(ExrIo, DamagedFileIsAnErrorOrAWholeImage) {
  ASSERT_TRUE(write_exr(path("a.exr"), random_image(5, 20), {"{}", {}}));
  const std::string bytes = content(path("a.exr"));
  std::mt19937 random(11);
  int errors = 0;
  for (std::size_t position = 0; position < bytes.size(); ++position) {
    std::string damaged = bytes;
    damaged[position] = static_cast<char>(damaged[position] ^ (1 + random() % 255));
    put(path("damaged.exr"), damaged);
    const Result<ImageFile> read = read_exr(path("damaged.exr"));
    if (read) {
      ASSERT_TRUE(is_consistent(read->image)) << position;
      ASSERT_FALSE(read->image.empty()) << position;
    } else {
      ++errors;
    }
  }
  EXPECT_GT(errors, 100);  // much of the header matters; pixels have no checksum
}

TEST_F(ExrIo, PathMayBeNonAscii) {
  const std::string name = "Nebel über Zürich 雲.exr";
  const Image image = random_image(2, 2);
  ASSERT_TRUE(write_exr(path(name), image));
  EXPECT_TRUE(fs::exists(path(name)));
  const Result<ImageFile> read = read_exr(path(name));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->image, image);
}

TEST_F(ExrIo, FailedWriteLeavesTheOldFileAndNothingElse) {
  ASSERT_TRUE(write_exr(path("a.exr"), random_image(2, 2)));
  const std::string old = content(path("a.exr"));

  rlimit unlimited{};
  getrlimit(RLIMIT_FSIZE, &unlimited);
  rlimit tight = unlimited;
  tight.rlim_cur = 2000;  // stands for a full disk
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &tight);
  const Result<void> full = write_exr(path("a.exr"), random_image(100, 100));
  setrlimit(RLIMIT_FSIZE, &unlimited);
  std::signal(SIGXFSZ, old_handler);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().to_string(), path("a.exr") + ": cannot write this file: File too large");

  EXPECT_FALSE(write_exr(path("a.exr"), Image()));
  Image inconsistent(2, 2);
  inconsistent.pixels.pop_back();
  EXPECT_FALSE(write_exr(path("a.exr"), inconsistent));
  for (const std::string& key : {std::string("two words"), std::string("scene"), std::string(), std::string(65, 'k')})
    EXPECT_FALSE(write_exr(path("a.exr"), Image(1, 1), {"", {{key, "value"}}})) << key;
  EXPECT_FALSE(write_exr(path("a.exr"), Image(1, 1), {std::string("a\0b", 3), {}}));
  EXPECT_FALSE(write_exr(path("missing/a.exr"), Image(1, 1)));

  EXPECT_EQ(content(path("a.exr")), old);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace brume
