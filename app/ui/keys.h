// Keyboard shortcuts, the same for every ImGui version.
#pragma once

#include <imgui.h>

namespace brume::ui {

/// The numbers are GLFW's: ImGui up to 1.86 knows keys only by the numbers of whoever feeds it, and the packaged
/// window backend feeds GLFW's. Letters and digits are those printed on the user's keyboard.
enum class Key : int {
  Space = 32,
  Comma = 44,
  Minus = 45,
  Period = 46,
  Slash = 47,
  Num0 = 48,
  Num1,
  Num2,
  Num3,
  Num4,
  Num5,
  Num6,
  Num7,
  Num8,
  Num9,
  Equal = 61,
  A = 65,
  B,
  C,
  D,
  E,
  F,
  G,
  H,
  I,
  J,
  K,
  L,
  M,
  N,
  O,
  P,
  Q,
  R,
  S,
  T,
  U,
  V,
  W,
  X,
  Y,
  Z,
  LeftBracket = 91,
  RightBracket = 93,
  Escape = 256,
  Enter,
  Tab,
  Backspace,
  Insert,
  Delete,
  Right,
  Left,
  Down,
  Up,
  PageUp,
  PageDown,
  Home,
  End,
  F1 = 290,
  F2,
  F3,
  F4,
  F5,
  F6,
  F7,
  F8,
  F9,
  F10,
  F11,
  F12,
  KeypadEnter = 335,
};

struct Mods {
  bool ctrl = false, shift = false, alt = false;
};

/// Whether the key went down in this frame with exactly these modifiers, and no text field is taking the keys.
bool shortcut(Key key, Mods mods = {}, bool repeat = false);
/// The same whatever the modifiers, and also while typing text: for what belongs to the typing itself.
bool key_went_down(Key key);
/// Whether the key is held (to show a variant while it is), whatever the modifiers; false while typing text.
bool key_held(Key key);
/// Whether this character came from the keyboard in this frame, and no text field is taking it. For '?' and the like,
/// whose key differs between layouts.
bool typed(char character);

/// Before NewFrame: what a platform backend would do. With 1.86 `teach_keys` has to be called once per ImGui context
/// that has no platform backend.
void teach_keys(ImGuiIO& io);
void feed_key(ImGuiIO& io, Key key, bool down);
void feed_mods(ImGuiIO& io, Mods mods);

}  // namespace brume::ui
