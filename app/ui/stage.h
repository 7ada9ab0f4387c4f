// The user interface without a window, frame by frame: for tests, screenshots and the gallery.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/gl/framebuffer.h"
#include "app/gl/gl.h"
#include "app/gl/imgui_renderer.h"
#include "app/headless/offscreen_context.h"
#include "app/ui/item_recorder.h"

struct ImGuiContext;

namespace brume {

/// Draws one frame with ImGui:: and brume::ui:: calls; the Gl is for textures and pictures of one's own.
using DrawUi = std::function<void(const Gl&)>;

struct StageOptions {
  int width = 1280, height = 800;  ///< pixels
  float scale = 1;                 ///< of the theme and the font, as on a display of that content scale
  OffscreenKind kind = OffscreenKind::Any;
  float dt = 1.0f / 60;                      ///< what every frame is told to have taken, in seconds
  std::vector<std::string> font_paths = {};  ///< tried before the usual places
};

/// Owns an ImGui context, an OpenGL context, a picture and the record of what was drawn. The same frames and input
/// give the same bytes. Several may exist, but all on one thread; each makes its contexts current when used.
class Stage {
 public:
  static Result<std::unique_ptr<Stage>> create(const StageOptions& options = {});
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
  ~Stage();

  /// NewFrame, draw_ui, Render, and all of it into the picture.
  void frame(const DrawUi& draw_ui);
  /// The last frame: [height][width][4], row 0 at the top. Opaque.
  std::vector<std::uint8_t> pixels() const;

  /// Makes both contexts current, for calls to ImGui or Gl outside frame().
  void make_current() const;
  const Gl& gl() const { return gl_; }
  const ui::ItemRecorder& recorder() const { return recorder_; }
  /// "OSMesa" or "EGL surfaceless"
  const char* context_name() const { return context_->name(); }
  /// The font file in use, empty when it is ImGui's own font.
  const std::string& font() const { return font_; }
  int width() const { return framebuffer_->width(); }
  int height() const { return framebuffer_->height(); }

 private:
  Stage() = default;

  std::unique_ptr<OffscreenContext> context_;
  Gl gl_;
  ImGuiContext* imgui_ = nullptr;
  std::unique_ptr<Framebuffer> framebuffer_;
  std::unique_ptr<ImguiRenderer> renderer_;
  ui::ItemRecorder recorder_;
  std::string font_;
};

}  // namespace brume
