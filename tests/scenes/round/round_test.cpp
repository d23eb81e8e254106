// SPDX-License-Identifier: Apache-2.0
#include "scenes/round/round.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/health/mend.h"
#include "scenes/mesh/shapes.h"
#include "scenes/ray_query.h"
#include "scenes/round/edge_curves.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

std::string obj_of(const Mesh& mesh, bool with_normals, const Vec3& center = Vec3(0.0)) {
  std::string text;
  for (const Vec3& v : mesh.vertices) text += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
  for (const Vec3& v : mesh.vertices) {
    const Vec3 n = v - center;
    if (with_normals) text += fmt::format("vn {} {} {}\n", n.x, n.y, n.z);
  }
  for (const MeshPolygon& polygon : mesh.polygons) {
    text += "f";
    for (std::uint32_t k = 0; k < polygon.count; ++k) {
      const std::uint32_t v = mesh.indices[polygon.first + k] + 1;
      text += with_normals ? fmt::format(" {}//{}", v, v) : fmt::format(" {}", v);
    }
    text += "\n";
  }
  return text;
}

const std::string head =
    "format = 1\n[[material]]\nname = \"m\"\n[[object]]\nname = \"o\"\nmaterial = \"m\"\n";

Scene scene_of(const Mesh& mesh, const std::string& keys, bool with_normals = false) {
  const test::SceneFolder folder;
  folder.put("a.obj", obj_of(mesh, with_normals));
  return folder.read(head + "mesh = \"a.obj\"\n" + keys);
}

void expect_closed(const Scene& scene) {
  const SurfaceHealth health = scene.objects.front().surface;
  EXPECT_EQ(health.open_edges, 0U);
  EXPECT_EQ(health.non_manifold_edges, 0U);
  EXPECT_EQ(health.closed_parts, 1U);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Round, CylinderOfEightSidesBecomesOneOfItsRadiusAndItsCapsFollow) {
  const Mesh eight = make_cylinder({0, 0, 0}, {0, 0, 2}, 1.0, 8, true);
  const Scene scene = scene_of(eight, "smooth_deg = 50\nround_deg = 3\n");
  expect_closed(scene);
  for (const Vec3& v : scene.vertices) {
    const double radius = std::hypot(v.x, v.y);
    // The flat sides are 7.6 % short of the radius in their middle. The rims are arcs, but the
    // diagonals of the sides only approximate ellipses.
    if (v.z > 1e-9 && v.z < 2.0 - 1e-9) {
      EXPECT_NEAR(radius, 1.0, 1e-2);
    } else {
      EXPECT_LT(radius, 1.0 + 1e-4);
    }
  }
  EXPECT_NEAR(scene.objects[0].area_m2 / (6.0 * base::pi), 1.0, 3e-3);
}

TEST(Round, SphereByItsVertexNormals) {
  const Mesh twelve = make_sphere({0, 0, 0}, 1.0, 12);
  const Scene scene = scene_of(twelve, "round_deg = 4\n", true);
  expect_closed(scene);
  for (const Vec3& v : scene.vertices) EXPECT_NEAR(glm::length(v), 1.0, 3e-3);
  EXPECT_NEAR(scene.objects[0].area_m2 / (4.0 * base::pi), 1.0, 4e-3);
  EXPECT_LT(scene_of(twelve, "", true).objects[0].area_m2, 0.96 * 4.0 * base::pi);
}

// The largest angle between two triangles that share an edge, degrees.
double sharpest_edge(const Scene& scene) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3> seen;
  double sharpest = 0.0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const Vec3 normal = triangle_normal(scene, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& v = scene.triangles[t].vertex;
      const auto [entry, fresh] = seen.emplace(std::minmax(v[k], v[(k + 1) % 3]), normal);
      const double cosine = std::clamp(glm::dot(entry->second, normal), -1.0, 1.0);
      if (!fresh) sharpest = std::max(sharpest, std::acos(cosine) * 180.0 / base::pi);
    }
  }
  return sharpest;
}

TEST(Round, NeighboursTurnByNoMoreThanIsWanted) {
  const Mesh twelve = make_sphere({0, 0, 0}, 1.0, 12);  // 30 degrees per edge
  EXPECT_GT(sharpest_edge(scene_of(twelve, "", true)), 25.0);
  for (const double wanted : {15.0, 7.5, 3.0}) {
    const Scene scene = scene_of(twelve, fmt::format("round_deg = {}\n", wanted), true);
    // Edges turn by the wanted angle; faces at an edge by a quarter more, and patches do not have
    // exactly one tangent plane where they meet.
    EXPECT_LT(sharpest_edge(scene), 1.25 * wanted + 0.75) << wanted;
    // 120 triangles, whose longest edge, a diagonal, turns by at most 41 degrees.
    EXPECT_LT(double(scene.triangles.size()), 120.0 * std::pow(std::ceil(41.5 / wanted), 2.0));
  }
}

TEST(Round, FlatFacesAndCreasesStayAsTheyAre) {
  const Mesh box = make_box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(scene_of(box, "smooth_deg = 60\nround_deg = 1\n").triangles.size(), 12U);
  const Mesh whole = rounded(box, {60.0, 1.0}, {});
  EXPECT_EQ(whole.vertices.size(), box.vertices.size());
  EXPECT_EQ(whole.indices, box.indices);
  // Small turns are refined too: 3 degrees per edge in segments of 1.
  const Mesh fine = make_cylinder({0, 0, 0}, {0, 0, 1}, 1.0, 120, false);
  EXPECT_GE(scene_of(fine, "smooth_deg = 30\nround_deg = 1\n").triangles.size(), 3U * 240U);
  // With a crease angle above its right angles the same box becomes a pillow.
  EXPECT_GT(scene_of(box, "smooth_deg = 91\nround_deg = 10\n").triangles.size(), 500U);
  expect_closed(scene_of(box, "smooth_deg = 91\nround_deg = 10\n"));
}

TEST(Round, NeighboursThatAreCutDifferentlyMeet) {
  // A cone: strongly curved at its tip, weakly at its base.
  Mesh cone = make_disk({0, 0, 0}, {0, 0, -1}, 1.0, 9);
  const auto tip = static_cast<std::uint32_t>(cone.vertices.size());
  cone.vertices.emplace_back(0.1, 0.2, 1.5);
  for (std::uint32_t k = 0; k < 9; ++k) {
    add_polygon(cone, std::array<std::uint32_t, 3>{(k + 1) % 9, k, tip}, 0, no_index);
  }
  expect_closed(scene_of(cone, "smooth_deg = 70\nround_deg = 3\n"));
}

TEST(Round, TextureCoordinatesAreMixed) {
  Mesh mesh = make_cylinder({0, 0, 0}, {0, 0, 1}, 1.0, 8, false);
  for (const std::uint32_t v : mesh.indices) {
    mesh.uv_indices.push_back(v);
  }
  for (const Vec3& v : mesh.vertices) mesh.uv.emplace_back(v.x, v.z);
  const Mesh made = rounded(mesh, {60.0, 5.0}, {});
  ASSERT_EQ(made.uv_indices.size(), made.indices.size());
  for (std::size_t k = 0; k < made.indices.size(); ++k) {
    // There is no curvature along the axis.
    EXPECT_NEAR(double(made.uv[made.uv_indices[k]].y), made.vertices[made.indices[k]].z, 0.02);
  }
}

TEST(CornerNormals, StandOnTheirPolygonsSide) {
  Mesh mesh;
  mesh.part_sets.emplace_back();
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};  // its front faces up
  add_polygon(mesh, std::array<std::uint32_t, 3>{0, 1, 2}, 0, no_index);
  mesh.normals = {{0, 0, 2}, {0.6F, 0, -0.8F}, {0, 0, 0}};
  mesh.normal_indices = {0, 1, 2};
  const std::vector<Vec3> normals = corner_normals(mesh, {0, 1, 2}, std::nullopt);
  EXPECT_LT(glm::length(normals[0] - Vec3(0, 0, 1)), 1e-6);
  EXPECT_LT(glm::length(normals[1] - Vec3(-0.6, 0, 0.8)), 1e-6);
  EXPECT_LT(glm::length(normals[2] - Vec3(0, 0, 1)), 1e-6);  // no normal in the file
}

TEST(Round, PlyAndGltfHaveNormalsToo) {
  const test::SceneFolder folder;
  folder.put("a.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
             "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
             "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
             "1 0 0 1 0 0\n0 1 0 0 1 0\n0 0 1 0 0 1\n3 0 1 2\n");
  const Scene scene = folder.read(head + "mesh = \"a.ply\"\nround_deg = 10\n");
  // An eighth of a sphere in 81 triangles; the flat triangle has 0.55 of its area.
  EXPECT_EQ(scene.triangles.size(), 81U);
  EXPECT_NEAR(scene.objects[0].area_m2 / (base::pi / 2.0), 1.0, 0.1);
  const std::string floats = [] {
    std::string bytes;
    for (int copy = 0; copy < 2; ++copy) {
      for (const float x : {1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F}) {
        bytes.append(reinterpret_cast<const char*>(&x), sizeof x);
      }
    }
    return bytes;
  }();
  folder.put("a.bin", floats);
  folder.put("a.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}}]}],
      "buffers": [{"byteLength": 72, "uri": "a.bin"}],
      "bufferViews": [{"buffer": 0, "byteLength": 72}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
        {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC3"}]})");
  const Scene same = folder.read(head + "mesh = \"a.gltf\"\nround_deg = 10\n");
  EXPECT_EQ(same.triangles.size(), 81U);
  EXPECT_EQ(same.objects[0].unused, "");
  EXPECT_NEAR(same.objects[0].area_m2, scene.objects[0].area_m2, 1e-6);
}

TEST(Round, ShapesChooseTheirSegmentsByTheAngle) {
  const test::SceneFolder folder;
  const auto polygons = [&](const std::string& keys) {
    return folder
        .read(head + "shape = \"disk\"\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 1\n" +
              keys)
        .objects.at(0)
        .polygon_count;
  };
  EXPECT_EQ(polygons(""), 32U);
  EXPECT_EQ(polygons("round_deg = 5\n"), 72U);
  EXPECT_EQ(polygons("segments = 9\n"), 9U);
  EXPECT_TRUE(holds(folder.refusal(head + "shape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n"
                                          "segments = 9\nround_deg = 5\n"),
                    {"scene.toml:11", "cannot be combined with"}));
  folder.put("a.obj", obj_of(make_box({0, 0, 0}, {1, 1, 1}), false));
  EXPECT_TRUE(holds(folder.refusal(head + "mesh = \"a.obj\"\nround_deg = 5\n"),
                    {"no vertex normals", "smooth_deg"}));
}

}  // namespace
}  // namespace earthshine::scenes
