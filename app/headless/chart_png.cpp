#include "app/headless/chart_png.h"

#include <imgui.h>

#include <cmath>

#include "app/panels/chart_view.h"
#include "app/ui/stage.h"
#include "app/ui/ui_fonts.h"
#include "renderer/film/image_io.h"

namespace brume {

Result<void> write_chart_png(const std::string& path, const Drawing& drawing) {
  auto stage = Stage::create({.width = static_cast<int>(std::ceil(drawing.width)),
                              .height = static_cast<int>(std::ceil(drawing.height)),
                              .font_paths = ui_font_paths()});
  if (!stage) return stage.error();
  (*stage)->frame([&](const Gl&) { draw_chart(drawing, *ImGui::GetForegroundDrawList(), {0, 0}); });
  Image8 image((*stage)->width(), (*stage)->height(), 4);
  image.bytes = (*stage)->pixels();
  return write_png(path, image);
}

}  // namespace brume
