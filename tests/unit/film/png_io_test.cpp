#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "renderer/film/image_io.h"

namespace brume {
namespace {

namespace fs = std::filesystem;

class PngIo : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "brume_png_XXXXXX";
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

Image8 random_image(int width, int height, int channels) {
  std::mt19937 random(5);
  Image8 image(width, height, channels);
  for (std::uint8_t& byte : image.bytes) byte = static_cast<std::uint8_t>(random());
  return image;
}

/// Bytes from numbers, for small literals.
std::string bytes_of(const std::vector<int>& values) {
  std::string bytes;
  for (const int value : values) bytes += static_cast<char>(value);
  return bytes;
}

std::string big_endian(std::uint32_t value) {
  return bytes_of({static_cast<int>(value >> 24), static_cast<int>(value >> 16 & 255),
                   static_cast<int>(value >> 8 & 255), static_cast<int>(value & 255)});
}

/// PNG specification (ISO/IEC 15948), annex D, bit by bit.
std::uint32_t crc(const std::string& bytes) {
  std::uint32_t remainder = 0xffffffffu;
  for (const char c : bytes) {
    remainder ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder & 1) ? 0xedb88320u ^ (remainder >> 1) : remainder >> 1;
  }
  return ~remainder;
}

std::string chunk(const std::string& type, const std::string& data) {
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(crc(type + data));
}

/// A zlib stream of one stored block (RFC 1950, RFC 1951).
std::string stored(const std::string& data) {
  std::uint32_t a = 1, b = 0;
  for (const char c : data) a = (a + static_cast<std::uint8_t>(c)) % 65521, b = (b + a) % 65521;
  const int size = static_cast<int>(data.size());
  return bytes_of({0x78, 0x01, 1, size & 255, size >> 8, ~size & 255, ~size >> 8 & 255}) + data +
         big_endian(b << 16 | a);
}

const std::string kSignature = "\x89PNG\r\n\x1a\n";

/// A PNG made byte by byte, so that the reader is not only tested against our writer.
/// @param color_type  0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA.   @param rows  a filter byte before each row.
std::string hand_made(std::uint32_t width, std::uint32_t height, int depth, int color_type, const std::string& rows,
                      const std::string& more_chunks = "", int interlace = 0) {
  return kSignature +
         chunk("IHDR", big_endian(width) + big_endian(height) + bytes_of({depth, color_type, 0, 0, interlace})) +
         more_chunks + chunk("IDAT", stored(rows)) + chunk("IEND", "");
}

/// The chunk types of a file, in order.
std::vector<std::string> chunk_types(const std::string& bytes) {
  std::vector<std::string> types;
  for (std::size_t i = kSignature.size(); i + 12 <= bytes.size();) {
    std::size_t size = 0;
    for (std::size_t k = 0; k < 4; ++k) size = size << 8 | static_cast<std::uint8_t>(bytes[i + k]);
    types.push_back(bytes.substr(i + 4, 4));
    i += 12 + size;
  }
  return types;
}

TEST_F(PngIo, RoundTripKeepsEveryByte) {
  for (const int channels : {3, 4}) {
    const Image8 image = random_image(61, 33, channels);
    ASSERT_TRUE(write_png(path("a.png"), image));
    const Result<Image8File> read = read_png(path("a.png"));
    ASSERT_TRUE(read) << read.error().to_string();
    EXPECT_EQ(read->image, image);
    EXPECT_EQ(read->metadata, ImageMetadata());
  }
}

TEST_F(PngIo, RoundTripKeepsMetadata) {
  ImageMetadata metadata;
  metadata.scene_json = "{\n  \"name\": \"Wölkchen 雲\", \"pad\": \"" + std::string(100000, 'x') + "\"}\n";
  metadata.extra = {
      {"samples", "64"}, {"empty", ""}, {"a.key/with-signs", " spaces  kept "}, {std::string(64, 'k'), "x"}};
  ASSERT_TRUE(write_png(path("a.png"), random_image(2, 1, 3), metadata));
  const Result<Image8File> read = read_png(path("a.png"));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->metadata, metadata);
}

TEST_F(PngIo, LongSceneSurvives) {
  // Longer than libpng's own limit for a chunk (8 MB).
  std::string json(12'000'000, ' ');
  std::mt19937 random(2);
  for (char& c : json) c = static_cast<char>('a' + random() % 26);
  ASSERT_TRUE(write_png(path("a.png"), random_image(1, 1, 3), {json, {}}));
  const Result<Image8File> read = read_png(path("a.png"));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_TRUE(read->metadata.scene_json == json);
}

TEST_F(PngIo, FileSaysSrgbAndCarriesItsSceneAsInternationalText) {
  ASSERT_TRUE(write_png(path("a.png"), random_image(2, 2, 3), {"{}", {}}));
  const std::string bytes = content(path("a.png"));
  const std::vector<std::string> types = chunk_types(bytes);
  for (const char* type : {"sRGB", "gAMA", "cHRM", "iTXt"})
    EXPECT_EQ(std::count(types.begin(), types.end(), type), 1) << type;
  EXPECT_NE(bytes.find(chunk("sRGB", std::string(1, '\0'))), std::string::npos);         // intent 0, perceptual
  EXPECT_NE(bytes.find("iTXtbrume:scene" + std::string("\0\1", 2)), std::string::npos);  // 1: compressed
}

TEST_F(PngIo, ReadsFilesOfOthers) {
  const auto image_of = [&](const std::string& bytes) {
    put(path("a.png"), bytes);
    const Result<Image8File> read = read_png(path("a.png"));
    EXPECT_TRUE(read) << read.error().to_string();
    return read ? read->image : Image8();
  };
  const auto expected = [](int width, int height, int channels, const std::vector<std::uint8_t>& bytes) {
    Image8 image(width, height, channels);
    image.bytes = bytes;
    return image;
  };
  EXPECT_EQ(image_of(hand_made(2, 1, 8, 2, bytes_of({0, 1, 2, 3, 4, 5, 6}))), expected(2, 1, 3, {1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(image_of(hand_made(2, 1, 8, 0, bytes_of({0, 7, 200}))), expected(2, 1, 3, {7, 7, 7, 200, 200, 200}));
  EXPECT_EQ(image_of(hand_made(1, 1, 8, 4, bytes_of({0, 7, 100}))), expected(1, 1, 4, {7, 7, 7, 100}));
  EXPECT_EQ(image_of(hand_made(2, 1, 1, 0, bytes_of({0, 0x40}))), expected(2, 1, 3, {0, 0, 0, 255, 255, 255}));
  // 0x80ff * 255 / 65535 = 128.5 rounds to 128 or 129; cutting 16 bits to 8 would make 0xff80 the same as 0xff00.
  EXPECT_EQ(image_of(hand_made(2, 1, 16, 0, bytes_of({0, 0xff, 0xff, 0x12, 0x12}))),
            expected(2, 1, 3, {255, 255, 255, 18, 18, 18}));
  const std::string palette = chunk("PLTE", bytes_of({10, 20, 30, 40, 50, 60}));
  EXPECT_EQ(image_of(hand_made(2, 1, 8, 3, bytes_of({0, 1, 0}), palette)), expected(2, 1, 3, {40, 50, 60, 10, 20, 30}));
  EXPECT_EQ(image_of(hand_made(2, 1, 8, 3, bytes_of({0, 1, 0}), palette + chunk("tRNS", bytes_of({9})))),
            expected(2, 1, 4, {40, 50, 60, 255, 10, 20, 30, 9}));
  // Adam7 of 2x2: pass 1 brings (0, 0), pass 6 (1, 0), pass 7 the second row.
  EXPECT_EQ(image_of(hand_made(2, 2, 8, 0, bytes_of({0, 1, 0, 2, 0, 3, 4}), "", 1)),
            expected(2, 2, 3, {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4}));
}

TEST_F(PngIo, ReadsPlainTextChunksAndIgnoresThoseOfOthers) {
  const std::string text = chunk("tEXt", std::string("brume:scene\0{}", 14)) +
                           chunk("tEXt", std::string("Software\0paint", 14)) +
                           chunk("tEXt", std::string("brume:samples\0008", 15));
  put(path("a.png"), hand_made(1, 1, 8, 2, bytes_of({0, 1, 2, 3}), text));
  const Result<Image8File> read = read_png(path("a.png"));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->metadata, (ImageMetadata{"{}", {{"samples", "8"}}}));
}

TEST_F(PngIo, HugeExtentsAreRefusedBeforeTheyAreAllocated) {
  put(path("huge.png"), hand_made(50000, 50000, 8, 2, ""));
  const Result<Image8File> read = read_png(path("huge.png"));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "found 50000 x 50000 pixels, expected at most 67108864 in total");
  for (const std::uint32_t width : {0u, 0x7fffffffu, 0xffffffffu}) {
    put(path("huge.png"), hand_made(width, 1, 8, 2, ""));
    EXPECT_FALSE(read_png(path("huge.png"))) << width;
  }
}

TEST_F(PngIo, ChunkLongerThanTheFileIsAnErrorAtOnce) {
  ASSERT_TRUE(write_png(path("a.png"), random_image(3, 3, 3), {"{}", {}}));
  std::string bytes = content(path("a.png"));
  bytes.replace(bytes.find("iTXt") - 4, 4, bytes_of({0x78, 0, 0, 0x15}));
  put(path("long.png"), bytes);
  const Result<Image8File> read = read_png(path("long.png"));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "this PNG file is damaged or truncated: it ends too early");
}

TEST_F(PngIo, ErrorsNameTheFileAndTheReason) {
  const auto error_of = [&](const std::string& name) { return read_png(path(name)).error().to_string(); };
  EXPECT_EQ(error_of("missing.png"), path("missing.png") + ": there is no such file");
  EXPECT_EQ(error_of(""), path("") + ": found a folder, expected a file");
  put(path("empty.png"), "");
  EXPECT_EQ(error_of("empty.png"), path("empty.png") + ": found another kind of file, expected a PNG image");
  put(path("short.png"), kSignature);
  EXPECT_EQ(error_of("short.png"), path("short.png") + ": this PNG file is damaged or truncated: it ends too early");
}

TEST_F(PngIo, FileCutAtAnyLengthIsAnError) {
  ASSERT_TRUE(write_png(path("a.png"), random_image(17, 11, 4), {"{\"a\": 1}", {{"samples", "1"}}}));
  const std::string bytes = content(path("a.png"));
  ASSERT_GT(bytes.size(), 700u);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    put(path("cut.png"), bytes.substr(0, length));
    const Result<Image8File> read = read_png(path("cut.png"));
    ASSERT_FALSE(read) << length << " of " << bytes.size();
    ASSERT_EQ(read.error().source.file, path("cut.png"));
  }
}

TEST_F(PngIo, AnyDamagedByteIsAnError) {
  // Every byte stands under a checksum; a damaged scene must not turn into a picture without one.
  ASSERT_TRUE(write_png(path("a.png"), random_image(17, 11, 3), {"{\"a\": 1}", {}}));
  const std::string bytes = content(path("a.png"));
  std::mt19937 random(11);
  for (std::size_t position = 0; position < bytes.size(); ++position) {
    std::string damaged = bytes;
    damaged[position] = static_cast<char>(damaged[position] ^ (1 + random() % 255));
    put(path("damaged.png"), damaged);
    ASSERT_FALSE(read_png(path("damaged.png"))) << position;
  }
}

TEST_F(PngIo, DamageBehindAValidChecksumIsNoCrash) {
  // The checksum is made right again, so that damage reaches the decompressor and the filters.
  std::string rows;
  for (int y = 0; y < 20; ++y) rows += bytes_of({y % 5}) + std::string(30, static_cast<char>(y * 7));
  std::mt19937 random(13);
  int errors = 0, images = 0;
  for (int round = 0; round < 500; ++round) {
    std::string data = stored(rows);
    for (int i = 0; i < 3; ++i) data[random() % data.size()] = static_cast<char>(random());
    put(path("damaged.png"), kSignature + chunk("IHDR", big_endian(10) + big_endian(20) + bytes_of({8, 2, 0, 0, 0})) +
                                 chunk("IDAT", data) + chunk("IEND", ""));
    const Result<Image8File> read = read_png(path("damaged.png"));
    (read ? images : errors) += 1;
    ASSERT_TRUE(!read || read->image.bytes.size() == 600);
  }
  EXPECT_GT(errors, 100);
}

TEST_F(PngIo, PathMayBeNonAscii) {
  const std::string name = "Nebel über Zürich 雲.png";
  const Image8 image = random_image(2, 2, 3);
  ASSERT_TRUE(write_png(path(name), image));
  EXPECT_TRUE(fs::exists(path(name)));
  const Result<Image8File> read = read_png(path(name));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->image, image);
}

TEST_F(PngIo, FailedWriteLeavesTheOldFileAndNothingElse) {
  ASSERT_TRUE(write_png(path("a.png"), random_image(2, 2, 3)));
  const std::string old = content(path("a.png"));

  rlimit unlimited{};
  getrlimit(RLIMIT_FSIZE, &unlimited);
  rlimit tight = unlimited;
  tight.rlim_cur = 2000;  // stands for a full disk
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &tight);
  const Result<void> full = write_png(path("a.png"), random_image(100, 100, 3));
  setrlimit(RLIMIT_FSIZE, &unlimited);
  std::signal(SIGXFSZ, old_handler);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().to_string(), path("a.png") + ": cannot write this file: File too large");

  EXPECT_FALSE(write_png(path("a.png"), Image8()));
  Image8 inconsistent(2, 2, 3);
  inconsistent.bytes.pop_back();
  EXPECT_FALSE(write_png(path("a.png"), inconsistent));
  for (const std::string& key : {std::string("two words"), std::string("scene"), std::string(), std::string(65, 'k')})
    EXPECT_FALSE(write_png(path("a.png"), Image8(1, 1, 3), {"", {{key, "value"}}})) << key;
  EXPECT_FALSE(write_png(path("a.png"), Image8(1, 1, 3), {std::string("a\0b", 3), {}}));
  EXPECT_FALSE(write_png(path("missing/a.png"), Image8(1, 1, 3)));

  EXPECT_EQ(content(path("a.png")), old);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace brume
