// The one window on a real display.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/gl/gl.h"
#include "renderer/core/error.h"

namespace brume {

struct WindowOptions {
  std::vector<std::string> font_paths = {};  ///< tried before the usual places
  float scale = 0;                           ///< of the user interface; 0: what the display asks for
  bool vsync = true;
};

/// A window with OpenGL 3.3 core and its own ImGui context. One at a time, on the main thread; only wake() may be
/// called from others.
class Window {
 public:
  /// `width`, `height` in pixels of a display of scale 1. Fails in one sentence when there is no display.
  static Result<std::unique_ptr<Window>> create(const std::string& title, int width, int height,
                                                const WindowOptions& options = {});
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();

  /// Takes the waiting events. `idle`: nothing is animated and no new picture is due, so it sleeps until an event or
  /// wake() comes, at most a tenth of a second (tooltips and cursors live on that); awake for a moment after events.
  void wait_or_poll(bool idle);
  /// Ends wait_or_poll early. From any thread.
  void wake() const;

  /// Draws and shows one frame. Returns false once the window is to close. A minimised window draws nothing.
  bool frame(const std::function<void(const Gl&)>& draw_ui);

  /// The way of the close button: asks the callback, which may refuse.
  void request_close();
  /// Returns whether the window may close now; without one it always may. To ask the user first, return false, show
  /// the question, and call request_close() again when it is answered.
  void on_close(std::function<bool()> may_close);
  /// Files dropped onto the window, as UTF-8 paths.
  void on_drop(std::function<void(const std::vector<std::string>&)> dropped);
  /// The window moved to a display of another scale; the theme and the fonts have followed already.
  void on_scale(std::function<void(float)> changed);

  void set_title(const std::string& title);
  std::string clipboard() const;
  void set_clipboard(const std::string& text);

  const Gl& gl() const;
  /// Of the user interface, see apply_theme().
  float scale() const;
  /// The font file in use, empty when it is ImGui's own font.
  const std::string& font() const;
  /// Size of the picture in pixels.
  int pixel_width() const;
  int pixel_height() const;

 private:
  struct State;
  explicit Window(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;  // where GLFW's callbacks find everything
};

/// Whether create() can succeed: a display is named and answers.
bool display_available();

}  // namespace brume
