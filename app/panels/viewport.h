// The picture, and the camera under the mouse.
#pragma once

#include <optional>

#include "app/gl/texture.h"
#include "app/session/session.h"

namespace brume {

class Viewport {
 public:
  explicit Viewport(const Gl& gl) : texture_(gl) {}

  /// Fills the rest of the current window. The picture keeps the film's proportions and is rendered at the size at
  /// which it is shown.
  void draw(Session& session);

 private:
  void upload(const Session& session);
  void handle_mouse(Session& session, float picture_height);
  void draw_overlays(const Session& session, float x, float y, float width, float height);

  Texture texture_;
  std::shared_ptr<const Picture> uploaded_;
  std::optional<Node> uploaded_film_;
  Image8 display_;
};

}  // namespace brume
