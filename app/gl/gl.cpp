#include "app/gl/gl.h"

namespace brume {

namespace {

std::string text_of(const GLubyte* text) { return text ? reinterpret_cast<const char*>(text) : "unknown"; }

}  // namespace

Result<Gl> load_gl(GlLoader get_proc_address) {
  Gl gl;
#define BRUME_GL_LOAD(type, name)                                 \
  gl.name = reinterpret_cast<type>(get_proc_address("gl" #name)); \
  if (!gl.name)                                                   \
    return Error{ErrorCode::Internal,                             \
                 "The OpenGL driver has no function gl" #name     \
                 "; Brume needs OpenGL 3.3 core, so update the graphics driver (package libgl1-mesa-dri)."};
  BRUME_GL_FUNCTIONS(BRUME_GL_LOAD)
#undef BRUME_GL_LOAD

  // Some loaders hand out a stub for every name, so the version has to be asked as well.
  GLint major = 0, minor = 0;
  gl.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor < 33)
    return Error{ErrorCode::Internal, "Found OpenGL " + std::to_string(major) + "." + std::to_string(minor) + " (" +
                                          describe(gl) + "), expected 3.3 core or newer; update the graphics driver."};
  return gl;
}

std::string describe(const Gl& gl) {
  return text_of(gl.GetString(GL_VERSION)) + ", " + text_of(gl.GetString(GL_RENDERER));
}

}  // namespace brume
