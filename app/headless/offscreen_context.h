// OpenGL without a window or a display.
#pragma once

#include <memory>

#include "app/gl/gl.h"

namespace brume {

enum class OffscreenKind {
  Any,            ///< OSMesa, or else EGL
  Osmesa,         ///< software rendering in libOSMesa (gone from Mesa 25.1 on)
  EglSurfaceless  ///< EGL_MESA_platform_surfaceless
};

/// An OpenGL 3.3 core context with no picture of its own: draw into a Framebuffer. One thread at a time.
class OffscreenContext {
 public:
  virtual ~OffscreenContext() = default;
  virtual Result<void> make_current() = 0;
  virtual GlLoader loader() const = 0;
  virtual const char* name() const = 0;
};

/// The new context is current. Fails with the package to install.
Result<std::unique_ptr<OffscreenContext>> create_offscreen_context(OffscreenKind kind);

/// One each, so that GL/osmesa.h and EGL/egl.h stay in their own translation units.
Result<std::unique_ptr<OffscreenContext>> create_osmesa_context();
Result<std::unique_ptr<OffscreenContext>> create_egl_context();

}  // namespace brume
