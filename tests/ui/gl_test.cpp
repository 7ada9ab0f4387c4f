// Our OpenGL loader, framebuffer and ImGui renderer, on both ways of having OpenGL without a display.
#include <gtest/gtest.h>
#include <imgui.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "app/gl/framebuffer.h"
#include "app/gl/texture.h"
#include "app/headless/offscreen_context.h"
#include "app/ui/property_row.h"
#include "app/ui/stage.h"
#include "app/ui/widgets.h"

namespace brume {
namespace {

constexpr OffscreenKind kBoth[] = {OffscreenKind::Osmesa, OffscreenKind::EglSurfaceless};

using Pixels = std::vector<std::uint8_t>;

std::vector<int> pixel_at(const Pixels& pixels, int width, int x, int y) {
  const auto* p = &pixels[static_cast<size_t>((y * width + x) * 4)];
  return {p[0], p[1], p[2], p[3]};
}

// A page with text, curves and clipping: everything the renderer has to get right.
struct Panel {
  double density = 0.7, g = 0.3;
  Vec3d position{0, 1, 2};
  Color color{4, 2, 1};
  bool on = true;

  void draw() {
    ImGui::SetNextWindowPos({20, 20});
    ImGui::SetNextWindowSize({360, 250});
    ui::begin_window("Panel", nullptr, ImGuiWindowFlags_NoResize);
    ui::collapsing_header("Volume");
    ui::PropertyRow density_row("Density", {.modified = true});
    ui::slider_float(density_row.id(), density, {.max = 2});
    EXPECT_FALSE(density_row.finish());
    ui::PropertyRow g_row("g");
    ui::slider_float(g_row.id(), g, {.min = -1});
    EXPECT_FALSE(g_row.finish());
    ui::drag_vec3("##position", position);
    ui::color_edit("##color", color);
    ui::checkbox("on", on);
    ImGui::GetWindowDrawList()->AddCircle({320, 230}, 17.3f, IM_COL32(255, 140, 30, 200), 0, 2.5f);
    ImGui::TextUnformatted("clipped by the edge of the window, since this line is far too long for it");
    ui::end_window();
  }
};

Pixels picture_of_panel(OffscreenKind kind) {
  Result<std::unique_ptr<Stage>> stage = Stage::create({.width = 400, .height = 300, .kind = kind});
  EXPECT_TRUE(stage.ok()) << stage.error().message;
  Panel panel;
  for (int i = 0; i < 3; ++i) (*stage)->frame([&](const Gl&) { panel.draw(); });
  return (*stage)->pixels();
}

// Stands for a driver without one of the functions we need.
void* loader_without_draw_arrays(const char* name) {
  static char stub = 0;
  return std::strcmp(name, "glDrawArrays") == 0 ? nullptr : &stub;
}

TEST(Gl, LoaderFindsEveryFunctionOnBothContexts) {
  for (const OffscreenKind kind : kBoth) {
    const Result<std::unique_ptr<OffscreenContext>> context = create_offscreen_context(kind);
    ASSERT_TRUE(context.ok()) << context.error().message;
    const Result<Gl> gl = load_gl((*context)->loader());
    ASSERT_TRUE(gl.ok()) << (*context)->name() << ": " << gl.error().message;
    EXPECT_NE(describe(*gl).find("Mesa"), std::string::npos) << describe(*gl);
  }
}

TEST(Gl, LoaderNamesTheMissingFunction) {
  const Result<Gl> gl = load_gl(loader_without_draw_arrays);
  ASSERT_FALSE(gl.ok());
  EXPECT_NE(gl.error().message.find("glDrawArrays"), std::string::npos) << gl.error().message;
}

TEST(Gl, AnyContextIsFound) {
  const Result<std::unique_ptr<OffscreenContext>> context = create_offscreen_context(OffscreenKind::Any);
  ASSERT_TRUE(context.ok()) << context.error().message;
}

TEST(Framebuffer, ReadsBackTheClearColourOnBothContexts) {
  for (const OffscreenKind kind : kBoth) {
    const Result<std::unique_ptr<OffscreenContext>> context = create_offscreen_context(kind);
    ASSERT_TRUE(context.ok()) << context.error().message;
    const Result<Gl> gl = load_gl((*context)->loader());
    ASSERT_TRUE(gl.ok()) << gl.error().message;
    const auto framebuffer = Framebuffer::create(*gl, 8, 4);
    ASSERT_TRUE(framebuffer.ok()) << framebuffer.error().message;
    (*framebuffer)->bind();
    gl->ClearColor(1.0f, 0.5f, 0.25f, 1.0f);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    // GL counts from the bottom: the box covers the two upper rows.
    gl->Enable(GL_SCISSOR_TEST);
    gl->Scissor(0, 2, 8, 2);
    gl->ClearColor(0, 0, 1, 1);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    const Pixels pixels = (*framebuffer)->read_pixels();
    ASSERT_EQ(pixels.size(), 8u * 4 * 4);
    EXPECT_EQ(pixel_at(pixels, 8, 3, 0), (std::vector<int>{0, 0, 255, 255})) << (*context)->name();
    EXPECT_EQ(pixel_at(pixels, 8, 3, 3), (std::vector<int>{255, 128, 64, 255})) << (*context)->name();
  }
}

TEST(Framebuffer, RefusesAnImpossibleSize) {
  const auto context = create_offscreen_context(OffscreenKind::Any);
  ASSERT_TRUE(context.ok());
  const Result<Gl> gl = load_gl((*context)->loader());
  ASSERT_TRUE(gl.ok());
  EXPECT_FALSE(Framebuffer::create(*gl, 0, 4).ok());
  EXPECT_FALSE(Framebuffer::create(*gl, 10'000'000, 4).ok());
}

TEST(ImguiRenderer, PictureIsTheSameOnBothContexts) {
  const Pixels osmesa = picture_of_panel(OffscreenKind::Osmesa), egl = picture_of_panel(OffscreenKind::EglSurfaceless);
  EXPECT_TRUE(osmesa == egl);
}

TEST(ImguiRenderer, PictureIsTheSameOverThreeRuns) {
  const Pixels first = picture_of_panel(OffscreenKind::Any);
  EXPECT_TRUE(first == picture_of_panel(OffscreenKind::Any));
  EXPECT_TRUE(first == picture_of_panel(OffscreenKind::Any));
}

TEST(ImguiRenderer, PictureOfAPanelIsNotEmpty) {
  const Pixels pixels = picture_of_panel(OffscreenKind::Any);
  EXPECT_NE(pixel_at(pixels, 400, 200, 100), pixel_at(pixels, 400, 5, 5));
  for (size_t i = 3; i < pixels.size(); i += 4) ASSERT_EQ(pixels[i], 255) << "opaque everywhere";
}

TEST(Stage, SeveralOfBothKindsTakeTurns) {
  // Mesa's OSMesa and EGL share a dispatch table; a stage that did not switch properly would draw into another's
  // picture.
  std::vector<std::unique_ptr<Stage>> stages;
  for (const OffscreenKind kind : {OffscreenKind::EglSurfaceless, OffscreenKind::Osmesa, OffscreenKind::Osmesa}) {
    auto stage = Stage::create({.width = 400, .height = 300, .kind = kind});
    ASSERT_TRUE(stage.ok()) << stage.error().message;
    stages.push_back(std::move(stage).value());
  }
  std::vector<Panel> panels(stages.size());
  for (int round = 0; round < 3; ++round)
    for (size_t i = 0; i < stages.size(); ++i) stages[i]->frame([&](const Gl&) { panels[i].draw(); });
  const Pixels expected = picture_of_panel(OffscreenKind::Any);
  for (const auto& stage : stages) EXPECT_TRUE(stage->pixels() == expected) << stage->context_name();
}

TEST(Texture, ShowsItsPixelsUprightAndFollowsAChangeOfSize) {
  for (const OffscreenKind kind : kBoth) {
    auto stage = Stage::create({.width = 64, .height = 64, .kind = kind});
    ASSERT_TRUE(stage.ok()) << stage.error().message;
    Texture texture((*stage)->gl(), TextureFilter::Nearest);
    const auto draw = [&](const Gl&) { ImGui::GetBackgroundDrawList()->AddImage(texture.id(), {0, 0}, {64, 64}); };

    const Pixels column = {255, 0, 0, 255, 0, 0, 255, 255};  // red above blue
    ASSERT_TRUE(texture.upload(1, 2, column).ok());
    (*stage)->frame(draw);
    EXPECT_EQ(pixel_at((*stage)->pixels(), 64, 32, 10), (std::vector<int>{255, 0, 0, 255}));
    EXPECT_EQ(pixel_at((*stage)->pixels(), 64, 32, 50), (std::vector<int>{0, 0, 255, 255}));

    const Pixels row = {0, 255, 0, 255, 10, 20, 30, 255, 255, 255, 255, 255, 0, 0, 0, 255};
    const ImTextureID id = texture.id();
    ASSERT_TRUE(texture.upload(4, 1, row).ok());
    EXPECT_EQ(texture.id(), id);
    (*stage)->frame(draw);
    EXPECT_EQ(pixel_at((*stage)->pixels(), 64, 24, 32), (std::vector<int>{10, 20, 30, 255}));

    ASSERT_TRUE(texture.upload(1, 2, column).ok());
    texture.set_filter(TextureFilter::Linear);
    (*stage)->frame(draw);
    const std::vector<int> middle = pixel_at((*stage)->pixels(), 64, 32, 32);
    EXPECT_GT(middle[0], 100);
    EXPECT_GT(middle[2], 100);
  }
}

}  // namespace
}  // namespace brume
