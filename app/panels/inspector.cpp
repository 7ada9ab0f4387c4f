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

ParamRowContext row_context(const EditTarget& target, const NodePath& path, const Node& node, const Param& p) {
  ParamRowContext context;
  if (p.type == ParamType::Grid)
    for (const GridInfo& info : target.session().grids_of(node.text("file")))
      if (info.usable) context.grids.push_back(info.name);
  if (p.automatic) context.automatic_value = automatic_value(target.session(), p);
  const bool in_variant = target.goes_to_variant(path, p.key);
  context.changed = in_variant ? target.is_set(path, p.key) : node.value(p.key) != p.default_value && !p.required;
  context.reset_help = in_variant ? "As in the scene again" : "Back to the default";
  const std::string setting = target.path_of(path, p.key);
  if (!is_common(setting)) context.dragged = setting;
  return context;
}

/// "Type", "Shader", "Integrator": the key that a scene file says it with.
std::string label_of_choice(const Family& family) {
  std::string label = family.type_key;
  label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
  return label;
}

void draw_kind(EditTarget& target, const NodePath& path, const Family& family, const Node& node) {
  if (family.tables.size() < 2) return;
  std::vector<std::string> labels;
  int index = 0;
  for (std::size_t i = 0; i < family.tables.size(); ++i) {
    if (family.tables[i] == &node.table()) index = static_cast<int>(i);
    labels.push_back(family.tables[i]->label);
  }
  const std::string label = label_of_choice(family);  // outlives the row
  const std::string setting = target.path_of(path, family.type_key);
  ui::PropertyRow row(
      label.c_str(),
      {.doc = node.table().doc, .modified = false, .reset_help = "", .dragged = is_common(setting) ? "" : setting});
  if (ui::combo(row.id(), index, labels)) {
    target.set_kind(path, family, *family.tables[static_cast<std::size_t>(index)]);
    target.session().close_step();
  }
  static_cast<void>(row.finish());
}

void draw_node(EditTarget& target, const NodePath& path, const Family* family, std::optional<FileWish>& browse) {
  const Node* node = path.find(target.description());
  if (!node) return;
  if (family) draw_kind(target, path, *family, *node);
  node = path.find(target.description());
  if (!node) return;
  // The table outlives the node, which every edit replaces.
  const ParamTable& table = node->table();
  for (const Param& p : table.params) {
    node = path.find(target.description());
    if (!node || &node->table() != &table) return;
    const ParamEdit edit = param_row(p, node->value(p.key), row_context(target, path, *node, p));
    if (edit.reset)
      target.reset(path, p);
    else if (edit.value)
      target.set(path, p, *edit.value);
    if (edit.finished) target.session().close_step();
    if (edit.browse) browse = {path, p.key};
  }
  for (const Slot& slot : table.slots) {
    if (slot.list) continue;
    if (!ui::collapsing_header(slot.label.c_str())) continue;
    const ui::Scope scope(slot.label.c_str());
    draw_node(target, path.child(slot.key), slot.family, browse);
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

std::optional<FileWish> draw_inspector(EditTarget& target, const NodePath& selected) {
  std::optional<FileWish> browse;
  const Node& scene = target.session().description();
  const Node* node = selected.find(scene);
  if (!node) {
    ImGui::TextDisabled("Select something on the left.");
    return browse;
  }
  ImGui::TextUnformatted(node->table().label.c_str());
  ui::tooltip_on_hover(node->table().doc);
  ImGui::Separator();
  draw_node(target, selected, family_of(scene, selected), browse);
  return browse;
}

}  // namespace brume
