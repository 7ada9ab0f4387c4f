// A linked vertex and fragment shader.
#pragma once

#include <string>
#include <vector>

#include "app/gl/gl.h"

namespace brume {

/// Owns a GL program; empty after being moved from. Create and destroy with its context current.
class ShaderProgram {
 public:
  /// `attributes[i]` is bound to location i; the fragment shader's output is "out_color".
  /// Fails with the driver's log.
  static Result<ShaderProgram> create(const Gl& gl, const char* vertex, const char* fragment,
                                      const std::vector<const char*>& attributes);
  ShaderProgram(ShaderProgram&& other) noexcept;
  ShaderProgram& operator=(ShaderProgram&& other) noexcept;
  ~ShaderProgram();

  void use() const { gl_->UseProgram(id_); }
  /// -1 when the shader has no such uniform (the compiler drops unused ones).
  GLint uniform(const char* name) const { return gl_->GetUniformLocation(id_, name); }

 private:
  ShaderProgram(const Gl& gl, GLuint id) : gl_(&gl), id_(id) {}

  const Gl* gl_;
  GLuint id_;
};

}  // namespace brume
