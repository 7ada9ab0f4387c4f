#include "app/panels/picture_labels.h"

#include <algorithm>
#include <cmath>

#include "app/ui/formatted.h"
#include "app/ui/theme.h"
#include "renderer/analysis/chart.h"

namespace brume {
namespace {

constexpr ImU32 kPlate = IM_COL32(24, 24, 26, 225);

/// One line of text on a plate, its upper left corner at (x, y).
void draw_line(float x, float y, const std::string& text, ImU32 color, ImU32 stripe = 0) {
  const float em = ImGui::GetFontSize(), pad = std::floor(0.4f * em);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const float left = stripe != 0 ? std::floor(0.35f * em) : 0;
  draw->AddRectFilled({x, y}, {x + size.x + 2 * pad + left, y + size.y + pad}, kPlate);
  if (stripe != 0) draw->AddRectFilled({x, y}, {x + left, y + size.y + pad}, stripe);
  draw->AddText({x + pad + left, y + std::floor(pad / 2)}, color, text.c_str());
}

ImU32 plain_color() { return ImGui::GetColorU32(ImGuiCol_Text); }

}  // namespace

ImU32 variant_color(std::size_t index) {
  const Rgb c = series_color(index);
  return IM_COL32(c[0], c[1], c[2], 255);
}

float draw_plate(const PictureArea& area, float below_top, const std::string& text, ImU32 color) {
  const float em = ImGui::GetFontSize(), wrap = std::min(area.width() - 4 * em, 40 * em);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  const ImVec2 corner(std::floor(area.min.x + (area.width() - size.x) / 2), std::floor(area.min.y + below_top));
  ImDrawList* draw = ImGui::GetWindowDrawList();
  draw->AddRectFilled({corner.x - em, corner.y - em * 0.6f}, {corner.x + size.x + em, corner.y + size.y + em * 0.6f},
                      kPlate, em * 0.3f);
  draw->AddText(nullptr, 0, corner, color != 0 ? color : plain_color(), text.c_str(), nullptr, wrap);
  return size.y + em * 1.8f;
}

std::string samples_text(const Picture& picture) {
  if (!picture.preview) return std::to_string(picture.statistics.samples_per_pixel) + " spp";
  return picture.divisor > 1 ? "coarse 1/" + std::to_string(picture.divisor) : "preview";
}

void draw_variant_label(const Session& session, std::size_t index, float left, const PictureArea& area) {
  ImGui::GetWindowDrawList()->PushClipRect(area.min, area.max, true);
  draw_line(left, area.min.y, std::to_string(index + 1) + "  " + session.shown()[index].variant.name, plain_color(),
            variant_color(index));
  ImGui::GetWindowDrawList()->PopClipRect();
}

void draw_variant_figures(const Session& session, std::size_t index, const PictureArea& area, bool measured) {
  const auto picture = session.picture(index);
  if (!picture) return;
  const RenderStatistics& s = picture->statistics;
  std::string text = samples_text(*picture);
  const double rays = static_cast<double>(s.rays.rays + s.rays.shadow_rays);
  text += measured ? formatted("   %.2f CPU s", s.cpu_seconds) : "   - CPU s";
  text += measured && s.cpu_seconds > 0 ? formatted("   %.2f Mrays/s", 1e-6 * rays / s.cpu_seconds) : "   - Mrays/s";
  const auto errors = session.errors();
  const auto last = std::find_if(errors->rows.begin(), errors->rows.end(),
                                 [&](const SweepRow& r) { return r.variant == index && r.last; });
  // What is known is better than what is estimated, and there is not room for both.
  if (measured && last != errors->rows.end())
    text += formatted("   RMSE %.2g", last->errors.rmse) +
            formatted("   bias %+.2f %%", 100 * last->errors.relative_mean_bias);
  else if (!picture->preview)
    text += formatted("   noise %.2f %%", 100 * picture->noise);
  ImGui::GetWindowDrawList()->PushClipRect(area.min, area.max, true);
  draw_line(area.min.x, area.max.y - std::floor(1.4f * ImGui::GetFontSize()), text,
            ImGui::GetColorU32(ImGuiCol_TextDisabled));
  ImGui::GetWindowDrawList()->PopClipRect();
}

void draw_difference_legend(const Session& session, const ViewState& view, double range, const PictureArea& area) {
  constexpr const char* kWhat[] = {"minus", "absolute difference from", "relative difference from",
                                   "squared difference from"};
  const auto name = [&](std::size_t i) { return session.shown()[i].variant.name; };
  draw_line(area.min.x, area.min.y,
            name(view.shown) + " " + kWhat[static_cast<int>(view.difference)] + " " +
                (view.against_truth ? "the reference" : name(view.other)),
            plain_color());

  const float em = ImGui::GetFontSize(), width = std::min(16 * em, area.width() - 4 * em),
              height = std::floor(0.8f * em);
  const ImVec2 corner(area.min.x + em, area.max.y - 2.9f * em);
  const bool is_signed = view.difference == DifferenceKind::Signed;
  ImDrawList* draw = ImGui::GetWindowDrawList();
  draw->AddRectFilled({corner.x - em * 0.7f, corner.y - em * 0.6f}, {corner.x + width + em * 0.7f, area.max.y}, kPlate);
  constexpr int kSteps = 64;
  for (int i = 0; i < kSteps; ++i) {
    const double fraction = (i + 0.5) / kSteps;
    const auto c = difference_color(is_signed ? 2 * fraction - 1 : fraction, view.difference);
    const float x = corner.x + width * static_cast<float>(i) / kSteps;
    draw->AddRectFilled({x, corner.y}, {x + width / kSteps + 0.5f, corner.y + height}, IM_COL32(c[0], c[1], c[2], 255));
  }
  const bool percent = view.difference == DifferenceKind::Relative;
  const auto number = [&](double v) { return percent ? formatted("%.4g %%", 100 * v) : formatted("%.4g", v); };
  const std::string low = is_signed ? number(-range) : number(0), high = number(range);
  const float below = corner.y + height + 0.2f * em;
  draw->AddText({corner.x, below}, plain_color(), low.c_str());
  if (is_signed) draw->AddText({corner.x + width / 2 - 0.25f * em, below}, plain_color(), "0");
  draw->AddText({corner.x + width - ImGui::CalcTextSize(high.c_str()).x, below}, plain_color(), high.c_str());
}

void draw_probe_mark(const ViewState& view, const PictureArea& area, bool chosen) {
  if (!view.probing) return;
  const float em = ImGui::GetFontSize(), inner = std::floor(0.35f * em), outer = std::floor(0.9f * em);
  const ImVec2 at = area.to_screen(view, {view.probe_x, view.probe_y});
  ImDrawList* draw = ImGui::GetWindowDrawList();
  draw->PushClipRect(area.min, area.max, true);
  // A dark line under a bright one is seen on every ground.
  const auto cross = [&](ImU32 color, float width) {
    draw->AddLine({at.x - outer, at.y}, {at.x - inner, at.y}, color, width);
    draw->AddLine({at.x + inner, at.y}, {at.x + outer, at.y}, color, width);
    draw->AddLine({at.x, at.y - outer}, {at.x, at.y - inner}, color, width);
    draw->AddLine({at.x, at.y + inner}, {at.x, at.y + outer}, color, width);
  };
  cross(IM_COL32(0, 0, 0, chosen ? 200 : 90), 3);
  cross(IM_COL32(255, 255, 255, chosen ? 255 : 110), 1);
  draw->PopClipRect();
}

void draw_messages(const Session& session, const PictureArea& area) {
  const float em = ImGui::GetFontSize();
  if (!session.problem().empty()) draw_plate(area, 2 * em, session.problem(), IM_COL32(255, 140, 115, 255));
  if (session.paused()) draw_plate(area, area.height() - 4 * em, "Paused: Space goes on");
  if (!session.scene() && session.idle() && session.problem().empty())
    draw_plate(area, area.height() / 2 - em, "Drop a .vdb file or a scene here, or press Ctrl+O.");

  // Progress is for what takes longer than a moment; it would only flicker otherwise.
  const auto activity = session.activity();
  if (!activity || activity->seconds < 0.4) return;
  const float below = area.height() / 2 + 3 * em;
  draw_plate(area, below, activity->what + formatted("  %.0f %%", 100.0 * static_cast<double>(activity->progress)));
  const float bar = 16 * em, left = area.min.x + (area.width() - bar) / 2, top = area.min.y + below;
  ImDrawList* draw = ImGui::GetWindowDrawList();
  draw->AddRectFilled({left, top + 2 * em}, {left + bar, top + 2.3f * em}, IM_COL32(60, 60, 64, 255));
  draw->AddRectFilled({left, top + 2 * em}, {left + bar * activity->progress, top + 2.3f * em},
                      ImGui::GetColorU32(ui::theme_accent()));
}

}  // namespace brume
