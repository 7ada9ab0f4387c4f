// How Brume looks: neutral greys, so that they do not tint the judgement of a picture, and one accent.
#pragma once

#include <imgui.h>

#include <span>
#include <string>

namespace brume::ui {

/// Sets the style of the current ImGui context. `scale` is 1 on a display of about 96 dpi, 2 on one of twice that;
/// it may be called again with another.
void apply_theme(float scale);

/// What to clear the window with.
ImVec4 theme_background();
/// The accent, for selections and marks of our own.
ImVec4 theme_accent();

/// Fills the font atlas of the current ImGui context anew and builds it; upload it afterwards, and not between
/// NewFrame and Render.
/// Takes the first font file of `candidates`, then of the usual places of Debian (Roboto, DejaVu Sans), that can be
/// read; the later ones lend it symbols that it lacks. `density` is pixels per unit of display coordinates (other
/// than 1 only where the window system scales coordinates itself).
/// Returns the file taken; empty when there was none and ImGui's own font had to do.
std::string load_fonts(float scale, std::span<const std::string> candidates, float density = 1);

/// Whether the current font can show this character ("→").
bool font_has(ImWchar character);

}  // namespace brume::ui
