// Small meshes for tests, and their files.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "renderer/geometry/triangle_mesh.h"

namespace brume {

/// The cube [-half, half]^3, faces outward.
inline TriangleMesh cube_mesh(float half = 1) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back({(i & 1) ? half : -half, (i & 2) ? half : -half, (i & 4) ? half : -half});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b, Vec3 shift = {}) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  for (const Vec3 v : b.vertices) a.vertices.push_back(v + shift);
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

/// With the front where the back was.
inline TriangleMesh turned(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// As a Wavefront file in the folder for temporary files.  @return its path
inline std::string write_obj(const std::string& name, const TriangleMesh& mesh) {
  const std::string path = testing::TempDir() + name;
  std::ofstream file(path);
  file.precision(9);
  for (const Vec3 v : mesh.vertices) file << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
  for (const auto& t : mesh.triangles) file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return path;
}

}  // namespace brume
