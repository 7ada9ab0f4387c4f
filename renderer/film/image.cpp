#include "renderer/film/image.h"

namespace brume {

bool is_consistent(const Image& image) {
  return image.width >= 0 && image.height >= 0 &&
         image.pixels.size() == static_cast<std::size_t>(image.width) * image.height;
}

bool is_consistent(const Image8& image) {
  return image.width >= 0 && image.height >= 0 && (image.channels == 3 || image.channels == 4) &&
         image.bytes.size() == static_cast<std::size_t>(image.width) * image.height * image.channels;
}

}  // namespace brume
