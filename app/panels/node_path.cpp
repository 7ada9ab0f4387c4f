#include "app/panels/node_path.h"

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

}  // namespace brume
