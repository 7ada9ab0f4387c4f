#include "app/panels/chart_panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/headless/chart_file.h"
#include "app/panels/chart_view.h"
#include "app/ui/formatted.h"
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

std::shared_ptr<const Sweep> ChartPanel::sweep(const Session& session) const {
  return shows_search(session) ? session.search().found() : session.errors();
}

Chart ChartPanel::chart(const Sweep& sweep, const Session& session, bool measured) const {
  const SweepAxis& y = *find_sweep_axis(error_);
  if (measured && shows_search(session)) {
    Chart chart = pareto_chart(sweep, y);
    chart.subtitle = session.title() + ". " + std::to_string(sweep.variants.size()) +
                     " settings on a small picture, each after 1, 2, 3, 4, 6, 8, ... samples.";
    return chart;
  }
  Chart chart = chart_of(sweep, *find_sweep_axis("cpu_seconds"), y, "");
  chart.subtitle = session.title() + ". " + reference_text(session, measured);
  if (front_) add_front(sweep, y, {}, chart);
  return chart;
}

void ChartPanel::draw_search(Session& session) {
  if (const auto progress = session.search().progress()) {
    if (ui::button("Stop")) session.search().cancel();
    ui::tooltip_on_hover("Gives the search up");
    ImGui::SameLine();
    ImGui::TextDisabled("%s", formatted("%.0f %%  ", 100 * progress->done).append(progress->what).c_str());
    return;
  }
  if (ui::button("Search...")) {
    session.search_settings();
    searched_ = true;
  }
  ui::tooltip_on_hover(
      "Measures all methods, several steps and light samples on a small picture of this scene, which takes about half "
      "a minute, and shows what is cheapest for its error");
  if (!session.search().problem().empty()) {
    ImGui::SameLine();
    ImGui::TextDisabled("%s", session.search().problem().c_str());
  }
  if (!session.search().found()) return;
  ImGui::SameLine();
  ui::checkbox("Found", searched_);
  ui::tooltip_on_hover("Shows what the search has found, instead of what is rendered now");
}

bool ChartPanel::draw(Session& session, bool measured) {
  const float em = ImGui::GetFontSize();
  std::vector<std::string> labels;
  int index = 0;
  for (const char* key : kErrors) {
    if (error_ == key) index = static_cast<int>(labels.size());
    labels.push_back(find_sweep_axis(key)->label);
  }
  ImGui::SetNextItemWidth(std::min(14 * em, 0.3f * ImGui::GetContentRegionAvail().x));
  if (ui::combo("##error", index, labels)) error_ = kErrors[index];
  ui::tooltip_on_hover("What is charted. Net RMSE is the RMSE with the noise of the reference taken out.");
  ImGui::SameLine();
  if (!shows_search(session)) {
    ui::checkbox("Cheapest", front_);
    ui::tooltip_on_hover(
        "Marks what is cheapest for its error, and the best: the cheapest within a tenth of the least.");
    ImGui::SameLine();
  }
  const auto seen = sweep(session);
  const bool chooses = front_ || shows_search(session);
  const auto best = chooses ? best_row(*seen, *find_sweep_axis(error_), {}) : std::nullopt;
  if (best) {
    if (ui::button("Apply best")) session.apply(seen->variants[seen->rows[*best].variant]);
    ui::tooltip_on_hover("Gives the scene the settings of the best variant");
    ImGui::SameLine();
  }
  const bool wants_export = ui::button("Export...");
  ui::tooltip_on_hover("Writes the chart as it is seen (.svg, .png), or its numbers (.csv)");
  ImGui::SameLine();
  draw_search(session);

  const ImVec2 room = ImGui::GetContentRegionAvail();
  width_ = room.x, height_ = room.y, font_ = em * 0.918f;
  chart_view("chart", measured ? chart(*seen, session, true) : chart({}, session, false), room);
  return wants_export;
}

Result<void> ChartPanel::write(const Session& session, const std::string& path) const {
  const auto seen = sweep(session);
  return write_chart(path, lay_out(chart(*seen, session, true), {width_, height_, font_, Ground::Dark}).drawing, *seen);
}

}  // namespace brume
