#include "renderer/scene_io/families.h"

#include <algorithm>

namespace brume {

std::vector<const Family*> reachable_families(const Family& root) {
  std::vector<const Family*> found{&root};
  for (std::size_t next = 0; next < found.size(); ++next)  // grows while it is walked
    for (const ParamTable* table : found[next]->tables)
      for (const Slot& slot : table->slots)
        if (std::find(found.begin(), found.end(), slot.family) == found.end()) found.push_back(slot.family);
  return found;
}

}  // namespace brume
