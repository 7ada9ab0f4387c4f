// A mouse and a keyboard made of function calls, the same for every ImGui version.
#pragma once

#include <imgui.h>

#include <string>

#include "app/ui/keys.h"

/// All feed the current ImGui context; what they set counts from the next NewFrame on.
namespace brume::synthetic_input {

void move_mouse(ImVec2 position);
void set_button(ImGuiMouseButton button, bool down);
/// Positive turns away from the user: up, or nearer.
void turn_wheel(float notches);
void set_mods(ui::Mods mods);
void set_key(ui::Key key, bool down);
void type(const std::string& utf8);

}  // namespace brume::synthetic_input
