#include "app/gl/imgui_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace brume {

namespace {

constexpr const char* kVertexShader = R"(#version 330 core
uniform vec2 scale;
uniform vec2 offset;
in vec2 position;
in vec2 uv;
in vec4 color;
out vec2 pixel_uv;
out vec4 pixel_color;
void main() {
  pixel_uv = uv;
  pixel_color = color;
  gl_Position = vec4(position * scale + offset, 0.0, 1.0);
}
)";

constexpr const char* kFragmentShader = R"(#version 330 core
uniform sampler2D picture;
in vec2 pixel_uv;
in vec4 pixel_color;
out vec4 out_color;
void main() { out_color = pixel_color * texture(picture, pixel_uv); }
)";

const void* buffer_offset(size_t bytes) { return reinterpret_cast<const void*>(bytes); }

}  // namespace

Result<std::unique_ptr<ImguiRenderer>> ImguiRenderer::create(const Gl& gl) {
  Result<ShaderProgram> program =
      ShaderProgram::create(gl, kVertexShader, kFragmentShader, {"position", "uv", "color"});
  if (!program) return program.error();
  std::unique_ptr<ImguiRenderer> renderer(new ImguiRenderer(gl, std::move(program).value()));
  if (Result<void> uploaded = renderer->upload_fonts(); !uploaded) return uploaded.error();
  return renderer;
}

ImguiRenderer::ImguiRenderer(const Gl& gl, ShaderProgram program)
    : gl_(gl),
      program_(std::move(program)),
      uniform_scale_(program_.uniform("scale")),
      uniform_offset_(program_.uniform("offset")),
      uniform_texture_(program_.uniform("picture")),
      fonts_(gl, TextureFilter::Linear) {
  ImGuiIO& io = ImGui::GetIO();
  io.BackendRendererName = "brume";
  // Lets one window hold more than 65536 vertices with 16 bit indices (a long log, a dense chart).
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;

  gl_.GenVertexArrays(1, &vertex_array_);
  gl_.GenBuffers(1, &vertex_buffer_);
  gl_.GenBuffers(1, &index_buffer_);
  gl_.BindVertexArray(vertex_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_);
  constexpr GLsizei stride = sizeof(ImDrawVert);
  for (GLuint location : {0u, 1u, 2u}) gl_.EnableVertexAttribArray(location);
  gl_.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, buffer_offset(offsetof(ImDrawVert, pos)));
  gl_.VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride, buffer_offset(offsetof(ImDrawVert, uv)));
  gl_.VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, buffer_offset(offsetof(ImDrawVert, col)));
  gl_.BindVertexArray(0);
}

ImguiRenderer::~ImguiRenderer() {
  gl_.DeleteVertexArrays(1, &vertex_array_);
  gl_.DeleteBuffers(1, &vertex_buffer_);
  gl_.DeleteBuffers(1, &index_buffer_);
}

Result<void> ImguiRenderer::upload_fonts() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
  const size_t bytes = static_cast<size_t>(width) * static_cast<size_t>(height) * 4;
  Result<void> uploaded = fonts_.upload(width, height, {pixels, bytes});
  atlas.SetTexID(fonts_.id());
  return uploaded;
}

void ImguiRenderer::set_state(const ImDrawData& data, int pixel_width, int pixel_height) const {
  gl_.Viewport(0, 0, pixel_width, pixel_height);
  gl_.Enable(GL_BLEND);
  gl_.BlendEquation(GL_FUNC_ADD);
  // Alpha adds up, so that a screenshot over an opaque background stays opaque.
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  constexpr GLenum kOff[] = {GL_CULL_FACE, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_PRIMITIVE_RESTART, GL_FRAMEBUFFER_SRGB};
  for (const GLenum off : kOff) gl_.Disable(off);
  gl_.Enable(GL_SCISSOR_TEST);
  gl_.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);

  // Display coordinates run down from DisplayPos, clip coordinates up from -1.
  const ImVec2 scale(2.0f / data.DisplaySize.x, -2.0f / data.DisplaySize.y);
  program_.use();
  gl_.Uniform2f(uniform_scale_, scale.x, scale.y);
  gl_.Uniform2f(uniform_offset_, -1.0f - data.DisplayPos.x * scale.x, 1.0f - data.DisplayPos.y * scale.y);
  gl_.Uniform1i(uniform_texture_, 0);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindSampler(0, 0);
  gl_.BindVertexArray(vertex_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
}

void ImguiRenderer::draw(const ImDrawData& data) {
  const ImVec2 density = data.FramebufferScale;
  const int pixel_width = static_cast<int>(data.DisplaySize.x * density.x);
  const int pixel_height = static_cast<int>(data.DisplaySize.y * density.y);
  if (pixel_width <= 0 || pixel_height <= 0) return;
  set_state(data, pixel_width, pixel_height);

  constexpr GLenum kIndexType = sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    gl_.BufferData(GL_ARRAY_BUFFER,
                   static_cast<GLsizeiptr>(list.VtxBuffer.Size) * static_cast<GLsizeiptr>(sizeof(ImDrawVert)),
                   list.VtxBuffer.Data, GL_STREAM_DRAW);
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                   static_cast<GLsizeiptr>(list.IdxBuffer.Size) * static_cast<GLsizeiptr>(sizeof(ImDrawIdx)),
                   list.IdxBuffer.Data, GL_STREAM_DRAW);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback) {
        if (command.UserCallback == ImDrawCallback_ResetRenderState)
          set_state(data, pixel_width, pixel_height);
        else
          command.UserCallback(&list, &command);
        continue;
      }
      const int left = std::max(0, static_cast<int>((command.ClipRect.x - data.DisplayPos.x) * density.x));
      const int top = std::max(0, static_cast<int>((command.ClipRect.y - data.DisplayPos.y) * density.y));
      const int right = std::min(pixel_width, static_cast<int>((command.ClipRect.z - data.DisplayPos.x) * density.x));
      const int bottom = std::min(pixel_height, static_cast<int>((command.ClipRect.w - data.DisplayPos.y) * density.y));
      if (right <= left || bottom <= top) continue;
      gl_.Scissor(left, pixel_height - bottom, right - left, bottom - top);
      // Through intptr_t: ImTextureID is a pointer in the versions we build with and an integer in later ones.
      gl_.BindTexture(GL_TEXTURE_2D, static_cast<GLuint>((std::intptr_t)(command.GetTexID())));
      gl_.DrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), kIndexType,
                                 buffer_offset(command.IdxOffset * sizeof(ImDrawIdx)),
                                 static_cast<GLint>(command.VtxOffset));
    }
  }
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.BindVertexArray(0);
}

}  // namespace brume
