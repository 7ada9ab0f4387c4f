#include "renderer/geometry/triangle_mesh.h"

#include <map>
#include <tuple>

namespace brume {

Bounds3 TriangleMesh::bounds() const {
  Bounds3 b;
  for (const Vec3 v : vertices) b.add(Vec3d(v));
  return b;
}

std::size_t open_edges(const TriangleMesh& mesh) {
  std::map<std::tuple<float, float, float>, std::uint32_t> places;
  std::vector<std::uint32_t> place_of;
  place_of.reserve(mesh.vertices.size());
  for (const Vec3 v : mesh.vertices)
    place_of.push_back(places.try_emplace({v.x, v.y, v.z}, static_cast<std::uint32_t>(places.size())).first->second);

  // Triangles that run along an edge from its lower to its higher place, less those that run the other way.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = place_of[t[static_cast<std::size_t>(i)]],
                          b = place_of[t[static_cast<std::size_t>((i + 1) % 3)]];
      if (a < b) ++runs[{a, b}];
      if (b < a) --runs[{b, a}];
    }
  std::size_t open = 0;
  for (const auto& [edge, balance] : runs) open += balance != 0;
  return open;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Vec3d origin(mesh.vertices[0]);  // any point will do; a near one does not cancel
  double six_volumes = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.corners(t);
    six_volumes += dot(Vec3d(a) - origin, cross(Vec3d(b) - origin, Vec3d(c) - origin));
  }
  return six_volumes / 6;
}

}  // namespace brume
