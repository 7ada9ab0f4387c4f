// Without X11: this file must compile and run where there is none.
#define EGL_NO_X11 1
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <string>
#include <string_view>

#include "app/headless/offscreen_context.h"

namespace brume {

namespace {

void* egl_address(const char* name) { return reinterpret_cast<void*>(eglGetProcAddress(name)); }

Error egl_error(const std::string& what) {
  return {ErrorCode::Internal, what + "; install the packages libegl1, libegl-mesa0 and libgl1-mesa-dri."};
}

bool lists(const char* extensions, std::string_view name) {
  return extensions && std::string_view(extensions).find(name) != std::string_view::npos;
}

class EglContext final : public OffscreenContext {
 public:
  EglContext(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}
  // The display stays initialised: every surfaceless context of the process shares it, and eglTerminate would end
  // the others as well.
  ~EglContext() override {
    if (eglGetCurrentContext() == context_) release();
    eglDestroyContext(display_, context_);
  }

  Result<void> make_current() override {
    // Released first: OSMesa shares Mesa's dispatch table in libglapi, and EGL skips the switch when it believes that
    // this context is current already.
    release();
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      return egl_error("EGL could not use a context without a surface");
    return {};
  }
  GlLoader loader() const override { return egl_address; }
  const char* name() const override { return "EGL surfaceless"; }

 private:
  void release() { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

  EGLDisplay display_;
  EGLContext context_;
};

}  // namespace

Result<std::unique_ptr<OffscreenContext>> create_egl_context() {
  if (!lists(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless"))
    return egl_error("EGL has no surfaceless platform here");
  const auto get_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  const EGLDisplay display =
      get_display ? get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr) : EGL_NO_DISPLAY;
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
    return egl_error("EGL found no driver for drawing without a display");
  if (!eglBindAPI(EGL_OPENGL_API)) return egl_error("EGL has no desktop OpenGL here");

  const EGLint config_attributes[] = {EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  // Surfaceless Mesa may list no matching configuration; a context without one (null) is then allowed by
  // EGL_KHR_no_config_context.
  if (!eglChooseConfig(display, config_attributes, &config, 1, &count) || count == 0) config = nullptr;

  const EGLint context_attributes[] = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  const EGLContext made = eglCreateContext(display, config, EGL_NO_CONTEXT, context_attributes);
  if (made == EGL_NO_CONTEXT) return egl_error("EGL could not make an OpenGL 3.3 core context");
  auto context = std::make_unique<EglContext>(display, made);
  if (const Result<void> current = context->make_current(); !current) return current.error();
  return std::unique_ptr<OffscreenContext>(std::move(context));
}

}  // namespace brume
