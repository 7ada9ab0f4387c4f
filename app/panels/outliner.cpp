#include "app/panels/outliner.h"

#include <imgui.h>

#include <set>

#include "app/ui/widgets.h"

namespace brume {
namespace {

std::string free_name(std::span<const Node> list, const std::string& kind) {
  std::set<std::string> taken;
  for (const Node& n : list) taken.insert(n.text("name"));
  if (!taken.contains(kind)) return kind;
  for (int i = 2;; ++i)
    if (const std::string name = kind + std::to_string(i); !taken.contains(name)) return name;
}

std::string shown_name(const Node& node, std::size_t index) {
  const std::string& name = node.text("name");
  return name.empty() ? node.kind() + " " + std::to_string(index) : name;
}

void change_and_close(Session& session, const std::function<void(Node&)>& edit) {
  session.change(edit);
  session.close_step();
}

void draw_add_menu(Session& session, const Slot& slot, NodePath& selected) {
  const ui::Scope scope(slot.label.c_str());
  const std::string popup = "Add " + slot.family->noun;
  if (ui::small_button("+")) ui::open_popup(popup.c_str());
  ui::tooltip_on_hover("Add a " + slot.family->noun);
  if (!ui::begin_popup(popup.c_str())) return;
  for (const ParamTable* table : slot.family->tables) {
    if (!ui::selectable(table->label.c_str(), false)) continue;
    const auto list = session.description().list(slot.key);
    const std::size_t index = list.size();
    Node node(*table);
    static_cast<void>(node.set("name", free_name(list, table->key)).ok());
    change_and_close(session, [&](Node& d) { d.list(slot.key).push_back(std::move(node)); });
    selected = NodePath().child(slot.key, index);
  }
  ui::end_popup();
}

/// One volume or light. @return false when it was removed
bool draw_element(Session& session, const Slot& slot, std::size_t index, NodePath& selected) {
  const Node& node = session.description().list(slot.key)[index];
  const std::string name = shown_name(node, index);
  const ui::Scope scope(name.c_str());
  const NodePath path = NodePath().child(slot.key, index);
  bool enabled = node.flag("enabled");
  if (ui::checkbox("##on", enabled))
    change_and_close(session, [&](Node& d) { static_cast<void>(path.find(d)->set("enabled", enabled).ok()); });
  ui::tooltip_on_hover("On or off");
  ImGui::SameLine();
  const float button = ImGui::GetFrameHeight();
  if (ui::selectable(name.c_str(), selected == path, {ImGui::GetContentRegionAvail().x - 2.4f * button, 0}))
    selected = path;
  ui::tooltip_on_hover(node.table().label);

  ImGui::SameLine(ImGui::GetContentRegionMax().x - 2.1f * button);
  if (ui::small_button("S")) {
    // The second press of solo brings everything back.
    change_and_close(session, [&](Node& d) {
      auto& list = d.list(slot.key);
      bool alone = list[index].flag("enabled");
      for (std::size_t i = 0; i < list.size(); ++i) alone &= i == index || !list[i].flag("enabled");
      for (std::size_t i = 0; i < list.size(); ++i) static_cast<void>(list[i].set("enabled", alone || i == index).ok());
    });
  }
  ui::tooltip_on_hover("Solo: only this one on; again: all on");
  ImGui::SameLine(ImGui::GetContentRegionMax().x - 1.0f * button);
  if (!ui::small_button("x")) {
    ui::tooltip_on_hover("Remove");
    return true;
  }
  change_and_close(session, [&](Node& d) {
    auto& list = d.list(slot.key);
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(index));
  });
  if (selected == path) selected = {};
  return false;
}

}  // namespace

void draw_outliner(Session& session, NodePath& selected) {
  // The table outlives the description, which every edit replaces.
  const ParamTable& table = session.description().table();
  for (const Slot& slot : table.slots) {
    if (slot.family == &compare_family()) continue;  // has a list of its own
    if (!slot.list) {
      const NodePath path = NodePath().child(slot.key);
      if (ui::selectable(slot.label.c_str(), selected == path)) selected = path;
      ui::tooltip_on_hover(slot.doc);
      continue;
    }
    ImGui::Spacing();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", slot.label.c_str());
    ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::GetFrameHeight());
    draw_add_menu(session, slot, selected);
    const ui::Scope scope(slot.label.c_str());
    for (std::size_t i = 0; i < session.description().list(slot.key).size(); ++i) {
      ImGui::PushID(static_cast<int>(i));
      const bool kept = draw_element(session, slot, i, selected);
      ImGui::PopID();
      if (!kept) break;
    }
  }
}

}  // namespace brume
