#include "app/panels/probe_panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/panels/chart_view.h"
#include "app/ui/formatted.h"
#include "app/ui/widgets.h"

namespace brume {
namespace {

void figure(const char* label, const std::string& value, const char* help) {
  ImGui::TextDisabled("%s", label);
  ui::tooltip_on_hover(help);
  ImGui::SameLine(6.5f * ImGui::GetFontSize());
  ImGui::TextUnformatted(value.c_str());
}

/// One number where the channels agree, else three.
std::string color_text(Color c, const char* format = "%.3g") {
  const auto text = [&](float v) { return formatted(format, static_cast<double>(v)); };
  const std::string r = text(c.r), g = text(c.g), b = text(c.b);
  return r == g && g == b ? r : r + " " + g + " " + b;
}

std::string favoured_text(const PixelProbe& p) {
  const auto share = [](double s, const char* name) {
    return s > 0.0005 ? formatted("%.0f %% ", 100 * s) + name + "  " : std::string();
  };
  const std::string text =
      share(p.density_share, "density") + share(p.equiangular_share, "angle") + share(p.product_share, "product");
  return text.empty() ? "-" : text;
}

void draw_figures(const PixelProbe& p) {
  Color error;
  for (int c = 0; c < 3; ++c) error[c] = p.samples > 1 ? std::sqrt(p.variance[c] / static_cast<float>(p.samples)) : 0;
  figure("Pixel", std::to_string(p.place.x) + ", " + std::to_string(p.place.y), "Column and row, from the top left.");
  figure("Radiance", color_text(p.radiance), "Mean of the samples, W/(sr m^2): red, green, blue.");
  figure("Variance", color_text(p.variance, "%.2g"), "Of one sample.");
  figure("Error at most", color_text(error, "%.2g"),
         "Square root of variance over samples: the standard error if samples were independent. Those of a sequence "
         "err less.");
  figure("Samples",
         std::to_string(p.samples) + (p.non_finite > 0 ? ", " + std::to_string(p.non_finite) + " not finite" : ""),
         "So many were rendered for these figures.");
  figure("Optical depth", color_text(p.optical_depth), "Of the camera rays; what all their light has to pass.");
  figure("Transmittance", color_text(p.transmittance), "Share of the light behind the medium that is seen through it.");
  double thickest = 0;
  for (const double sigma_t : p.profile.sigma_t) thickest = std::max(thickest, sigma_t);
  figure("Max. sigma_t", formatted("%.3g", thickest), "Of the segments on the ray, per world unit.");
  figure("Segments", formatted("%.1f", p.segments), "Mean number in the march of a camera ray.");
  figure("Drawn by", favoured_text(p),
         "Which technique has drawn the distances that the light comes from; under MIS, which one its weights favour.");
}

}  // namespace

void draw_probe_panel(const Session& session, const ViewState& view, bool measured) {
  const auto probe = session.probe();
  const auto scene = session.scene(view.shown);
  const float column = std::floor(15.5f * ImGui::GetFontSize());
  ui::begin_child("figures", {column, 0});
  if (session.shown().size() > 1 && view.shown < session.shown().size())
    ImGui::TextDisabled("%s", session.shown()[view.shown].variant.name.c_str());
  if (probe && measured)
    draw_figures(*probe);
  else
    ImGui::TextWrapped("Click into the picture to probe a pixel.");
  ui::end_child();
  ImGui::SameLine();
  Chart chart = probe && scene && measured ? chart_of(*probe, *scene) : chart_of(PixelProbe{}, Scene{});
  chart_view("along the ray", chart, ImGui::GetContentRegionAvail());
}

}  // namespace brume
