#include "app/headless/chart_png.h"

#include <imgui.h>

#include <cmath>
#include <thread>

#include "app/panels/chart_view.h"
#include "app/ui/stage.h"
#include "app/ui/ui_fonts.h"
#include "renderer/film/image_io.h"

namespace brume {

namespace {

Result<Image8> draw(const Drawing& drawing) {
  auto stage = Stage::create({.width = static_cast<int>(std::ceil(drawing.width)),
                              .height = static_cast<int>(std::ceil(drawing.height)),
                              .font_paths = ui_font_paths()});
  if (!stage) return stage.error();
  (*stage)->frame([&](const Gl&) { draw_chart(drawing, *ImGui::GetForegroundDrawList(), {0, 0}); });
  Image8 image((*stage)->width(), (*stage)->height(), 4);
  image.bytes = (*stage)->pixels();
  return image;
}

}  // namespace

Result<void> write_chart_png(const std::string& path, const Drawing& drawing) {
  // An OpenGL context is current in one thread: that of a window must stay it. ImGui's is the same in all.
  ImGuiContext* const before = ImGui::GetCurrentContext();
  Result<Image8> image = Image8();
  std::jthread([&] { image = draw(drawing); }).join();
  ImGui::SetCurrentContext(before);
  if (!image) return image.error();
  return write_png(path, *image);
}

}  // namespace brume
