#include "app/panels/viewport.h"

#include <imgui.h>

#include <cmath>

#include "app/session/camera_moves.h"
#include "app/session/display.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"

namespace brume {

void Viewport::upload(const Session& session) {
  const auto picture = session.picture();
  const Node& film = session.description().child("film");
  if (!picture || (picture == uploaded_ && uploaded_film_ == film)) return;
  to_display(picture->image, display_settings(film), 4, display_);
  if (!texture_.upload(display_.width, display_.height, display_.bytes)) return;
  uploaded_ = picture;
  uploaded_film_ = film;
}

void Viewport::handle_mouse(Session& session, float picture_height) {
  const ImGuiIO& io = ImGui::GetIO();
  const double dx = io.MouseDelta.x, dy = io.MouseDelta.y;
  const auto move = [&](const auto& edit) { session.change([&](Node& d) { edit(d.child("camera")); }); };
  if (ImGui::IsItemActive() && (dx != 0 || dy != 0)) {
    constexpr double kRadiansPerPixel = 0.006;
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left))
      move([&](Node& camera) { orbit(camera, dx * kRadiansPerPixel, dy * kRadiansPerPixel); });
    else if (ImGui::IsMouseDown(ImGuiMouseButton_Middle))
      move([&](Node& camera) { pan(camera, -dx / picture_height, dy / picture_height); });
    else if (ImGui::IsMouseDown(ImGuiMouseButton_Right))
      move([&](Node& camera) { dolly(camera, std::exp(0.005 * (dy - dx))); });
  }
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    move([&](Node& camera) { dolly(camera, std::pow(0.9, static_cast<double>(io.MouseWheel))); });
    session.close_step();
  }
  if (ImGui::IsItemDeactivated()) session.close_step();
}

void Viewport::draw_overlays(const Session& session, float x, float y, float width, float height) {
  const float em = ImGui::GetFontSize();
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const auto plate = [&](float top, const std::string& text, ImVec4 color) {
    const float wrap = std::min(width - 4 * em, 40 * em);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
    const ImVec2 corner(std::floor(x + (width - size.x) / 2), std::floor(top));
    draw->AddRectFilled({corner.x - em, corner.y - em * 0.6f}, {corner.x + size.x + em, corner.y + size.y + em * 0.6f},
                        IM_COL32(24, 24, 26, 225), em * 0.3f);
    draw->AddText(nullptr, 0, corner, ImGui::GetColorU32(color), text.c_str(), nullptr, wrap);
    return size.y + em * 1.8f;
  };
  const ImVec4 plain = ImGui::GetStyleColorVec4(ImGuiCol_Text);
  float top = y + height - 4 * em;
  if (!session.problem().empty()) plate(y + em * 2, session.problem(), {1.0f, 0.55f, 0.45f, 1});
  if (!session.black_picture().empty() && session.problem().empty())
    plate(y + height / 2 - em, session.black_picture(), plain);
  if (session.paused()) plate(top, "Paused: Space goes on", plain);

  if (!session.scene() && session.idle() && session.problem().empty())
    plate(y + height / 2 - em, "Drop a .vdb file or a scene here, or press Ctrl+O.", plain);

  // Progress is for what takes longer than a moment; it would only flicker otherwise.
  const auto activity = session.activity();
  if (!activity || activity->seconds < 0.4) return;
  char text[160];
  std::snprintf(text, sizeof text, "%s  %.0f %%", activity->what.c_str(),
                100.0 * static_cast<double>(activity->progress));
  top = y + height / 2 + 3 * em;
  plate(top, text, plain);
  const float bar = 16 * em, left = x + (width - bar) / 2;
  draw->AddRectFilled({left, top + 2 * em}, {left + bar, top + 2.3f * em}, IM_COL32(60, 60, 64, 255));
  draw->AddRectFilled({left, top + 2 * em}, {left + bar * activity->progress, top + 2.3f * em},
                      ImGui::GetColorU32(ui::theme_accent()));
}

void Viewport::draw(Session& session) {
  const ImVec2 room = ImGui::GetContentRegionAvail(), corner = ImGui::GetCursorScreenPos();
  const Numbers& resolution = session.description().child("film").numbers("resolution");
  const float aspect = static_cast<float>(resolution[0] / resolution[1]);
  const float width = std::max(1.0f, std::floor(std::min(room.x, room.y * aspect)));
  const float height = std::max(1.0f, std::floor(std::min(room.y, room.x / aspect)));
  const ImVec2 pixels = ImGui::GetIO().DisplayFramebufferScale;
  session.set_picture_size(static_cast<int>(width * pixels.x), static_cast<int>(height * pixels.y));
  upload(session);

  const float x = std::floor(corner.x + (room.x - width) / 2), y = std::floor(corner.y + (room.y - height) / 2);
  ImGui::SetCursorScreenPos({x, y});
  ui::image("picture", texture_.id(), {width, height});
  handle_mouse(session, height);
  draw_overlays(session, x, y, width, height);
}

}  // namespace brume
