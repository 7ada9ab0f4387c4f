#include "tests/support/snapshot.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "renderer/analysis/flip.h"
#include "renderer/film/image_io.h"

namespace brume {
namespace {

// FLIP of two pictures a viewer cannot tell apart side by side is below this (Andersson et al. 2020 speak of 0.05 as
// hardly visible); rendered smoke differs by rounding between SIMD levels only, far below it.
constexpr double kMaxFlip = 0.02;
constexpr double kMaxDifferingShare = 0.001;

Image8 cropped(const Image8& image, const Region& r) {
  Image8 out(r.width, r.height, 3);
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) std::memcpy(out.at(x, y), image.at(r.x + x, r.y + y), 3);
  return out;
}

bool inside(const Region& r, int x, int y) { return x >= r.x && y >= r.y && x < r.x + r.width && y < r.y + r.height; }

/// Share of the pixels outside the region that differ; those are marked in `marked`.
double differing_share(const Image8& a, const Image8& b, const Region& rendered, Image8& marked) {
  long differing = 0, total = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      if (inside(rendered, x, y)) continue;
      ++total;
      const bool same = std::memcmp(a.at(x, y), b.at(x, y), 3) == 0;
      differing += !same;
      for (int c = 0; c < 3; ++c)
        marked.at(x, y)[c] = same ? static_cast<std::uint8_t>(a.at(x, y)[c] / 3) : (c == 0 ? 255 : 40);
    }
  return total > 0 ? static_cast<double>(differing) / static_cast<double>(total) : 0;
}

}  // namespace

testing::AssertionResult matches_baseline(const Image8& picture, const std::string& name, const Region& rendered) {
  const std::string baseline = std::string(BRUME_SOURCE_DIR) + "/tests/ui/baselines/" + name + ".png";
  const std::string output = std::string(BRUME_TEST_OUTPUT_DIR) + "/snapshots/" + name;
  std::filesystem::create_directories(std::filesystem::path(output).parent_path());
  std::filesystem::create_directories(std::filesystem::path(baseline).parent_path());
  if (const char* update = std::getenv("BRUME_UPDATE_BASELINES"); update && std::strcmp(update, "1") == 0) {
    const auto written = write_png(baseline, cropped(picture, {0, 0, picture.width, picture.height}));
    return written ? testing::AssertionSuccess() : testing::AssertionFailure() << written.error().to_string();
  }

  const auto keep = [&] {
    static_cast<void>(write_png(output + ".png", cropped(picture, {0, 0, picture.width, picture.height})).ok());
  };
  const auto stored = read_png(baseline);
  if (!stored) {
    keep();
    return testing::AssertionFailure() << stored.error().to_string()
                                       << "; tests/run --update-baselines makes it; the picture is " << output
                                       << ".png";
  }
  const Image8& expected = stored->image;
  if (expected.width != picture.width || expected.height != picture.height) {
    keep();
    return testing::AssertionFailure() << "the stored picture is " << expected.width << 'x' << expected.height
                                       << ", this one " << picture.width << 'x' << picture.height;
  }

  Image8 difference(picture.width, picture.height, 3);
  const double share = differing_share(picture, expected, rendered, difference);
  double flip_mean = 0;
  if (rendered.width > 0 && rendered.height > 0) {
    const auto seen = flip(cropped(picture, rendered), cropped(expected, rendered));
    if (!seen) return testing::AssertionFailure() << seen.error().to_string();
    flip_mean = seen->mean;
    const Image8 map = heat_map(*seen);
    for (int y = 0; y < rendered.height; ++y)
      for (int x = 0; x < rendered.width; ++x)
        std::memcpy(difference.at(rendered.x + x, rendered.y + y), map.at(x, y), 3);
  }
  if (flip_mean <= kMaxFlip && share <= kMaxDifferingShare) return testing::AssertionSuccess();
  keep();
  static_cast<void>(write_png(output + "_difference.png", difference).ok());
  return testing::AssertionFailure() << "mean FLIP inside the picture " << flip_mean << " (at most " << kMaxFlip
                                     << "), pixels that differ outside " << 100 * share << " % (at most "
                                     << 100 * kMaxDifferingShare << " %); see " << output << "_difference.png";
}

}  // namespace brume
