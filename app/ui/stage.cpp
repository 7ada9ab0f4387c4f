#include "app/ui/stage.h"

#include <imgui.h>

#include <cfloat>
#include <utility>

#include "app/ui/keys.h"
#include "app/ui/theme.h"

namespace brume {

Result<std::unique_ptr<Stage>> Stage::create(const StageOptions& options) {
  std::unique_ptr<Stage> stage(new Stage);
  Result<std::unique_ptr<OffscreenContext>> context = create_offscreen_context(options.kind);
  if (!context) return context.error();
  stage->context_ = std::move(context).value();
  const Result<Gl> gl = load_gl(stage->context_->loader());
  if (!gl) return gl.error();
  stage->gl_ = *gl;
  Result<std::unique_ptr<Framebuffer>> framebuffer = Framebuffer::create(stage->gl_, options.width, options.height);
  if (!framebuffer) return framebuffer.error();
  stage->framebuffer_ = std::move(framebuffer).value();

  stage->imgui_ = ImGui::CreateContext();
  ImGui::SetCurrentContext(stage->imgui_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.DisplaySize = {static_cast<float>(options.width), static_cast<float>(options.height)};
  io.DeltaTime = options.dt;
  io.MousePos = {-FLT_MAX, -FLT_MAX};
  io.ConfigInputTextCursorBlink = false;  // a screenshot must not depend on how many frames went before
  io.UserData = &stage->recorder_;
  ui::teach_keys(io);
  ui::apply_theme(options.scale);
  stage->font_ = ui::load_fonts(options.scale, options.font_paths);

  Result<std::unique_ptr<ImguiRenderer>> renderer = ImguiRenderer::create(stage->gl_);
  if (!renderer) return renderer.error();
  stage->renderer_ = std::move(renderer).value();
  return stage;
}

Stage::~Stage() {
  // What the members own in OpenGL is freed after this, in the reverse order of their declaration.
  if (context_) static_cast<void>(context_->make_current().ok());
  if (!imgui_) return;
  // Another Stage's ImGui context may be the current one; it stays so.
  ImGuiContext* before = ImGui::GetCurrentContext();
  ImGui::DestroyContext(imgui_);
  ImGui::SetCurrentContext(before == imgui_ ? nullptr : before);
}

void Stage::make_current() const {
  ImGui::SetCurrentContext(imgui_);
  // It was current once; only a lost driver could refuse, and then nothing is drawn.
  static_cast<void>(context_->make_current().ok());
}

void Stage::frame(const DrawUi& draw_ui) {
  make_current();
  ImGui::NewFrame();
  draw_ui(gl_);
  ImGui::Render();

  framebuffer_->bind();
  const ImVec4 background = ui::theme_background();
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.ClearColor(background.x, background.y, background.z, 1);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  renderer_->draw(*ImGui::GetDrawData());
}

std::vector<std::uint8_t> Stage::pixels() const {
  make_current();
  return framebuffer_->read_pixels();
}

}  // namespace brume
