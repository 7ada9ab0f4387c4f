#include "app/panels/inspector.h"

#include <imgui.h>

#include "app/panels/param_row.h"
#include "app/ui/property_row.h"
#include "app/ui/widgets.h"

namespace brume {
namespace {

/// What "auto" has come to in the scene that renders, for the parameters that a scene resolves.
std::optional<double> automatic_value(const Session& session, const Param& p) {
  const auto scene = session.scene();
  if (!scene) return std::nullopt;
  if (p.key == "step_size") return scene->step_size;
  if (p.key == "shadow_step_size") return scene->shadow_step_size;
  if (p.key == "light_samples") return scene->light_samples;
  return std::nullopt;
}

ParamRowContext row_context(const Session& session, const Node& node, const Param& p) {
  ParamRowContext context;
  if (p.type == ParamType::Grid)
    for (const GridInfo& info : session.grids_of(node.text("file")))
      if (info.usable) context.grids.push_back(info.name);
  if (p.automatic) context.automatic_value = automatic_value(session, p);
  return context;
}

/// "Type", "Shader", "Integrator": the key that a scene file says it with.
std::string label_of_choice(const Family& family) {
  std::string label = family.type_key;
  label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
  return label;
}

void draw_kind(Session& session, const NodePath& path, const Family& family, const Node& node) {
  if (family.tables.size() < 2) return;
  std::vector<std::string> labels;
  int index = 0;
  for (std::size_t i = 0; i < family.tables.size(); ++i) {
    if (family.tables[i] == &node.table()) index = static_cast<int>(i);
    labels.push_back(family.tables[i]->label);
  }
  const std::string label = label_of_choice(family);  // outlives the row
  ui::PropertyRow row(label.c_str(), {.doc = node.table().doc, .modified = false});
  if (ui::combo(row.id(), index, labels)) {
    session.change([&](Node& d) {
      if (Node* n = path.find(d)) *n = n->converted_to(*family.tables[static_cast<std::size_t>(index)]);
    });
    session.close_step();
  }
  static_cast<void>(row.finish());
}

void draw_node(Session& session, const NodePath& path, const Family* family, std::optional<NodePath>& browse) {
  const Node* node = path.find(session.description());
  if (!node) return;
  if (family) draw_kind(session, path, *family, *node);
  node = path.find(session.description());
  // The table outlives the node, which every edit replaces.
  const ParamTable& table = node->table();
  for (const Param& p : table.params) {
    node = path.find(session.description());
    if (!node || &node->table() != &table) return;
    const ParamEdit edit = param_row(p, node->value(p.key), row_context(session, *node, p));
    if (edit.value)
      session.change([&](Node& d) {
        // Refused values (a widget cannot know every rule) leave the description as it was.
        if (Node* n = path.find(d)) static_cast<void>(n->set(p.key, *edit.value).ok());
      });
    if (edit.finished) session.close_step();
    if (edit.browse) browse = path;
  }
  for (const Slot& slot : table.slots) {
    if (slot.list) continue;
    if (!ui::collapsing_header(slot.label.c_str())) continue;
    const ui::Scope scope(slot.label.c_str());
    draw_node(session, path.child(slot.key), slot.family, browse);
  }
}

/// The family of the slot in which the object stands.
const Family* family_of(const Node& root, const NodePath& path) {
  for (const Slot& slot : root.table().slots) {
    const auto nodes = root.list(slot.key);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (NodePath().child(slot.key, i) == path) return slot.family;
  }
  return nullptr;
}

}  // namespace

std::optional<NodePath> draw_inspector(Session& session, const NodePath& selected) {
  std::optional<NodePath> browse;
  const Node* node = selected.find(session.description());
  if (!node) {
    ImGui::TextDisabled("Select something on the left.");
    return browse;
  }
  ImGui::TextUnformatted(node->table().label.c_str());
  ui::tooltip_on_hover(node->table().doc);
  ImGui::Separator();
  draw_node(session, selected, family_of(session.description(), selected), browse);
  return browse;
}

}  // namespace brume
