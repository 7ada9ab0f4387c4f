#include "renderer/geometry/mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "renderer/geometry/shape.h"
#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warps.h"
#include "tests/support/meshes.h"

namespace brume {
namespace {

TEST(TriangleMesh, EdgesAreOpenWhereTrianglesAreMissingOrFaceDifferentWays) {
  TriangleMesh mesh = cube_mesh();
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_EQ(open_edges(joined(cube_mesh(), cube_mesh(), {0.5f, 0, 0})), 0u) << "two bodies that overlap";
  EXPECT_EQ(open_edges(joined(cube_mesh(2), turned(cube_mesh()))), 0u) << "a body with a hollow";
  mesh.triangles.pop_back();
  EXPECT_EQ(open_edges(mesh), 3u);
  mesh = cube_mesh();
  std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
  EXPECT_EQ(open_edges(mesh), 3u) << "one triangle turned round";
}

TEST(TriangleMesh, VerticesAtTheSamePlaceAreOne) {
  TriangleMesh soup;
  const TriangleMesh cube = cube_mesh();
  for (std::size_t t = 0; t < cube.triangles.size(); ++t) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const Vec3 v : cube.corners(t)) soup.vertices.push_back(v);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(soup.vertices.size(), 36u);
  EXPECT_EQ(open_edges(soup), 0u);
}

TEST(TriangleMesh, VolumeHasTheSignOfTheSideThatIsOut) {
  EXPECT_NEAR(signed_volume(cube_mesh(1.5f)), 27, 1e-5);
  EXPECT_NEAR(signed_volume(turned(cube_mesh(1.5f))), -27, 1e-5);
}

TEST(Mesh, AClosedMeshIsTurnedOutwardAndAnOpenOneIsLeft) {
  const auto inward = Mesh::make(turned(cube_mesh()));
  ASSERT_TRUE(inward.ok());
  EXPECT_NEAR(signed_volume((*inward)->triangles), 8, 1e-5);
  EXPECT_EQ((*inward)->open_edges, 0u);
  TriangleMesh open = turned(cube_mesh());
  open.triangles.pop_back();
  const auto left = Mesh::make(open);
  ASSERT_TRUE(left.ok());
  EXPECT_EQ((*left)->triangles.triangles, open.triangles);
  EXPECT_EQ((*left)->open_edges, 3u);
}

TEST(Mesh, BadIndexVertexAndNoTriangleAreRefused) {
  TriangleMesh mesh = cube_mesh();
  mesh.triangles[3][1] = 8;
  const auto bad_index = Mesh::make(mesh);
  ASSERT_FALSE(bad_index.ok());
  EXPECT_EQ(bad_index.error().message, "found vertex number 8, expected less than 8");
  mesh = cube_mesh();
  mesh.vertices[2].y = NAN;
  EXPECT_FALSE(Mesh::make(mesh).ok());
  EXPECT_FALSE(Mesh::make({}).ok());
}

std::string write(const std::string& name, const std::string& text) {
  const std::string path = testing::TempDir() + name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

TEST(MeshFile, ObjAndPlyWithPolygonsGiveTheSameTriangles) {
  const std::string corners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 2\n";
  std::string obj = "# a pyramid\nmtllib none.mtl\no thing\n";
  for (std::size_t i = 0; i < corners.size();) {
    const std::size_t end = corners.find('\n', i);
    obj += "v " + corners.substr(i, end - i + 1), i = end + 1;
  }
  obj += "vn 0 0 1\nvt 0 0\nusemtl none\nf 4/1/1 3/1/1 2/1/1 1/1/1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf -2 -5 -1\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 5\nproperty list uchar int vertex_indices\nend_header\n" +
      corners + "4 3 2 1 0\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";
  for (const std::string& path : {write("pyramid.obj", obj), write("pyramid.ply", ply), write("PYRAMID.PLY", ply)}) {
    const auto mesh = Mesh::read(path);
    ASSERT_TRUE(mesh.ok()) << mesh.error().to_string();
    EXPECT_EQ((*mesh)->triangles.triangles.size(), 6u) << path;
    EXPECT_EQ((*mesh)->open_edges, 0u) << path;
    EXPECT_NEAR(signed_volume((*mesh)->triangles), 2.0 / 3, 1e-6) << path;
    EXPECT_EQ((*mesh)->triangles.bounds().high, Vec3d(1, 1, 2)) << path;
  }
}

TEST(MeshFile, WhatIsNoMeshIsRefusedInOneSentence) {
  const auto refused = [](const std::string& path) {
    const auto mesh = Mesh::read(path);
    EXPECT_FALSE(mesh.ok()) << path;
    if (mesh) return std::string();
    EXPECT_EQ(mesh.error().source.file, path);
    EXPECT_EQ(mesh.error().message.find('\n'), std::string::npos);
    return mesh.error().message;
  };
  EXPECT_EQ(refused(testing::TempDir() + "none.obj"), "there is no such file");
  EXPECT_EQ(refused(testing::TempDir() + "none.fbx"), "found the extension \".fbx\", expected a mesh in .obj or .ply");
  EXPECT_NE(refused(write("empty.obj", "")), "");
  EXPECT_NE(refused(write("points.obj", "v 0 0 0\nv 1 0 0\n")), "");
  EXPECT_NE(refused(write("text.ply", "smoke and mirrors\n")), "");
  EXPECT_NE(refused(write("cut.ply", "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\n")), "");
  EXPECT_NE(refused(write("binary.obj", std::string("\0\1\2\3v 1 2", 9))), "");
  EXPECT_NE(refused(write("wild.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 999999999\n")), "");
  EXPECT_NE(refused(write("nan.ply",
                          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                          "float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
                          "nan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")),
            "");
}

/// The same cube of quads in every encoding, with things to skip before, between and after.
std::string ply_cube(const std::string& format) {
  std::string text = "ply\nformat " + format +
                     " 1.0\ncomment a cube\nelement camera 1\nproperty double fov\nelement vertex 8\n"
                     "property float nx\nproperty double x\nproperty float y\nproperty short z\n"
                     "element face 6\nproperty uchar group\nproperty list uchar int vertex_indices\n"
                     "element edge 1\nproperty int a\nend_header\n";
  const bool ascii = format == "ascii", big = format == "binary_big_endian";
  const auto put = [&]<class T>(T value) {
    if (ascii) {
      text += std::to_string(static_cast<double>(value)) + (text.size() % 5 ? " " : "\n");
      return;
    }
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (big == (std::endian::native == std::endian::little)) std::reverse(bytes, bytes + sizeof(T));
    text.append(bytes, sizeof(T));
  };
  put(45.0);
  for (int i = 0; i < 8; ++i) {
    put(0.5f), put((i & 1) ? 1.0 : -1.0), put((i & 2) ? 1.0f : -1.0f);
    put(static_cast<std::int16_t>((i & 4) ? 1 : -1));
  }
  const std::int32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& quad : quads) {
    put(std::uint8_t{7}), put(std::uint8_t{4});
    for (const std::int32_t corner : quad) put(corner);
  }
  put(std::int32_t{-1});
  return text;
}

const char* const kPlyFormats[] = {"ascii", "binary_little_endian", "binary_big_endian"};

TEST(PlyFile, EveryEncodingGivesTheSameCube) {
  for (const char* format : kPlyFormats) {
    const auto mesh = Mesh::read(write("cube.ply", ply_cube(format)));
    ASSERT_TRUE(mesh.ok()) << format << ": " << mesh.error().to_string();
    EXPECT_EQ((*mesh)->triangles.triangles.size(), 12u) << format;
    EXPECT_EQ((*mesh)->open_edges, 0u) << format;
    EXPECT_NEAR(signed_volume((*mesh)->triangles), 8, 1e-6) << format;
  }
}

/// Cut anywhere or with wrong bytes: a mesh or an error, soon.
TEST(PlyFile, DamagedFilesNeitherCrashNorHang) {
  int read = 0, refused = 0;
  for (const char* format : kPlyFormats) {
    const std::string whole = ply_cube(format);
    for (std::size_t n = 0; n < whole.size(); n += 7) {
      const auto mesh = Mesh::read(write("cut.ply", whole.substr(0, n)));
      (mesh.ok() ? read : refused)++;
    }
    for (std::uint32_t i = 0; i < 400; ++i) {
      std::string damaged = whole;
      for (int k = 0; k < 3; ++k) {
        const Vec2 u = Sampler(SamplerKind::Independent, 8, 0, i).u2(Decision::Pixel, 0, k);
        damaged[static_cast<std::size_t>(u.x * static_cast<float>(damaged.size()))] = static_cast<char>(255 * u.y);
      }
      const auto mesh = Mesh::read(write("damaged.ply", damaged));
      (mesh.ok() ? read : refused)++;
    }
  }
  EXPECT_GT(read, 10) << "a wrong byte in a comment does no harm";
  EXPECT_GT(refused, 500);
}

// ---- The inside of a mesh -------------------------------------------------------------------------------------------

std::shared_ptr<const Mesh> made(TriangleMesh triangles) {
  auto mesh = Mesh::make(std::move(triangles));
  EXPECT_TRUE(mesh.ok());
  return *mesh;
}

std::vector<Interval> intervals(const Shape& shape, const Ray& ray) {
  Arena arena;
  const ArenaScope scope(arena);
  const auto found = shape.intervals(ray, arena);
  return {found.begin(), found.end()};
}

/// Any ray, from inside as well as outside, with any span: the same as the box.
TEST(MeshShape, ACubeIsTheBoxOfTheSameSize) {
  const MeshShape cube(made(cube_mesh()));
  const BoxShape box({-1, -1, -1}, {1, 1, 1});
  int met = 0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const Sampler sampler(SamplerKind::Independent, 3, 0, i);
    const auto u = [&](int k) { return sampler.u2(Decision::Pixel, 0, k); };
    Ray ray{{4 * u(0).x - 2, 4 * u(0).y - 2, 4 * u(1).x - 2}, uniform_sphere(u(2))};
    if (i % 2) ray.span = {u(3).x, u(3).x + 3 * u(3).y};
    const auto a = intervals(cube, ray), b = intervals(box, ray);
    if (!b.empty() && b[0].length() < 1e-5f) continue;  // grazes
    ASSERT_EQ(a.size(), b.size()) << i;
    if (b.empty()) continue;
    ++met;
    EXPECT_NEAR(a[0].begin, b[0].begin, 4e-6f) << i;
    EXPECT_NEAR(a[0].end, b[0].end, 4e-6f) << i;
  }
  EXPECT_GT(met, 4000);
}

/// Along the axes, through corners, edges and diagonals of faces.
TEST(MeshShape, RaysThroughEdgesAndCornersNeverSeeMoreThanTheBox) {
  const MeshShape cube(made(cube_mesh()));
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 origin(-5), direction(0);
        origin[(axis + 1) % 3] = 0.5f * static_cast<float>(x);
        origin[(axis + 2) % 3] = 0.5f * static_cast<float>(y);
        direction[axis] = 1;
        const auto found = intervals(cube, {origin, direction});
        const bool within = std::abs(x) < 2 && std::abs(y) < 2;
        if (within) ASSERT_EQ(found.size(), 1u) << x << ' ' << y << ' ' << axis;
        ASSERT_LE(found.size(), 1u);
        if (found.empty()) continue;
        EXPECT_NEAR(found[0].begin, 4, 1e-5f);
        EXPECT_NEAR(found[0].end, 6, 1e-5f);
      }
}

TEST(MeshShape, HollowsOverlapsAndSeveralBodiesCountByWinding) {
  const Ray through{{0.1f, 0.2f, -5}, {0, 0, 1}};
  const auto expect = [&](const TriangleMesh& mesh, const Ray& ray, const std::vector<Interval>& expected) {
    const auto found = intervals(MeshShape(made(mesh)), ray);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i].begin, expected[i].begin, 1e-5f);
      EXPECT_NEAR(found[i].end, expected[i].end, 1e-5f);
    }
  };
  const TriangleMesh hollow = joined(cube_mesh(2), turned(cube_mesh(1)));
  expect(hollow, through, {{3, 4}, {6, 7}});
  expect(hollow, {{0.1f, 0.2f, 0}, {0, 0, 1}}, {{1, 2}});
  expect(hollow, {{0.1f, 0.2f, 1.5f}, {0, 0, -1}}, {{0, 0.5f}, {2.5f, 3.5f}});
  // Where two bodies overlap the inside is one; the interval may come in parts that touch.
  double inside = 0;
  for (const Interval& i : intervals(MeshShape(made(joined(cube_mesh(), cube_mesh(), {0, 0, 1}))), through))
    inside += double(i.length());
  EXPECT_NEAR(inside, 3, 1e-5);
  expect(joined(cube_mesh(), cube_mesh(), {0, 0, 4}), through, {{4, 6}, {8, 10}});
}

}  // namespace
}  // namespace brume
