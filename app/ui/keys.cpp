#include "app/ui/keys.h"

#include <utility>

namespace brume::ui {

namespace {

constexpr bool between(Key key, Key first, Key last) { return key >= first && key <= last; }
constexpr int offset(Key key, Key first) { return static_cast<int>(key) - static_cast<int>(first); }

#if IMGUI_VERSION_NUM >= 18700
ImGuiKey imgui_key(Key key) {
  if (between(key, Key::A, Key::Z)) return static_cast<ImGuiKey>(ImGuiKey_A + offset(key, Key::A));
  if (between(key, Key::Num0, Key::Num9)) return static_cast<ImGuiKey>(ImGuiKey_0 + offset(key, Key::Num0));
  if (between(key, Key::F1, Key::F12)) return static_cast<ImGuiKey>(ImGuiKey_F1 + offset(key, Key::F1));
  switch (key) {
    case Key::Space:
      return ImGuiKey_Space;
    case Key::Comma:
      return ImGuiKey_Comma;
    case Key::Minus:
      return ImGuiKey_Minus;
    case Key::Period:
      return ImGuiKey_Period;
    case Key::Slash:
      return ImGuiKey_Slash;
    case Key::Equal:
      return ImGuiKey_Equal;
    case Key::LeftBracket:
      return ImGuiKey_LeftBracket;
    case Key::RightBracket:
      return ImGuiKey_RightBracket;
    case Key::Escape:
      return ImGuiKey_Escape;
    case Key::Enter:
      return ImGuiKey_Enter;
    case Key::Tab:
      return ImGuiKey_Tab;
    case Key::Backspace:
      return ImGuiKey_Backspace;
    case Key::Insert:
      return ImGuiKey_Insert;
    case Key::Delete:
      return ImGuiKey_Delete;
    case Key::Right:
      return ImGuiKey_RightArrow;
    case Key::Left:
      return ImGuiKey_LeftArrow;
    case Key::Down:
      return ImGuiKey_DownArrow;
    case Key::Up:
      return ImGuiKey_UpArrow;
    case Key::PageUp:
      return ImGuiKey_PageUp;
    case Key::PageDown:
      return ImGuiKey_PageDown;
    case Key::Home:
      return ImGuiKey_Home;
    case Key::End:
      return ImGuiKey_End;
    case Key::KeypadEnter:
      return ImGuiKey_KeypadEnter;
    default:
      return ImGuiKey_None;
  }
}
#else
int imgui_key(Key key) { return static_cast<int>(key); }
#endif

}  // namespace

bool shortcut(Key key, Mods mods, bool repeat) {
  const ImGuiIO& io = ImGui::GetIO();
  return !io.WantTextInput && io.KeyCtrl == mods.ctrl && io.KeyShift == mods.shift && io.KeyAlt == mods.alt &&
         ImGui::IsKeyPressed(imgui_key(key), repeat);
}

bool key_went_down(Key key) { return ImGui::IsKeyPressed(imgui_key(key), false); }

bool key_held(Key key) { return !ImGui::GetIO().WantTextInput && ImGui::IsKeyDown(imgui_key(key)); }

bool typed(char character) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput) return false;
  for (const ImWchar queued : io.InputQueueCharacters)
    if (queued == static_cast<ImWchar>(character)) return true;
  return false;
}

#if IMGUI_VERSION_NUM >= 18700

void teach_keys(ImGuiIO&) {}

void feed_key(ImGuiIO& io, Key key, bool down) { io.AddKeyEvent(imgui_key(key), down); }

void feed_mods(ImGuiIO& io, Mods mods) {
#if IMGUI_VERSION_NUM >= 18900
  io.AddKeyEvent(ImGuiMod_Ctrl, mods.ctrl);
  io.AddKeyEvent(ImGuiMod_Shift, mods.shift);
  io.AddKeyEvent(ImGuiMod_Alt, mods.alt);
#else
  io.AddKeyEvent(ImGuiKey_ModCtrl, mods.ctrl);
  io.AddKeyEvent(ImGuiKey_ModShift, mods.shift);
  io.AddKeyEvent(ImGuiKey_ModAlt, mods.alt);
#endif
}

#else

void teach_keys(ImGuiIO& io) {
  const std::pair<ImGuiKey, Key> known[] = {{ImGuiKey_Tab, Key::Tab},
                                            {ImGuiKey_LeftArrow, Key::Left},
                                            {ImGuiKey_RightArrow, Key::Right},
                                            {ImGuiKey_UpArrow, Key::Up},
                                            {ImGuiKey_DownArrow, Key::Down},
                                            {ImGuiKey_PageUp, Key::PageUp},
                                            {ImGuiKey_PageDown, Key::PageDown},
                                            {ImGuiKey_Home, Key::Home},
                                            {ImGuiKey_End, Key::End},
                                            {ImGuiKey_Insert, Key::Insert},
                                            {ImGuiKey_Delete, Key::Delete},
                                            {ImGuiKey_Backspace, Key::Backspace},
                                            {ImGuiKey_Space, Key::Space},
                                            {ImGuiKey_Enter, Key::Enter},
                                            {ImGuiKey_Escape, Key::Escape},
                                            {ImGuiKey_KeyPadEnter, Key::KeypadEnter},
                                            {ImGuiKey_A, Key::A},
                                            {ImGuiKey_C, Key::C},
                                            {ImGuiKey_V, Key::V},
                                            {ImGuiKey_X, Key::X},
                                            {ImGuiKey_Y, Key::Y},
                                            {ImGuiKey_Z, Key::Z}};
  for (const auto& [key, number] : known) io.KeyMap[key] = static_cast<int>(number);
}

void feed_key(ImGuiIO& io, Key key, bool down) { io.KeysDown[static_cast<int>(key)] = down; }

void feed_mods(ImGuiIO& io, Mods mods) {
  io.KeyCtrl = mods.ctrl;
  io.KeyShift = mods.shift;
  io.KeyAlt = mods.alt;
}

#endif

}  // namespace brume::ui
