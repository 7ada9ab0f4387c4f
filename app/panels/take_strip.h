// Pictures that were kept.
#pragma once

#include <optional>
#include <vector>

#include "app/panels/picture_view.h"
#include "app/session/session.h"

namespace brume {

class TakeStrip {
 public:
  explicit TakeStrip(const Gl& gl) : gl_(gl) {}

  /// A row of small pictures, as high as the rest of the current window: a click restores the scene of one.
  /// @return the take that the user wants to export
  std::optional<std::size_t> draw(Session& session);

 private:
  struct Thumbnail {
    int number;  // of the take
    float aspect;
    PictureTexture texture;
  };

  Thumbnail& thumbnail(const Take& take);

  const Gl& gl_;
  std::vector<Thumbnail> thumbnails_;
};

}  // namespace brume
