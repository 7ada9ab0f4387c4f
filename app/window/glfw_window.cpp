#include "app/window/glfw_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "app/gl/imgui_renderer.h"
#include "app/ui/theme.h"

namespace brume {

namespace {

std::string glfw_reason() {
  const char* reason = nullptr;
  glfwGetError(&reason);
  return reason ? reason : "no reason given";
}

Error no_display() {
  return {ErrorCode::Internal, "Cannot open a window, no display answers (" + glfw_reason() +
                                   "): start Brume in a desktop session or with `ssh -X`, or render without a window."};
}

void* glfw_address(const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); }

}  // namespace

struct Window::State {
  GLFWwindow* window = nullptr;
  ImGuiContext* imgui = nullptr;
  bool backend = false;
  Gl gl;
  std::unique_ptr<ImguiRenderer> renderer;
  WindowOptions options;
  std::string font;
  float scale = 0, density = 0;
  double awake_until = 0, last_frame = 0;  // seconds of glfwGetTime()
  std::vector<int> pressed_keys;           // since the last frame
  std::vector<int> late_releases;          // of those
  std::function<bool()> may_close;
  std::function<void(const std::vector<std::string>&)> dropped;
  std::function<void(float)> scale_changed;

  ~State();
  void install_callbacks();
  void take_key(int key, int scancode, int action, int mods);
  void release_late_keys();
  void follow_display();
  void close_if_allowed();
  static State& of(GLFWwindow* window) { return *static_cast<State*>(glfwGetWindowUserPointer(window)); }
};

Window::State::~State() {
  if (window) {
    glfwMakeContextCurrent(window);
    renderer.reset();
  }
  if (imgui) {
    ImGui::SetCurrentContext(imgui);
    if (backend) ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext(imgui);
  }
  if (window) glfwDestroyWindow(window);
  glfwTerminate();
}

void Window::State::install_callbacks() {
  glfwSetWindowUserPointer(window, this);
  glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { of(w).close_if_allowed(); });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    if (of(w).dropped) of(w).dropped(std::vector<std::string>(paths, paths + count));
  });
#if IMGUI_VERSION_NUM < 18700
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
    of(w).take_key(key, scancode, action, mods);
  });
#endif
}

// Two things that the backend does by itself from 1.87 on.
void Window::State::take_key(int key, int scancode, int action, int mods) {
  // GLFW names keys by their place on an American keyboard, so that Ctrl+Z would be Ctrl+Y on a German one.
  const char* name = key >= GLFW_KEY_SPACE && key < GLFW_KEY_ESCAPE ? glfwGetKeyName(key, scancode) : nullptr;
  if (name && name[0] != '\0' && name[1] == '\0') {
    const int printed = std::toupper(static_cast<unsigned char>(name[0]));
    if ((printed >= 'A' && printed <= 'Z') || (printed >= '0' && printed <= '9')) key = printed;
  }
  // ImGui only sees what is down when a frame begins: a key tapped between two frames is released after the second.
  if (action == GLFW_PRESS) pressed_keys.push_back(key);
  if (action == GLFW_RELEASE && std::count(pressed_keys.begin(), pressed_keys.end(), key) > 0)
    late_releases.push_back(key);
  else
    ImGui_ImplGlfw_KeyCallback(window, key, scancode, action, mods);
}

void Window::State::release_late_keys() {
  pressed_keys.clear();
  for (const int key : std::exchange(late_releases, {})) ImGui_ImplGlfw_KeyCallback(window, key, 0, GLFW_RELEASE, 0);
}

void Window::State::close_if_allowed() {
  // GLFW has set the flag already when the close button was pressed.
  glfwSetWindowShouldClose(window, !may_close || may_close() ? GLFW_TRUE : GLFW_FALSE);
}

// The display may scale coordinates itself (Wayland), or leave all of it to us (X11): the product of `density` and
// `scale` is what it asks for. Asked every frame, which also covers a window dragged to another display.
void Window::State::follow_display() {
  int width = 0, height = 0, pixel_width = 0, pixel_height = 0;
  glfwGetWindowSize(window, &width, &height);
  glfwGetFramebufferSize(window, &pixel_width, &pixel_height);
  float content_x = 1, content_y = 1;
  glfwGetWindowContentScale(window, &content_x, &content_y);
  const float now_density =
      width > 0 && pixel_width > 0 ? static_cast<float>(pixel_width) / static_cast<float>(width) : 1;
  // In quarters: a display of 101 dpi asks for 1.05, which only makes the font uneven.
  const float asked = std::round(content_x / now_density * 4) / 4;
  const float now_scale = std::clamp(options.scale > 0 ? options.scale : asked, 0.5f, 4.0f);
  if (now_scale == scale && now_density == density) return;

  const bool first = scale == 0;
  scale = now_scale;
  density = now_density;
  ui::apply_theme(scale);
  font = ui::load_fonts(scale, options.font_paths, density);
  // Only a font texture over the driver's limit could fail: scale is bounded, so it cannot.
  if (renderer) static_cast<void>(renderer->upload_fonts().ok());
  if (!first && scale_changed) scale_changed(scale);
}

Result<std::unique_ptr<Window>> Window::create(const std::string& title, int width, int height,
                                               const WindowOptions& options) {
  if (!glfwInit()) return no_display();
  auto state = std::make_unique<State>();
  state->options = options;

  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  state->window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (!state->window)
    return Error{ErrorCode::Internal,
                 "Cannot open a window with OpenGL 3.3 (" + glfw_reason() +
                     "): update the graphics driver (package libgl1-mesa-dri), or render without a window."};
  glfwMakeContextCurrent(state->window);
  glfwSwapInterval(options.vsync ? 1 : 0);
  const Result<Gl> gl = load_gl(glfw_address);
  if (!gl) return gl.error();
  state->gl = *gl;

  state->imgui = ImGui::CreateContext();
  ImGui::SetCurrentContext(state->imgui);
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::GetIO().LogFilename = nullptr;
  state->backend = ImGui_ImplGlfw_InitForOpenGL(state->window, true);
  state->install_callbacks();
  state->follow_display();
  Result<std::unique_ptr<ImguiRenderer>> renderer = ImguiRenderer::create(state->gl);
  if (!renderer) return renderer.error();
  state->renderer = std::move(renderer).value();
  return std::unique_ptr<Window>(new Window(std::move(state)));
}

Window::Window(std::unique_ptr<State> state) : state_(std::move(state)) {}

Window::~Window() = default;

void Window::wait_or_poll(bool idle) {
  constexpr double kNap = 0.1;    // seconds
  constexpr double kAwake = 0.6;  // hovering, tooltips and closing popups take a few frames after the last event
  const double start = glfwGetTime();
  if (!idle || start < state_->awake_until) {
    glfwPollEvents();
    // Without a working vsync (software drivers) frames beyond what a display shows only take the cores from the
    // render.
    constexpr double kFrameTime = 1.0 / 75;
    for (double left = state_->last_frame + kFrameTime - start; left > 0.0005;
         left = state_->last_frame + kFrameTime - glfwGetTime())
      glfwWaitEventsTimeout(left);
    return;
  }
  glfwWaitEventsTimeout(kNap);
  if (glfwGetTime() - start < kNap * 0.95) state_->awake_until = glfwGetTime() + kAwake;
}

void Window::wake() const { glfwPostEmptyEvent(); }

bool Window::frame(const std::function<void(const Gl&)>& draw_ui) {
  if (glfwWindowShouldClose(state_->window)) return false;
  glfwMakeContextCurrent(state_->window);
  ImGui::SetCurrentContext(state_->imgui);
  if (pixel_width() == 0 || pixel_height() == 0) {
    glfwWaitEventsTimeout(0.1);
    return true;
  }
  state_->last_frame = glfwGetTime();
  state_->follow_display();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  draw_ui(state_->gl);
  ImGui::Render();
  state_->release_late_keys();

  const Gl& gl = state_->gl;
  const ImVec4 background = ui::theme_background();
  gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl.Viewport(0, 0, pixel_width(), pixel_height());
  gl.Disable(GL_SCISSOR_TEST);
  gl.ClearColor(background.x, background.y, background.z, 1);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  state_->renderer->draw(*ImGui::GetDrawData());
  glfwSwapBuffers(state_->window);
  return !glfwWindowShouldClose(state_->window);
}

void Window::request_close() { state_->close_if_allowed(); }
void Window::on_close(std::function<bool()> may_close) { state_->may_close = std::move(may_close); }
void Window::on_drop(std::function<void(const std::vector<std::string>&)> dropped) {
  state_->dropped = std::move(dropped);
}
void Window::on_scale(std::function<void(float)> changed) { state_->scale_changed = std::move(changed); }

void Window::set_title(const std::string& title) { glfwSetWindowTitle(state_->window, title.c_str()); }
std::string Window::clipboard() const {
  const char* text = glfwGetClipboardString(state_->window);
  return text ? text : "";
}
void Window::set_clipboard(const std::string& text) { glfwSetClipboardString(state_->window, text.c_str()); }

const Gl& Window::gl() const { return state_->gl; }
float Window::scale() const { return state_->scale; }
const std::string& Window::font() const { return state_->font; }

int Window::pixel_width() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(state_->window, &width, &height);
  return width;
}

int Window::pixel_height() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(state_->window, &width, &height);
  return height;
}

// GLFW stays initialised for create(): an X server without other clients (Xvfb) resets itself when the last one
// leaves, and refuses whoever comes back in that moment. Initialising again does nothing.
bool display_available() { return glfwInit() == GLFW_TRUE; }

}  // namespace brume
