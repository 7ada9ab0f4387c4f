#include "app/headless/offscreen_context.h"

namespace brume {

Result<std::unique_ptr<OffscreenContext>> create_offscreen_context(OffscreenKind kind) {
  if (kind == OffscreenKind::Osmesa) return create_osmesa_context();
  if (kind == OffscreenKind::EglSurfaceless) return create_egl_context();

  Result<std::unique_ptr<OffscreenContext>> osmesa = create_osmesa_context();
  if (osmesa) return osmesa;
  Result<std::unique_ptr<OffscreenContext>> egl = create_egl_context();
  if (egl) return egl;
  return Error{ErrorCode::Internal,
               "No OpenGL without a display. OSMesa: " + osmesa.error().message + " EGL: " + egl.error().message};
}

}  // namespace brume
