#include "renderer/params/node_difference.h"

#include <algorithm>

namespace brume {

std::optional<Affects> node_difference(const Node& a, const Node& b) {
  if (&a.table() != &b.table()) return Affects::Geometry;
  std::optional<Affects> dearest;
  const auto raise = [&](std::optional<Affects> to) {
    if (to && (!dearest || *to > *dearest)) dearest = to;
  };
  for (const Param& p : a.table().params)
    if (a.value(p.key) != b.value(p.key)) raise(p.affects);
  for (const Slot& s : a.table().slots) {
    if (!s.list) {
      raise(node_difference(a.child(s.key), b.child(s.key)));
      continue;
    }
    const auto list_a = a.list(s.key), list_b = b.list(s.key);
    if (list_a.size() != list_b.size()) return Affects::Geometry;
    for (std::size_t i = 0; i < list_a.size(); ++i) raise(node_difference(list_a[i], list_b[i]));
  }
  return dearest;
}

}  // namespace brume
