#include "app/panels/node_path.h"

#include <algorithm>

namespace brume {

const Node* NodePath::find(const Node& root) const {
  const Node* node = &root;
  for (const Step& step : steps_) {
    const Slot* slot = node->table().find_slot(step.slot);
    if (!slot) return nullptr;
    const auto list = node->list(step.slot);
    if (step.index >= list.size()) return nullptr;
    node = &list[step.index];
  }
  return node;
}

std::string NodePath::to_text(const Node& root) const {
  std::string text;
  const Node* node = &root;
  for (const Step& step : steps_) {
    text += (text.empty() ? "" : ".") + step.slot;
    const Slot* slot = node ? node->table().find_slot(step.slot) : nullptr;
    if (!slot) {
      node = nullptr;  // parts that only some kinds have hold no lists
      continue;
    }
    const auto list = node->list(step.slot);
    if (slot->list) {
      const auto name_of = [](const Node& n) { return n.table().find("name") ? n.text("name") : std::string(); };
      const std::string name = name_of(list[step.index]);
      const bool tells = !name.empty() && std::count_if(list.begin(), list.end(),
                                                        [&](const Node& n) { return name_of(n) == name; }) == 1;
      text += "." + (tells ? name : std::to_string(step.index));
    }
    node = &list[step.index];
  }
  return text;
}

}  // namespace brume
