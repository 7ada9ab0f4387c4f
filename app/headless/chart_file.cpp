#include "app/headless/chart_file.h"

#include <imgui.h>

#include <cmath>
#include <thread>

#include "app/panels/chart_view.h"
#include "app/ui/stage.h"
#include "app/ui/ui_fonts.h"
#include "renderer/analysis/chart_svg.h"
#include "renderer/core/atomic_file.h"
#include "renderer/core/input_file.h"
#include "renderer/experiments/sweep_chart.h"
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

Result<void> write_chart_png(const std::string& path, const Drawing& drawing) {
  // An OpenGL context is current in one thread: that of a window must stay it. ImGui's is the same in all.
  ImGuiContext* const before = ImGui::GetCurrentContext();
  Result<Image8> image = Image8();
  std::jthread([&] { image = draw(drawing); }).join();
  ImGui::SetCurrentContext(before);
  if (!image) return image.error();
  return write_png(path, *image);
}

}  // namespace

Result<void> write_chart(const std::string& path, const Drawing& drawing, const Sweep& sweep) {
  const std::string kind = lower_case_extension(path);
  if (kind == ".svg") return write_text_atomically(path, to_svg(drawing));
  if (kind == ".png") return write_chart_png(path, drawing);
  if (kind == ".csv") return write_text_atomically(path, csv_of(sweep));
  return bad_input("found the extension \"" + kind + "\", expected .svg, .png or .csv", {path, 0, 0, ""});
}

}  // namespace brume
