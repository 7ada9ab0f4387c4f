#include "app/panels/chart_panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/headless/chart_file.h"
#include "app/panels/chart_view.h"
#include "app/ui/widgets.h"
#include "renderer/analysis/chart_layout.h"
#include "renderer/experiments/sweep_chart.h"

namespace brume {
namespace {

constexpr const char* kErrors[] = {"rmse_net", "rmse", "relative_mse", "relative_mean_bias", "median_of_tiles"};

std::string reference_text(const Session& session, bool measured) {
  const Truth& truth = session.truth();
  if (!truth.problem().empty()) return truth.problem();
  if (!truth.reference()) return "The reference is being rendered...";
  if (truth.given()) return "Against the picture that the scene names.";
  if (!measured) return "Against a reference that is being rendered.";
  const Reference& r = *truth.reference();
  const double share = r.cpu_seconds / session.description().child("compare").number("reference_time");
  char text[160];
  std::snprintf(text, sizeof text,
                truth.job() ? "Reference: %d spp, error %.2g, %.0f %% done" : "Reference: %d spp, error %.2g",
                r.samples_per_pixel, std::sqrt(r.variance), 100 * std::min(share, 1.0));
  return text;
}

}  // namespace

Chart ChartPanel::chart(const Sweep& sweep, const Session& session, bool measured) const {
  const SweepAxis& y = *find_sweep_axis(error_);
  Chart chart = chart_of(sweep, *find_sweep_axis("cpu_seconds"), y, "");
  chart.subtitle = session.title() + ". " + reference_text(session, measured);
  if (front_) add_front(sweep, y, {}, chart);
  return chart;
}

bool ChartPanel::draw(Session& session, bool measured) {
  const auto sweep = session.errors();
  const float em = ImGui::GetFontSize();
  std::vector<std::string> labels;
  int index = 0;
  for (const char* key : kErrors) {
    if (error_ == key) index = static_cast<int>(labels.size());
    labels.push_back(find_sweep_axis(key)->label);
  }
  ImGui::SetNextItemWidth(std::min(17 * em, 0.35f * ImGui::GetContentRegionAvail().x));
  if (ui::combo("##error", index, labels)) error_ = kErrors[index];
  ui::tooltip_on_hover("What is charted. Net RMSE is the RMSE with the noise of the reference taken out.");
  ImGui::SameLine();
  ui::checkbox("Cheapest", front_);
  ui::tooltip_on_hover("Marks what is cheapest for its error, and the best: the cheapest within a tenth of the least.");
  ImGui::SameLine();
  const auto best = front_ ? best_row(*sweep, *find_sweep_axis(error_), {}) : std::nullopt;
  if (best && ui::button("Apply best")) {
    const Node settings = sweep->variants[sweep->rows[*best].variant].description;
    session.change([&](Node& d) { d = with_variants_of(settings, d); });
    session.close_step();
  }
  if (best) {
    ui::tooltip_on_hover("Gives the scene the settings of the best variant");
    ImGui::SameLine();
  }
  const bool wants_export = ui::button("Export...");
  ui::tooltip_on_hover("Writes the chart as it is seen (.svg, .png), or its numbers (.csv)");

  const ImVec2 room = ImGui::GetContentRegionAvail();
  width_ = room.x, height_ = room.y, font_ = em * 0.918f;
  chart_view("chart", measured ? chart(*sweep, session, true) : chart({}, session, false), room);
  return wants_export;
}

Result<void> ChartPanel::write(const Session& session, const std::string& path) const {
  const auto sweep = session.errors();
  return write_chart(path, lay_out(chart(*sweep, session, true), {width_, height_, font_, Ground::Dark}).drawing,
                     *sweep);
}

}  // namespace brume
