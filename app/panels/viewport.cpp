#include "app/panels/viewport.h"

#include <imgui.h>

#include <cmath>

#include "app/panels/picture_labels.h"
#include "app/session/camera_moves.h"
#include "app/session/display.h"
#include "app/ui/widgets.h"

namespace brume {

/// The window's inside, and the proportions of the pictures.
struct Viewport::Room {
  ImVec2 corner, size;
  float aspect;

  /// One of columns x rows pictures, as large as they can be, close together in the middle of the room.
  PictureArea tile(int column, int row, int columns, int rows) const {
    constexpr float kGap = 2;
    const auto c = static_cast<float>(columns), r = static_cast<float>(rows);
    const ImVec2 most((size.x - kGap * (c - 1)) / c, (size.y - kGap * (r - 1)) / r);
    const float width = std::max(1.0f, std::floor(std::min(most.x, most.y * aspect)));
    const float height = std::max(1.0f, std::floor(std::min(most.y, most.x / aspect)));
    const auto place = [&](float begin, float whole, float part, float n, int i) {
      const float margin = (whole - n * part - (n - 1) * kGap) / 2;
      return std::floor(begin + margin + static_cast<float>(i) * (part + kGap));
    };
    const ImVec2 min(place(corner.x, size.x, width, c, column), place(corner.y, size.y, height, r, row));
    return {min, {min.x + width, min.y + height}};
  }
  PictureArea whole() const { return tile(0, 0, 1, 1); }
};

Viewport::Viewport(const Gl& gl) : difference_(gl) {
  for (std::size_t i = 0; i < kMaxVariants; ++i) pictures_.emplace_back(gl);
}

PictureTexture& Viewport::picture(const Session& session, std::size_t variant) {
  pictures_[variant].show(session.picture(variant), display_settings(session.description().child("film")));
  return pictures_[variant];
}

void Viewport::handle_mouse(Session& session, ViewState& view, const PictureArea& area) {
  const ImGuiIO& io = ImGui::GetIO();
  const double dx = io.MouseDelta.x, dy = io.MouseDelta.y;
  const auto move = [&](const auto& edit) { session.change([&](Node& d) { edit(d.child("camera")); }); };
  // A click, whose mouse hardly moves, chooses the pixel that is probed and moves no camera.
  const bool clicks = view.probing && !io.KeyCtrl && io.MouseDragMaxDistanceSqr[0] < 9;
  if (clicks && ImGui::IsItemDeactivated() && io.MouseReleased[0] && !dragging_line_) {
    const ImVec2 place = area.to_picture(view, io.MousePos);
    view.probe_x = std::clamp(place.x, 0.0f, 1.0f), view.probe_y = std::clamp(place.y, 0.0f, 1.0f);
  }
  if (ImGui::IsItemActive() && (dx != 0 || dy != 0) && !dragging_line_ && !clicks) {
    constexpr double kRadiansPerPixel = 0.006;
    const double height = area.height();
    if (io.KeyCtrl) {
      view.center_x -= io.MouseDelta.x / area.width() / view.zoom;
      view.center_y -= io.MouseDelta.y / area.height() / view.zoom;
      view.clamp();
    } else if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
      move([&](Node& camera) { orbit(camera, dx * kRadiansPerPixel, dy * kRadiansPerPixel); });
    } else if (ImGui::IsMouseDown(ImGuiMouseButton_Middle)) {
      move([&](Node& camera) { pan(camera, -dx / height, dy / height); });
    } else if (ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
      move([&](Node& camera) { dolly(camera, std::exp(0.005 * (dy - dx))); });
    }
  }
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    const ImVec2 place = area.to_picture(view, io.MousePos);
    if (io.KeyCtrl) {
      view.zoom_about(place.x, place.y, std::pow(1.25f, io.MouseWheel));
    } else {
      move([&](Node& camera) { dolly(camera, std::pow(0.9, static_cast<double>(io.MouseWheel))); });
      session.close_step();
    }
  }
  if (ImGui::IsItemDeactivated()) session.close_step();
}

void Viewport::draw_single(Session& session, ViewState& view, const PictureArea& area) {
  picture(session, view.shown).draw(area, view);
  if (const auto p = session.picture(view.shown)) draw_pixel_values(p->image, area, view);
  if (session.shown().size() > 1) draw_variant_label(session, view.shown, area.min.x, area);
}

void Viewport::draw_tiles(Session& session, ViewState& view, const Room& room, bool measured) {
  const int n = static_cast<int>(session.shown().size());
  // In whichever way the pictures are largest.
  int columns = 1;
  for (int c = 1; c <= n; ++c)
    if (room.tile(0, 0, c, (n + c - 1) / c).width() > room.tile(0, 0, columns, (n + columns - 1) / columns).width())
      columns = c;
  const int rows = (n + columns - 1) / columns;
  for (int i = 0; i < n; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const PictureArea area = room.tile(i % columns, i / columns, columns, rows);
    ImGui::SetCursorScreenPos(area.min);
    ImGui::PushID(i);  // names may be alike
    ui::canvas(("picture " + session.shown()[index].variant.name).c_str(), {area.width(), area.height()});
    ImGui::PopID();
    handle_mouse(session, view, area);
    picture(session, index).draw(area, view);
    if (const auto p = session.picture(index)) draw_pixel_values(p->image, area, view);
    draw_variant_label(session, index, area.min.x, area);
    draw_variant_figures(session, index, area, measured);
    if (view.probing && ImGui::IsItemDeactivated()) view.shown = index;
    draw_probe_mark(view, area, view.shown == index);
    if (!session.black_picture(index).empty()) draw_plate(area, area.height() / 2, session.black_picture(index));
  }
}

void Viewport::draw_wipe(Session& session, ViewState& view, const PictureArea& area) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  // Only within what is seen: a line beyond the edge could not be taken hold of again.
  if (dragging_line_) view.wipe = area.to_picture(view, {std::clamp(mouse.x, area.min.x, area.max.x), 0}).x;
  const float line = area.to_screen(view, {view.wipe, 0}).x;
  picture(session, view.shown).draw(area, view, area.min.x, line);
  picture(session, view.other).draw(area, view, line, area.max.x);
  draw_variant_label(session, view.shown, area.min.x, area);
  draw_variant_label(session, view.other, std::max(line, area.min.x), area);
  if (line < area.min.x - 0.5f || line > area.max.x + 0.5f) return;  // at the edge, but for rounding, it is seen
  const float grip = std::floor(0.5f * ImGui::GetFontSize());
  ImDrawList* draw = ImGui::GetWindowDrawList();
  draw->AddLine({line, area.min.y}, {line, area.max.y}, IM_COL32(255, 255, 255, 200), 1.5f);
  const float middle = (area.min.y + area.max.y) / 2;
  draw->AddCircleFilled({line, middle}, grip, IM_COL32(255, 255, 255, 230));
  const bool near = std::abs(mouse.x - line) < grip && area.contains(mouse);
  ui::record_area("wipe line", {line - grip, middle - grip}, {line + grip, middle + grip}, near);
  if (near || dragging_line_) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (ImGui::IsItemActivated() && near && !ImGui::GetIO().KeyCtrl) dragging_line_ = true;
}

void Viewport::draw_difference(Session& session, ViewState& view, const PictureArea& area) {
  const auto image_of = [](const auto& owner) {
    return owner ? std::shared_ptr<const Image>(owner, &owner->image) : nullptr;
  };
  const auto test = image_of(session.picture(view.shown));
  const auto reference =
      view.against_truth ? image_of(session.truth().reference()) : image_of(session.picture(view.other));
  auto& d = differing_;
  if (test && reference && (test != d.test || reference != d.reference || view.difference != d.kind)) {
    d.test = test, d.reference = reference, d.kind = view.difference;
    // Coarse pictures of different sizes have no difference; the last one stays until there are others.
    if (const auto map = difference_map(*test, *reference, view.difference)) {
      difference_.show(map->image);
      d.range = map->range;
    }
  }
  if (!reference) draw_plate(area, area.height() / 2, "The reference is being rendered...");
  if (!(d.range > 0) || !reference) return;
  difference_.draw(area, view);
  draw_difference_legend(session, view, d.range, area);
}

void Viewport::draw(Session& session, ViewState& view, bool measured) {
  const Numbers& resolution = session.description().child("film").numbers("resolution");
  const Room room{ImGui::GetCursorScreenPos(), ImGui::GetContentRegionAvail(),
                  static_cast<float>(resolution[0] / resolution[1])};
  const PictureArea whole = room.whole();
  const ImVec2 pixels = ImGui::GetIO().DisplayFramebufferScale;
  session.set_picture_size(static_cast<int>(whole.width() * pixels.x), static_cast<int>(whole.height() * pixels.y));

  const std::size_t n = session.shown().size();
  view.choose_among(n);
  view.clamp();
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) dragging_line_ = false;

  if (n > 1 && view.mode == ViewMode::Tiles) {
    draw_tiles(session, view, room, measured);
  } else {
    ImGui::SetCursorScreenPos(whole.min);
    ui::canvas("picture", {whole.width(), whole.height()});
    if (n > 1 && view.mode == ViewMode::Wipe)
      draw_wipe(session, view, whole);
    else if (view.mode == ViewMode::Difference && (n > 1 || view.against_truth))
      draw_difference(session, view, whole);
    else
      draw_single(session, view, whole);
    handle_mouse(session, view, whole);
    draw_probe_mark(view, whole, true);
    if (!session.black_picture(view.shown).empty() && session.problem().empty())
      draw_plate(whole, whole.height() / 2, session.black_picture(view.shown));
  }
  draw_messages(session, whole);
}

}  // namespace brume
