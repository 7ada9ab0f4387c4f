#include "renderer/march/presence.h"

#include <algorithm>

namespace brume {

Presence find_presence(std::span<const Medium> media, const Ray& ray, Arena& arena) {
  Presence presence;
  presence.of_medium = arena.alloc_span<std::span<const Interval>>(media.size());
  std::size_t edge_count = 0;
  presence.only = media.size();
  int present = 0;
  for (std::size_t m = 0; m < media.size(); ++m) {
    presence.of_medium[m] = media[m].intervals(ray, arena);
    edge_count += 2 * presence.of_medium[m].size();
    if (!presence.of_medium[m].empty()) presence.only = present++ == 0 ? m : media.size();
  }
  presence.edges = arena.alloc_span<float>(edge_count);
  std::size_t e = 0;
  for (const auto& intervals : presence.of_medium)
    for (const Interval i : intervals) presence.edges[e++] = i.begin, presence.edges[e++] = i.end;
  if (edge_count <= 2) return presence;
  std::sort(presence.edges.begin(), presence.edges.end());
  const auto end = std::unique(presence.edges.begin(), presence.edges.end());
  presence.edges = presence.edges.first(static_cast<std::size_t>(end - presence.edges.begin()));
  return presence;
}

}  // namespace brume
