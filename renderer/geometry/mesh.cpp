#include "renderer/geometry/mesh.h"

#include <algorithm>
#include <cmath>

#include "renderer/geometry/ray_scene.h"

namespace brume {

Result<std::shared_ptr<const Mesh>> Mesh::make(TriangleMesh triangles) {
  if (triangles.triangles.empty()) return bad_input("found no triangle, expected at least one");
  for (const auto& triangle : triangles.triangles)
    for (const std::uint32_t index : triangle)
      if (index >= triangles.vertices.size())
        return bad_input("found vertex number " + std::to_string(index) + ", expected less than " +
                         std::to_string(triangles.vertices.size()));
  if (!std::all_of(triangles.vertices.begin(), triangles.vertices.end(), [](Vec3 v) { return is_finite(v); }))
    return bad_input("found a vertex that is not finite, expected numbers");
  auto mesh = std::make_shared<Mesh>();
  mesh->open_edges = brume::open_edges(triangles);
  if (mesh->open_edges == 0 && signed_volume(triangles) < 0)
    for (auto& t : triangles.triangles) std::swap(t[1], t[2]);
  auto rays = RayScene::of(triangles);
  if (!rays) return rays.error();
  mesh->rays = std::move(*rays);
  mesh->triangles = std::move(triangles);
  return std::shared_ptr<const Mesh>(std::move(mesh));
}

}  // namespace brume
