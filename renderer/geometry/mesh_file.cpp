#include <tiny_obj_loader.h>

#include <fstream>
#include <iterator>

#include "renderer/core/input_file.h"
#include "renderer/geometry/mesh.h"
#include "renderer/geometry/ply_file.h"

namespace brume {
namespace {

/// From memory, so that no other file that the mesh may name is opened.
Result<TriangleMesh> read_obj(const std::string& path) {
  if (const auto readable = check_readable(path); !readable) return readable.error();
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  config.vertex_color = false;
  tinyobj::ObjReader reader;
  if (!reader.ParseFromString(text, "", config))
    return file_error(path, "this OBJ file is damaged: " + quoted_reason(reader.Error()));

  TriangleMesh mesh;
  const auto& places = reader.GetAttrib().vertices;
  for (std::size_t i = 0; i + 2 < places.size(); i += 3)
    mesh.vertices.push_back({places[i], places[i + 1], places[i + 2]});
  for (const tinyobj::shape_t& shape : reader.GetShapes()) {
    const auto& corners = shape.mesh.indices;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
      const auto index = [&](std::size_t k) { return static_cast<std::uint32_t>(corners[i + k].vertex_index); };
      mesh.triangles.push_back({index(0), index(1), index(2)});
    }
  }
  return mesh;
}

}  // namespace

Result<std::shared_ptr<const Mesh>> Mesh::read(const std::string& path) {
  const std::string kind = lower_case_extension(path);
  if (kind != ".obj" && kind != ".ply")
    return file_error(path, "found the extension \"" + kind + "\", expected a mesh in .obj or .ply");
  auto triangles = kind == ".obj" ? read_obj(path) : read_ply(path);
  if (!triangles) return triangles.error();
  auto mesh = Mesh::make(std::move(*triangles));
  if (!mesh) return file_error(path, mesh.error().message);
  return mesh;
}

}  // namespace brume
