// SPDX-License-Identifier: Apache-2.0
#include "radiosity/store/solution_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/fine_meshes.h"

namespace earthshine::radiosity {
namespace {

// A scene divided into patches, with one light group and a given radiosity for each patch.
template <class Value>
Solution given(const scenes::Scene& scene, double edge_m, Value value,
               double cluster_edge_m = 0.0) {
  Solution solution;
  solution.patches = subdivide(scene, edge_m, cluster_edge_m);
  solution.columns = 3;
  for (std::uint32_t i = 0; i < solution.patches.count(); ++i) {
    for (int c = 0; c < 3; ++c) {
      solution.radiosity.push_back(static_cast<float>(value(solution.patches, i)[c]));
    }
  }
  return solution;
}

Vec3 vertex(const scenes::GltfPart& part, std::size_t k) {
  return {part.positions[3 * k], part.positions[3 * k + 1], part.positions[3 * k + 2]};
}
Vec3 colour(const scenes::GltfPart& part, std::size_t k) {
  return {part.colours[3 * k], part.colours[3 * k + 1], part.colours[3 * k + 2]};
}

TEST(SolutionMesh, ColoursTimesTheirUnitAreTheRadiosity) {
  // Two plates with one radiosity each: the log-mean, 0.18 of the unit, of 1 and 4 is 2. Grey has
  // its radiosity as luminance.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1.0, true);
  const SolutionMesh mesh =
      solution_mesh(builder.scene, given(builder.scene, 0.5, [](const Patches& p, std::uint32_t i) {
                      return Rgb(p.object(i) == 0 ? 1.0 : 4.0);
                    }));
  EXPECT_NEAR(mesh.lm_m2_per_unit, 2.0 / 0.18, 1e-9);
  EXPECT_EQ(mesh.clipped_share, 0.0);
  ASSERT_EQ(mesh.parts.size(), 2U);
  EXPECT_EQ(mesh.parts[1].name, "quad-1");
  for (std::size_t k = 0; k < 16; ++k) {
    EXPECT_NEAR(colour(mesh.parts[0], k).g * mesh.lm_m2_per_unit, 1.0, 1e-6);
    EXPECT_NEAR(colour(mesh.parts[1], k).b * mesh.lm_m2_per_unit, 4.0, 1e-6);
  }
}

// Plates of radiosity 1; the last one has 1000.
SolutionMesh with_a_bright_one(int plates) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  for (int k = 0; k < plates; ++k) builder.plate(m, 1.0, k, true);
  return solution_mesh(builder.scene,
                       given(builder.scene, 1.0, [&](const Patches& p, std::uint32_t i) {
                         return Rgb(static_cast<int>(p.object(i)) == plates - 1 ? 1000.0 : 1.0);
                       }));
}

TEST(SolutionMesh, AFewBrightPatchesAreClippedAndCounted) {
  // The mean of 31 logarithms, one of them of 1000: the unit is 1000^(1/31) / 0.18 = 6.9.
  const SolutionMesh mesh = with_a_bright_one(31);
  EXPECT_NEAR(mesh.lm_m2_per_unit, std::pow(1000.0, 1.0 / 31.0) / 0.18, 1e-9);
  EXPECT_NEAR(mesh.clipped_share, 1.0 / 31.0, 1e-12);
  EXPECT_EQ(colour(mesh.parts[30], 0), Vec3(1.0));
}

TEST(SolutionMesh, BrightPatchesOfMoreThanATwentiethAreShown) {
  const SolutionMesh mesh = with_a_bright_one(4);
  EXPECT_EQ(mesh.lm_m2_per_unit, 1000.0);
  EXPECT_EQ(mesh.clipped_share, 0.0);
  EXPECT_NEAR(colour(mesh.parts[0], 0).r, 0.001, 1e-9);
}

TEST(SolutionMesh, FacesLookTheWayTheirPatchesDo) {
  tests::SceneBuilder builder;
  scenes::Material sheet = tests::grey(0.5);
  sheet.two_sided = true;
  builder.plate(builder.material(sheet), 1.0, 0.0, true);
  const std::uint32_t one_sided = builder.material(tests::grey(0.5));
  const auto v = static_cast<std::uint32_t>(builder.scene.vertices.size());
  builder.scene.vertices.insert(builder.scene.vertices.end(), {{0, 0, 1}, {2, 0, 1}, {2, 1, 1}});
  builder.scene.triangles.push_back({{v, v + 1, v + 2}, 0, one_sided, 9});
  const Solution solution =
      given(builder.scene, 0.5, [](const Patches&, std::uint32_t) { return Rgb(1.0); });
  const scenes::GltfPart part = solution_mesh(builder.scene, solution).parts[0];
  double up = 0.0, down = 0.0, tilted = 0.0;
  for (std::size_t k = 0; k < part.indices.size(); k += 3) {
    const Vec3 a = vertex(part, part.indices[k]), b = vertex(part, part.indices[k + 1]),
               c = vertex(part, part.indices[k + 2]);
    const Vec3 area = 0.5 * glm::cross(b - a, c - a);
    EXPECT_GT(glm::length(area), 1e-6);  // no triangle without area, including the apex
    (a.z > 0.5 ? tilted : area.z > 0.0 ? up : down) += area.z;
  }
  EXPECT_NEAR(up, 1.0, 1e-6);      // the sheet's front
  EXPECT_NEAR(down, -1.0, 1e-6);   // its back
  EXPECT_NEAR(tilted, 1.0, 1e-6);  // the triangle's front only
}

// Radiosity 1 for x < 0, else 3; two adjacent cells of one square metre.
template <class Build>
std::vector<double> colours_at_the_seam(Build build) {
  tests::SceneBuilder builder;
  build(builder);
  const SolutionMesh mesh =
      solution_mesh(builder.scene, given(builder.scene, 1.0, [](const Patches& p, std::uint32_t i) {
                      return Rgb(p.point(i, 0.5, 0.5).x < 0.0 ? 1.0 : 3.0);
                    }));
  std::vector<double> found;
  for (const scenes::GltfPart& part : mesh.parts) {
    for (std::size_t k = 0; k < part.positions.size() / 3; ++k) {
      const double b = colour(part, k).r * mesh.lm_m2_per_unit;
      if (std::abs(vertex(part, k).x) < 1e-6) found.push_back(std::round(b * 1e4) / 1e4);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(SolutionMesh, NeighboursOfOneSurfaceAreBlendedAndEdgesStaySharp) {
  const auto one_quad = [](tests::SceneBuilder& b) {
    b.quad(b.material(tests::grey(0.5)), {-1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 1, 0});
  };
  EXPECT_EQ(colours_at_the_seam(one_quad), std::vector<double>(4, 2.0));
  // The same two cells as faces of one object, bent by 30 and by 60 degrees.
  for (const double bend_deg : {30.0, 60.0}) {
    const auto bent = [&](tests::SceneBuilder& b) {
      const std::uint32_t m = b.material(tests::grey(0.5));
      const double c = std::cos(base::radians(bend_deg)), s = std::sin(base::radians(bend_deg));
      b.quad(m, {-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0});
      b.quad(m, {0, 0, 0}, {c, 0, s}, {c, 1, s}, {0, 1, 0});
      for (scenes::Triangle& triangle : b.scene.triangles) triangle.object = 0;
    };
    EXPECT_EQ(colours_at_the_seam(bent),
              bend_deg < 40.0 ? std::vector<double>(4, 2.0) : (std::vector<double>{1, 1, 3, 3}));
  }
  const auto two_objects = [](tests::SceneBuilder& b) {
    const std::uint32_t m = b.material(tests::grey(0.5));
    b.quad(m, {-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0});
    b.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  };
  EXPECT_EQ(colours_at_the_seam(two_objects), (std::vector<double>{1, 1, 3, 3}));
}

TEST(SolutionMesh, EmittingSurfacesShineAndADarkSceneIsBlack) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 9.0, 0.0, true);
  builder.plate(builder.material(tests::grey(0.0, 7.0)), 0.5, 1.0, false);
  const Solution dark =
      given(builder.scene, 9.0, [](const Patches&, std::uint32_t) { return Rgb(0.0); });
  const SolutionMesh lamp = solution_mesh(builder.scene, dark);
  EXPECT_NEAR(lamp.lm_m2_per_unit, 7.0 / 0.18, 1e-9);
  EXPECT_NEAR(colour(lamp.parts[1], 0).r, 0.18, 1e-6);
  builder.scene.materials[1].emit = Rgb(0.0);
  const SolutionMesh nothing = solution_mesh(builder.scene, dark);
  EXPECT_EQ(nothing.lm_m2_per_unit, 0.0);
  EXPECT_EQ(colour(nothing.parts[1], 0), Vec3(0.0));
}

// A sheet of 128 triangles in one cluster: all of them exist, facing their side.
TEST(SolutionMesh, BothSidesOfAClusterHaveAllItsTriangles) {
  tests::SceneBuilder builder;
  scenes::Material sheet = tests::grey(0.5);
  sheet.two_sided = true;
  tests::fine_wall(builder, builder.material(sheet), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8);
  const Solution solution = given(
      builder.scene, 2.0, [](const Patches&, std::uint32_t) { return Rgb(1.0); }, 2.0);
  ASSERT_EQ(solution.patches.count(), 2U);
  const SolutionMesh mesh = solution_mesh(builder.scene, solution);
  const scenes::GltfPart& part = mesh.parts[0];
  ASSERT_EQ(part.indices.size(), 2U * 3U * 128U);
  double up = 0.0, down = 0.0;
  for (std::size_t k = 0; k < part.indices.size(); k += 3) {
    const Vec3 a = vertex(part, part.indices[k]), b = vertex(part, part.indices[k + 1]),
               c = vertex(part, part.indices[k + 2]);
    const double area = 0.5 * glm::cross(b - a, c - a).z;
    (area > 0.0 ? up : down) += area;
  }
  EXPECT_NEAR(up, 1.0, 1e-6);
  EXPECT_NEAR(down, -1.0, 1e-6);
}

}  // namespace
}  // namespace earthshine::radiosity
