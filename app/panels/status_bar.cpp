#include "app/panels/status_bar.h"

#include <imgui.h>

#include "app/panels/picture_labels.h"
#include "app/ui/formatted.h"
#include "app/ui/widgets.h"

namespace brume {
namespace {

void item(const std::string& text, const std::string& help, bool alarm = false) {
  if (alarm)
    ImGui::TextColored({1.0f, 0.45f, 0.4f, 1}, "%s", text.c_str());
  else
    ImGui::TextUnformatted(text.c_str());
  ui::tooltip_on_hover(help);
  ImGui::SameLine(0, ImGui::GetFontSize() * 1.4f);
}

}  // namespace

void draw_status_bar(const Session& session, bool measured) {
  const auto picture = session.picture();
  const auto scene = session.scene();
  if (!picture || !scene) {
    item("no picture yet", "Open a scene or drop a .vdb file on the window.");
    return;
  }
  const RenderStatistics& s = picture->statistics;
  item(samples_text(*picture), "Samples per pixel of the picture.");
  const double rays = static_cast<double>(s.rays.rays + s.rays.shadow_rays);
  item(measured ? formatted("%.1f s", s.wall_seconds) : "- s", "Time spent on this picture.");
  item(measured && s.wall_seconds > 0 ? formatted("%.2f Mrays/s", 1e-6 * rays / s.wall_seconds) : "- Mrays/s",
       "Camera, scattered and shadow rays per second.");
  item(picture->preview ? "noise -" : "noise " + formatted("%.2f %%", 100 * picture->noise),
       "Estimated noise of the whole picture, relative to its mean: from a few pixels that are rendered twice.");
  item(measured ? std::to_string(s.threads) + (s.threads == 1 ? " thread" : " threads") : "- threads",
       "Threads that render.");
  item("pool " + formatted("%.1f KB", static_cast<double>(s.pool_high_water_bytes) / 1024),
       "High-water mark of a thread's stack pool, in which a ray's temporary arrays live.");
  item("needs: " + scene->needs.to_string(), "What the scene makes the renderer model; the rest costs nothing.");
  if (s.rays.non_finite > 0)
    item(std::to_string(s.rays.non_finite) + " samples dropped",
         "Samples that were not finite; the picture is made of the others.", true);
  if (s.rays.march.capped > 0)
    item(std::to_string(s.rays.march.capped) + " rays capped",
         "Rays whose step was raised because they needed too many; raise the step size.", true);
  if (!scene->warnings.empty())
    item(std::to_string(scene->warnings.size()) + (scene->warnings.size() == 1 ? " warning" : " warnings"),
         scene->warnings.front(), true);
  if (session.paused())
    item("paused", "Space goes on.");
  else if (picture->finished)
    item("finished", "All samples that were asked for are there.");
}

}  // namespace brume
