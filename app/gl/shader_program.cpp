#include "app/gl/shader_program.h"

#include <utility>

namespace brume {

namespace {

Error log_error(const char* step, std::string log) {
  return {ErrorCode::Internal, std::string("The graphics driver refused to ") + step + ": " + log.c_str()};
}

Result<GLuint> compile(const Gl& gl, GLenum stage, const char* source) {
  const GLuint shader = gl.CreateShader(stage);
  gl.ShaderSource(shader, 1, &source, nullptr);
  gl.CompileShader(shader);
  GLint ok = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok) return shader;
  std::string log(2048, '\0');
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  gl.DeleteShader(shader);
  return log_error(stage == GL_VERTEX_SHADER ? "compile a vertex shader" : "compile a fragment shader", log);
}

}  // namespace

Result<ShaderProgram> ShaderProgram::create(const Gl& gl, const char* vertex, const char* fragment,
                                            const std::vector<const char*>& attributes) {
  const Result<GLuint> vertex_shader = compile(gl, GL_VERTEX_SHADER, vertex);
  if (!vertex_shader) return vertex_shader.error();
  const Result<GLuint> fragment_shader = compile(gl, GL_FRAGMENT_SHADER, fragment);
  if (!fragment_shader) {
    gl.DeleteShader(*vertex_shader);
    return fragment_shader.error();
  }

  ShaderProgram program(gl, gl.CreateProgram());
  gl.AttachShader(program.id_, *vertex_shader);
  gl.AttachShader(program.id_, *fragment_shader);
  for (size_t i = 0; i < attributes.size(); ++i)
    gl.BindAttribLocation(program.id_, static_cast<GLuint>(i), attributes[i]);
  gl.BindFragDataLocation(program.id_, 0, "out_color");
  gl.LinkProgram(program.id_);
  // The program keeps what it needs; the shader objects live on only as long as it does.
  gl.DeleteShader(*vertex_shader);
  gl.DeleteShader(*fragment_shader);

  GLint ok = 0;
  gl.GetProgramiv(program.id_, GL_LINK_STATUS, &ok);
  if (ok) return program;
  std::string log(2048, '\0');
  gl.GetProgramInfoLog(program.id_, static_cast<GLsizei>(log.size()), nullptr, log.data());
  return log_error("link a shader", log);
}

ShaderProgram::ShaderProgram(ShaderProgram&& other) noexcept : gl_(other.gl_), id_(std::exchange(other.id_, 0)) {}

ShaderProgram& ShaderProgram::operator=(ShaderProgram&& other) noexcept {
  std::swap(gl_, other.gl_);
  std::swap(id_, other.id_);
  return *this;
}

ShaderProgram::~ShaderProgram() {
  if (id_) gl_->DeleteProgram(id_);
}

}  // namespace brume
