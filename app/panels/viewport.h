// The pictures, and the camera under the mouse.
#pragma once

#include <vector>

#include "app/panels/picture_view.h"
#include "app/session/session.h"

namespace brume {

class Viewport {
 public:
  explicit Viewport(const Gl& gl);

  /// Fills the rest of the current window. Pictures keep the film's proportions and are rendered at the size that one
  /// alone would have, so that looking at them in another way renders nothing anew.
  /// @param measured  false leaves out what differs between runs
  void draw(Session& session, ViewState& view, bool measured);

 private:
  struct Room;  // where pictures may be drawn

  /// The picture of a variant as it is displayed, on the card.
  PictureTexture& picture(const Session& session, std::size_t variant);
  void draw_single(Session& session, ViewState& view, const PictureArea& area);
  void draw_tiles(Session& session, ViewState& view, const Room& room, bool measured);
  void draw_wipe(Session& session, ViewState& view, const PictureArea& area);
  void draw_difference(Session& session, ViewState& view, const PictureArea& area);
  void handle_mouse(Session& session, ViewState& view, const PictureArea& area);

  std::vector<PictureTexture> pictures_;  // of the variants
  PictureTexture difference_;
  struct {
    std::shared_ptr<const Image> test, reference;
    DifferenceKind kind = {};
    double range = 0;  // 0: there is no map
  } differing_;
  bool dragging_line_ = false;
};

}  // namespace brume
