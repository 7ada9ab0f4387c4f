#include "app/ui/theme.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

namespace brume::ui {

namespace {

constexpr float kFontSize = 15;  // pixels at scale 1

// Latin-1 with °, ², ³, µ, ·, ×; Greek for σ, τ, λ; punctuation; sub- and superscripts; arrows; mathematics (≈ ≠ ≤ ≥ √
// ∞); ✓ and ✗. Pairs of first and last, ended by 0.
constexpr ImWchar kRanges[] = {0x0020, 0x00FF, 0x0370, 0x03FF, 0x2010, 0x2027, 0x2070, 0x209C,
                               0x2190, 0x21BB, 0x2200, 0x22C5, 0x2713, 0x2717, 0};

ImVec4 grey(float value, float alpha = 1) { return {value, value, value, alpha}; }
ImVec4 with_alpha(ImVec4 color, float alpha) { return {color.x, color.y, color.z, alpha}; }

// The whole file when it looks like a font: ImGui stops the program over anything else.
std::vector<char> read_font(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  constexpr size_t kSmallestFont = 1024;
  const bool is_font = bytes.size() > kSmallestFont &&
                       (std::memcmp(bytes.data(), "\0\1\0\0", 4) == 0 || std::memcmp(bytes.data(), "true", 4) == 0);
  if (!is_font) bytes.clear();
  return bytes;
}

void add_font(ImFontAtlas& atlas, const std::vector<char>& bytes, float pixels, bool merge) {
  // The atlas frees what it is given with ImGui's allocator.
  void* owned = ImGui::MemAlloc(bytes.size());
  std::memcpy(owned, bytes.data(), bytes.size());
  ImFontConfig config;
  config.MergeMode = merge;
  config.OversampleH = 3;  // small text keeps its spacing
  config.OversampleV = 1;
  config.PixelSnapH = false;
  config.RasterizerMultiply = 1.15f;  // light text on dark looks thin otherwise
  atlas.AddFontFromMemoryTTF(owned, static_cast<int>(bytes.size()), pixels, &config, kRanges);
}

}  // namespace

ImVec4 theme_background() { return grey(0.085f); }

ImVec4 theme_accent() { return {0.33f, 0.56f, 0.80f, 1}; }

void apply_theme(float scale) {
  ImGuiStyle style;
  style.WindowPadding = {12, 10};
  style.FramePadding = {8, 4};
  style.CellPadding = {6, 3};
  style.ItemSpacing = {8, 6};
  style.ItemInnerSpacing = {7, 5};
  style.IndentSpacing = 16;
  style.ScrollbarSize = 11;
  style.GrabMinSize = 10;
  style.WindowRounding = 4;
  style.ChildRounding = 3;
  style.FrameRounding = 3;
  style.PopupRounding = 4;
  style.ScrollbarRounding = 6;
  style.GrabRounding = 3;
  style.TabRounding = 3;
  style.WindowBorderSize = 1;
  style.PopupBorderSize = 1;
  style.FrameBorderSize = 0;
  style.WindowTitleAlign = {0.0f, 0.5f};
  style.WindowMenuButtonPosition = ImGuiDir_None;
  style.DisabledAlpha = 0.42f;
  // Borders stay one pixel at every scale.
  style.ScaleAllSizes(scale);
  style.WindowBorderSize = style.PopupBorderSize = style.ChildBorderSize = 1;

  const ImVec4 accent = theme_accent();
  const ImVec4 fill(0.20f, 0.34f, 0.48f, 1);  // the accent, dark enough for text on it
  const ImVec4 clear(0, 0, 0, 0);
  const std::pair<ImGuiCol, ImVec4> colors[] = {
      {ImGuiCol_Text, grey(0.88f)},
      {ImGuiCol_TextDisabled, grey(0.60f)},
      {ImGuiCol_TextSelectedBg, with_alpha(accent, 0.45f)},
      {ImGuiCol_WindowBg, grey(0.145f)},
      {ImGuiCol_ChildBg, clear},
      {ImGuiCol_PopupBg, grey(0.115f)},
      {ImGuiCol_Border, grey(0.055f)},
      {ImGuiCol_BorderShadow, clear},
      {ImGuiCol_FrameBg, grey(0.225f)},
      {ImGuiCol_FrameBgHovered, grey(0.275f)},
      {ImGuiCol_FrameBgActive, grey(0.30f)},
      {ImGuiCol_TitleBg, grey(0.11f)},
      {ImGuiCol_TitleBgActive, grey(0.11f)},
      {ImGuiCol_TitleBgCollapsed, grey(0.11f)},
      {ImGuiCol_MenuBarBg, grey(0.11f)},
      {ImGuiCol_ScrollbarBg, clear},
      {ImGuiCol_ScrollbarGrab, grey(0.30f)},
      {ImGuiCol_ScrollbarGrabHovered, grey(0.38f)},
      {ImGuiCol_ScrollbarGrabActive, grey(0.45f)},
      {ImGuiCol_CheckMark, ImVec4(0.50f, 0.74f, 0.98f, 1)},
      {ImGuiCol_SliderGrab, fill},
      {ImGuiCol_SliderGrabActive, accent},
      {ImGuiCol_Button, grey(0.27f)},
      {ImGuiCol_ButtonHovered, grey(0.33f)},
      {ImGuiCol_ButtonActive, fill},
      {ImGuiCol_Header, fill},
      {ImGuiCol_HeaderHovered, grey(0.26f)},
      {ImGuiCol_HeaderActive, fill},
      {ImGuiCol_Separator, grey(0.22f)},
      {ImGuiCol_SeparatorHovered, with_alpha(accent, 0.6f)},
      {ImGuiCol_SeparatorActive, accent},
      {ImGuiCol_ResizeGrip, clear},
      {ImGuiCol_ResizeGripHovered, with_alpha(accent, 0.5f)},
      {ImGuiCol_ResizeGripActive, accent},
      {ImGuiCol_Tab, grey(0.145f)},
      {ImGuiCol_TabHovered, grey(0.27f)},
      {ImGuiCol_TabActive, grey(0.23f)},
      {ImGuiCol_TabUnfocused, grey(0.145f)},
      {ImGuiCol_TabUnfocusedActive, grey(0.20f)},
      {ImGuiCol_PlotLines, accent},
      {ImGuiCol_PlotHistogram, accent},
      {ImGuiCol_TableHeaderBg, grey(0.195f)},
      {ImGuiCol_TableBorderStrong, grey(0.10f)},
      {ImGuiCol_TableBorderLight, grey(0.19f)},
      {ImGuiCol_TableRowBg, clear},
      {ImGuiCol_TableRowBgAlt, grey(1, 0.02f)},
      {ImGuiCol_DragDropTarget, accent},
      {ImGuiCol_NavHighlight, accent},
      {ImGuiCol_ModalWindowDimBg, grey(0, 0.4f)},
  };
  for (const auto& [index, color] : colors) style.Colors[index] = color;
  ImGui::GetStyle() = style;
}

std::string load_fonts(float scale, std::span<const std::string> candidates, float density) {
  std::vector<std::string> paths(candidates.begin(), candidates.end());
  paths.emplace_back("/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf");
  paths.emplace_back("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf");

  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  io.FontGlobalScale = 1 / density;
  const float pixels = std::round(kFontSize * scale * density);
  std::string taken;
  for (const std::string& path : paths) {
    const std::vector<char> bytes = read_font(path);
    if (bytes.empty()) continue;
    add_font(*io.Fonts, bytes, pixels, !taken.empty());
    if (taken.empty()) taken = path;
  }
  if (taken.empty()) {
    ImFontConfig config;
    config.SizePixels = std::round(13 * scale * density);  // 13: the size its pixels were drawn for
    io.Fonts->AddFontDefault(&config);
  }
  io.Fonts->Build();
  return taken;
}

bool font_has(ImWchar character) { return ImGui::GetFont()->FindGlyphNoFallback(character) != nullptr; }

}  // namespace brume::ui
