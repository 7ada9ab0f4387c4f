#include "app/panels/view_controls.h"

#include <imgui.h>

#include "app/panels/variant_list.h"
#include "app/ui/widgets.h"

namespace brume {

void ViewControls::handle_keys(Session& session, std::optional<std::size_t>& edited) {
  using ui::Key;
  if (ui::shortcut(Key::S)) view_.mode = ViewMode::Tiles;
  if (ui::shortcut(Key::W)) view_.mode = ViewMode::Wipe;
  if (ui::shortcut(Key::D)) view_.show_difference(false);
  if (ui::shortcut(Key::D, {.shift = true})) view_.show_difference(true);
  if (ui::shortcut(Key::Z)) view_.zoom = 1;
  if (ui::shortcut(Key::V)) edited = duplicate_as_variant(session, edited);
  flip(session.shown().size());
}

/// A tap on a number key shows a variant; a key that is held shows it until it is let go.
void ViewControls::flip(std::size_t count) {
  using ui::Key;
  for (std::size_t i = 0; count > 1 && i < count; ++i) {
    const auto key = static_cast<Key>(static_cast<int>(Key::Num1) + static_cast<int>(i));
    if (!ui::shortcut(key)) continue;
    // The second of two that are held goes back to what there was before the first.
    flipped_ = {key, flipped_.key != Key{} ? flipped_.before : view_, ImGui::GetTime()};
    view_.mode = ViewMode::Single;
    view_.shown = i;
  }
  constexpr double kTap = 0.35;  // seconds
  if (flipped_.key != Key{} && !ui::key_held(flipped_.key)) {
    if (ImGui::GetTime() - flipped_.since > kTap) {
      view_.mode = flipped_.before.mode;
      view_.shown = flipped_.before.shown;
      view_.other = flipped_.before.other;
    }
    flipped_.key = Key{};
  }
}

void ViewControls::draw_menu(Session& session, std::optional<std::size_t>& edited, bool& show_chart) {
  if (!ui::menu("Compare")) return;
  const auto mode = [&](const char* label, const char* keys, ViewMode m) {
    if (ui::menu_item(label, keys, view_.mode == m, session.shown().size() > 1)) view_.mode = m;
  };
  if (ui::menu_item("Duplicate as variant", "V", false,
                    session.description().child("compare").list("variants").size() < kMaxVariants))
    edited = duplicate_as_variant(session, edited);
  ImGui::Separator();
  mode("Side by side", "S", ViewMode::Tiles);
  mode("Single", "1-4", ViewMode::Single);
  mode("Wipe", "W", ViewMode::Wipe);
  const bool differs = view_.mode == ViewMode::Difference;
  if (ui::menu_item("Difference", "D", differs && !view_.against_truth, session.shown().size() > 1))
    view_.show_difference(false);
  if (ui::menu_item("Difference from the reference", "Shift+D", differs && view_.against_truth))
    view_.show_difference(true);
  ImGui::Separator();
  if (ui::menu_item("Chart", "C", show_chart)) show_chart = !show_chart;
  ImGui::Separator();
  const auto difference = [&](const char* label, DifferenceKind kind) {
    if (ui::menu_item(label, "", view_.difference == kind)) view_.difference = kind;
  };
  difference("Signed", DifferenceKind::Signed);
  difference("Absolute", DifferenceKind::Absolute);
  difference("Relative", DifferenceKind::Relative);
  difference("Squared", DifferenceKind::Squared);
  ImGui::Separator();
  const auto pick = [&](const char* label, std::size_t& which) {
    if (!ui::menu(label)) return;
    for (std::size_t i = 0; i < session.shown().size(); ++i)
      if (ui::menu_item(session.shown()[i].variant.name.c_str(), "", which == i)) which = i;
    ui::end_menu();
  };
  pick("Left, or what is judged", view_.shown);
  pick("Right, or what it is judged by", view_.other);
  ui::end_menu();
}

}  // namespace brume
