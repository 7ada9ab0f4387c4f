#include "renderer/analysis/comparable.h"

#include <string>

namespace brume {
namespace {

template <class Picture> std::string extents(const Picture& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

template <class Picture> std::optional<Error> mismatch(const Picture& test, const Picture& reference) {
  if (!is_consistent(test) || !is_consistent(reference) || test.empty() || reference.empty())
    return bad_input("found an image without pixels, expected at least one to compare");
  if (test.width != reference.width || test.height != reference.height)
    return bad_input("found images of " + extents(test) + " and " + extents(reference) +
                     " pixels, expected the same extents to compare");
  return {};
}

std::optional<Error> find_non_finite(const Image& image, const std::string& which) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (!is_finite(image.at(x, y)))
        return bad_input("found a NaN or an infinity in pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                         ") of the " + which + ", expected finite values");
  return {};
}

}  // namespace

std::optional<Error> not_comparable(const Image& test, const Image& reference) {
  if (std::optional<Error> error = mismatch(test, reference)) return error;
  if (std::optional<Error> error = find_non_finite(test, "test image")) return error;
  return find_non_finite(reference, "reference image");
}

std::optional<Error> not_comparable(const Image8& test, const Image8& reference) { return mismatch(test, reference); }

}  // namespace brume
