#include "app/panels/variant_list.h"

#include <imgui.h>

#include "app/panels/picture_labels.h"
#include "app/ui/property_row.h"
#include "app/ui/widgets.h"

namespace brume {
namespace {

const Family& variant_family() { return *compare_family().tables.front()->find_slot("variants")->family; }

std::span<const Node> variants(const Session& session) {
  return session.description().child("compare").list("variants");
}

void change_variants(Session& session, const std::function<void(std::vector<Node>&)>& edit) {
  session.change([&](Node& d) { edit(d.child("compare").list("variants")); });
  session.close_step();
}

/// Takes a parameter that was dragged here over into the variant, with the value that it has in the scene.
void take_dragged(Session& session, std::size_t variant) {
  if (!ImGui::BeginDragDropTarget()) return;
  if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(ui::kDraggedSetting)) {
    const std::string path(static_cast<const char*>(payload->Data), static_cast<std::size_t>(payload->DataSize));
    Node scene = session.description();
    // What only another variant's kind of object has is nothing that the scene could give.
    if (const auto value = text_by_path(scene, path)) {
      session.change([&](Node& d) { set_in_variant(d, variant, path, *value); });
      session.close_step();
    }
  }
  ImGui::EndDragDropTarget();
}

void draw_settings(Session& session, std::size_t variant) {
  const Settings settings = variants(session)[variant].settings("set");
  const float em = ImGui::GetFontSize();
  for (const Setting& s : settings) {
    const ui::Scope scope(s.path.c_str());
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + em);
    ImGui::BeginGroup();
    const float room = ImGui::GetContentRegionAvail().x - 1.6f * em;
    const std::string key = s.path.starts_with("render.") ? s.path.substr(7) : s.path;
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + room);
    ImGui::TextDisabled("%s = %s", key.c_str(), s.value.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndGroup();
    ui::tooltip_on_hover(s.path + " = " + s.value);
    ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::GetFrameHeight());
    if (ui::small_button("x")) {
      session.change([&](Node& d) { unset_in_variant(d, variant, s.path); });
      session.close_step();
    }
    ui::tooltip_on_hover("As in the scene again");
  }
}

/// @return false when it was removed
bool draw_variant(Session& session, std::size_t i, std::size_t shown_index, std::optional<std::size_t>& target) {
  const std::string name = variant_name(variants(session)[i], i);
  const ui::Scope scope(name.c_str());
  bool enabled = variants(session)[i].flag("enabled");
  if (ui::checkbox("##on", enabled))
    change_variants(session, [&](auto& list) { static_cast<void>(list[i].set("enabled", enabled).ok()); });
  ui::tooltip_on_hover("On or off");
  ImGui::SameLine();
  const float button = ImGui::GetFrameHeight(), stripe = std::floor(0.35f * ImGui::GetFontSize());
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  if (enabled)
    ImGui::GetWindowDrawList()->AddRectFilled(corner, {corner.x + stripe, corner.y + ImGui::GetFontSize() * 1.1f},
                                              variant_color(shown_index));
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 2 * stripe);
  const bool edited = target == i;
  if (ui::selectable(name.c_str(), edited, {ImGui::GetContentRegionAvail().x - 1.3f * button, 0}))
    target = edited ? std::nullopt : std::optional(i);
  take_dragged(session, i);
  ui::tooltip_on_hover(edited ? "The inspector edits this variant; click to edit the scene again"
                              : "Click to edit this variant in the inspector, or drag a parameter's name here");
  ImGui::SameLine(ImGui::GetContentRegionMax().x - button);
  const bool removed = ui::small_button("x");
  ui::tooltip_on_hover("Remove");
  if (!removed) {
    draw_settings(session, i);
    return true;
  }
  change_variants(session, [&](auto& list) { list.erase(list.begin() + static_cast<std::ptrdiff_t>(i)); });
  target.reset();
  return false;
}

}  // namespace

std::optional<std::size_t> duplicate_as_variant(Session& session, std::optional<std::size_t> of) {
  const std::size_t count = variants(session).size();
  if (count >= kMaxVariants) return of;
  change_variants(session, [&](std::vector<Node>& list) {
    const Node plain(*variant_family().tables.front());
    if (list.empty()) list.push_back(plain);
    Node copy = of && *of < list.size() ? list[*of] : plain;
    static_cast<void>(copy.set("name", std::string()).ok());
    list.push_back(std::move(copy));
  });
  return variants(session).size() - 1;
}

void draw_variant_list(Session& session, NodePath& selected, std::optional<std::size_t>& target) {
  ImGui::Spacing();
  const NodePath compare = NodePath().child("compare");
  if (ui::selectable("Compare", selected == compare)) selected = compare;
  ui::tooltip_on_hover(compare_family().tables.front()->doc);
  const ui::Scope scope("Compare");
  std::size_t shown_index = 0;
  for (std::size_t i = 0; i < variants(session).size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const bool enabled = variants(session)[i].flag("enabled");
    const bool kept = draw_variant(session, i, shown_index, target);
    ImGui::PopID();
    if (!kept) break;
    shown_index += enabled;
  }
  if (variants(session).size() >= kMaxVariants) return;
  if (ui::small_button("Duplicate as variant")) target = duplicate_as_variant(session, target);
  ui::tooltip_on_hover("A copy of what is edited, to be rendered beside it");
}

}  // namespace brume
