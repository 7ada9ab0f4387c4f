#include "renderer/film/radiance_hdr.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <vector>

#include "renderer/core/input_file.h"
#include "renderer/film/image_io.h"

namespace brume {
namespace {

using Bytes = std::vector<unsigned char>;

/// The bytes of a file, taken from the front. Reading past the end sets `failed` and gives zeros.
struct Reader {
  std::ifstream file;
  bool failed = false;

  unsigned char byte() {
    const int c = file.get();
    failed |= c == std::ifstream::traits_type::eof();
    return failed ? static_cast<unsigned char>(0) : static_cast<unsigned char>(c);
  }
};

/// One run-length coded component of a row.
bool read_component(Reader& in, unsigned char* out, int width) {
  for (int x = 0; x < width;) {
    int count = in.byte();
    const bool run = count > 128;
    if (run) count -= 128;
    if (in.failed || count == 0 || count > width - x) return false;
    if (run) {
      const unsigned char value = in.byte();
      for (int k = 0; k < count; ++k) out[4 * x++] = value;
    } else {
      for (int k = 0; k < count; ++k) out[4 * x++] = in.byte();
    }
  }
  return !in.failed;
}

/// Four bytes per pixel: red, green, blue, exponent.
bool read_row(Reader& in, Bytes& row, int width) {
  for (int k = 0; k < 4; ++k) row[static_cast<std::size_t>(k)] = in.byte();
  const bool coded = width >= 8 && width < 32768 && row[0] == 2 && row[1] == 2 && row[2] * 256 + row[3] == width;
  if (coded) {
    for (int c = 0; c < 4; ++c)
      if (!read_component(in, row.data() + c, width)) return false;
    return true;
  }
  for (std::size_t k = 4; k < row.size(); ++k) row[k] = in.byte();
  return !in.failed;
}

Color to_radiance(const unsigned char* rgbe) {
  if (rgbe[3] == 0) return {};
  const float scale = std::ldexp(1.0f, rgbe[3] - (128 + 8));
  return {static_cast<float>(rgbe[0]) * scale, static_cast<float>(rgbe[1]) * scale,
          static_cast<float>(rgbe[2]) * scale};
}

}  // namespace

Result<Image> read_hdr(const std::string& path) {
  if (auto done = check_readable(path); !done) return done.error();
  Reader in{std::ifstream(path, std::ios::binary)};
  std::string line;
  std::getline(in.file, line);
  if (!line.starts_with("#?")) return file_error(path, "found no Radiance picture, expected an .hdr file");
  // Lines of the header up to an empty one, then the resolution.
  for (int lines = 0; !line.empty() && in.file && lines < 1000; ++lines) std::getline(in.file, line);
  std::getline(in.file, line);
  int width = 0, height = 0;
  if (std::sscanf(line.c_str(), "-Y %d +X %d", &height, &width) != 2 || width < 1 || height < 1)
    return file_error(path, "found the resolution \"" + quoted_reason(line) + "\", expected \"-Y height +X width\"");
  if (static_cast<std::int64_t>(width) * height > kMaxImagePixels)
    return file_error(path, "found " + std::to_string(width) + "x" + std::to_string(height) +
                                " pixels, expected at most " + std::to_string(kMaxImagePixels) + " in all");
  Image picture(width, height);
  Bytes row(4 * static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    if (!read_row(in, row, width))
      return file_error(
          path, "this file is cut off or damaged in row " + std::to_string(y) + " of " + std::to_string(height));
    for (int x = 0; x < width; ++x) picture.at(x, y) = to_radiance(&row[4 * static_cast<std::size_t>(x)]);
  }
  return picture;
}

}  // namespace brume
