// Draws what ImGui asks for.
#pragma once

#include <imgui.h>

#include <memory>

#include "app/gl/gl.h"
#include "app/gl/shader_program.h"
#include "app/gl/texture.h"

namespace brume {

/// Replaces the upstream backend, which cannot find OpenGL under OSMesa. An ImTextureID is a GL texture name.
/// Create and use with its GL context and its ImGui context current; destroy with the GL context current.
class ImguiRenderer {
 public:
  static Result<std::unique_ptr<ImguiRenderer>> create(const Gl& gl);
  ImguiRenderer(const ImguiRenderer&) = delete;
  ImguiRenderer& operator=(const ImguiRenderer&) = delete;
  ~ImguiRenderer();

  /// Call after the font atlas was built or built again, before the next frame.
  Result<void> upload_fonts();

  /// Draws into the bound framebuffer, the display's top left corner being its top left. Leaves blending on and the
  /// scissor test off; whoever draws next sets what he needs.
  void draw(const ImDrawData& data);

 private:
  ImguiRenderer(const Gl& gl, ShaderProgram program);
  void set_state(const ImDrawData& data, int pixel_width, int pixel_height) const;

  const Gl& gl_;
  ShaderProgram program_;
  GLint uniform_scale_, uniform_offset_, uniform_texture_;
  GLuint vertex_array_ = 0, vertex_buffer_ = 0, index_buffer_ = 0;
  Texture fonts_;
};

}  // namespace brume
