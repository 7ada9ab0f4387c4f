#include "app/headless/synthetic_input.h"

namespace brume::synthetic_input {

// 1.87 brought a queue of events; before, the state itself is written.
#if IMGUI_VERSION_NUM >= 18700

void move_mouse(ImVec2 position) { ImGui::GetIO().AddMousePosEvent(position.x, position.y); }
void set_button(ImGuiMouseButton button, bool down) { ImGui::GetIO().AddMouseButtonEvent(button, down); }
void turn_wheel(float notches) { ImGui::GetIO().AddMouseWheelEvent(0, notches); }

#else

void move_mouse(ImVec2 position) { ImGui::GetIO().MousePos = position; }
void set_button(ImGuiMouseButton button, bool down) { ImGui::GetIO().MouseDown[button] = down; }
void turn_wheel(float notches) { ImGui::GetIO().MouseWheel += notches; }

#endif

void set_mods(ui::Mods mods) { ui::feed_mods(ImGui::GetIO(), mods); }
void set_key(ui::Key key, bool down) { ui::feed_key(ImGui::GetIO(), key, down); }
void type(const std::string& utf8) { ImGui::GetIO().AddInputCharactersUTF8(utf8.c_str()); }

}  // namespace brume::synthetic_input
