// One picture on the screen: the part of it that is seen, and the values of its pixels when they are large.
#pragma once

#include <imgui.h>

#include <memory>
#include <optional>

#include "app/gl/texture.h"
#include "app/panels/view_state.h"
#include "renderer/engine/engine.h"
#include "renderer/film/display_transform.h"

namespace brume {

/// Where a picture stands on the screen, in display coordinates.
struct PictureArea {
  ImVec2 min, max;

  float width() const { return max.x - min.x; }
  float height() const { return max.y - min.y; }
  bool contains(ImVec2 p) const { return p.x >= min.x && p.x < max.x && p.y >= min.y && p.y < max.y; }
  /// The place of the picture that is seen at a point of the screen, as fractions, and back.
  ImVec2 to_picture(const ViewState& view, ImVec2 screen) const;
  ImVec2 to_screen(const ViewState& view, ImVec2 place) const;
};

/// A picture kept on the graphics card as it is displayed.
class PictureTexture {
 public:
  explicit PictureTexture(const Gl& gl) : texture_(gl) {}

  /// Uploads the picture unless it is there already.
  void show(const std::shared_ptr<const Picture>& picture, const DisplaySettings& settings);
  /// The same for colours that are made already.
  void show(const Image8& rgba);

  /// The part of the picture that the view shows, over the area; only between the screen's columns `clip_left` and
  /// `clip_right`.
  void draw(const PictureArea& area, const ViewState& view, float clip_left, float clip_right);
  void draw(const PictureArea& area, const ViewState& view) { draw(area, view, area.min.x, area.max.x); }

 private:
  Texture texture_;
  std::shared_ptr<const Picture> uploaded_;
  std::optional<DisplaySettings> settings_;
  Image8 display_;
};

/// Red, green and blue of every pixel that is seen, when there is room for them.
void draw_pixel_values(const Image& image, const PictureArea& area, const ViewState& view);

}  // namespace brume
