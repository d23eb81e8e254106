// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/patches.h"

#include <gtest/gtest.h>

#include "base/numbers/random.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

// A parallelogram, a long thin triangle and a sheet.
scenes::Scene assorted_scene() {
  tests::SceneBuilder builder;
  const std::uint32_t plain = builder.material(tests::grey(0.5));
  scenes::Material sheet = tests::grey(0.5);
  sheet.two_sided = true;
  const std::uint32_t thin = builder.material(sheet);
  builder.quad(plain, {0, 0, 0}, {2, 0.5, 0}, {3, 2.5, 1}, {1, 2, 1});
  builder.quad(thin, {5, 0, 0}, {6, 0, 0}, {6, 1, 0}, {5, 1, 0});
  const auto v = static_cast<std::uint32_t>(builder.scene.vertices.size());
  builder.scene.vertices.insert(builder.scene.vertices.end(),
                                {{0, 9, 0}, {7, 9, 0}, {7, 9.4, 0.2}});
  for (std::uint32_t turn = 0; turn < 3; ++turn) {  // each corner in turn is the first vertex
    builder.scene.triangles.push_back(
        {{v + turn, v + (turn + 1) % 3, v + (turn + 2) % 3}, 0, plain, 100 + turn});
  }
  return builder.scene;
}

TEST(Patches, AreasOfAFacetsCellsAddUpToTheTrianglesArea) {
  const scenes::Scene scene = assorted_scene();
  const Patches patches = subdivide(scene, 0.13);
  std::vector<double> sum(patches.facets.size(), 0.0);
  for (std::size_t i = 0; i < patches.count(); ++i) {
    if (patches.is_back[i] == 0) sum[patches.facet[i]] += patches.area_m2[i];
  }
  std::vector<double> triangles(patches.facets.size(), 0.0);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    triangles[patches.of_triangle[t]] += scenes::triangle_area(scene, t);
  }
  for (std::size_t f = 0; f < sum.size(); ++f) EXPECT_NEAR(sum[f] / triangles[f], 1.0, 1e-12);
}

TEST(Patches, MoreThanNumbersHoldAreRefused) {
  const scenes::Scene scene = assorted_scene();
  for (const double edge_m : {1e-4, 1e-9, 1e-10, 1e-20, 1e-300, 5e-324}) {
    for (const auto& count :
         {+[](const scenes::Scene&s, double e) { return count_patches(s, e); },
          +[](const scenes::Scene&s, double e) { return subdivide(s, e).count(); }}) {
      try {
        ADD_FAILURE() << edge_m << " m gives " << count(scene, edge_m) << " patches";
      } catch (const base::Error& error) {
        EXPECT_NE(std::string(error.what()).find("more than 67108864"), std::string::npos)
            << error.what();
      }
    }
  }
}

TEST(Patches, ARayAtAPointOfAPatchFindsThatPatch) {
  const scenes::Scene scene = assorted_scene();
  const scenes::RayQuery query(scene);
  const Patches patches = subdivide(scene, 0.21);
  base::Rng rng(base::Key(1, base::Stream::Test, 0));
  std::size_t tested = 0;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    if (patches.facets[patches.facet[i]].triangle >= 5) continue;  // the rotated copies coincide
    const double x = 0.02 + 0.96 * rng.next();
    const double y = 0.02 + 0.96 * rng.next();
    const Vec3 normal = patches.normal(i);
    const scenes::Hit hit = query.closest(patches.point(i, x, y) + 0.01 * normal, -normal);
    ASSERT_FALSE(hit.missed());
    if (hit.triangle >= 4) continue;
    EXPECT_EQ(patches.find(hit.triangle, hit.u, hit.v, hit.front), i);
    ++tested;
  }
  EXPECT_GT(tested, 100U);
}

TEST(Patches, PointAndParametersAreInverseOnEveryTurnOfATriangle) {
  const scenes::Scene scene = assorted_scene();
  const Patches patches = subdivide(scene, 0.3);
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    const Facet& facet = patches.facets[patches.facet[i]];
    if (facet.parallelogram || patches.is_back[i] != 0) continue;
    const auto& vertex = scene.triangles[facet.triangle].vertex;
    const Vec3 a = scene.vertices[vertex[0]];
    const Vec3 e1 = scene.vertices[vertex[1]] - a, e2 = scene.vertices[vertex[2]] - a;
    const Vec3 p = patches.point(i, 0.3, 0.7) - a;
    // Barycentric weights from the normal equations.
    const double g11 = glm::dot(e1, e1), g12 = glm::dot(e1, e2), g22 = glm::dot(e2, e2);
    const double d = g11 * g22 - g12 * g12;
    const double u = (g22 * glm::dot(p, e1) - g12 * glm::dot(p, e2)) / d;
    const double v = (g11 * glm::dot(p, e2) - g12 * glm::dot(p, e1)) / d;
    EXPECT_EQ(patches.find(facet.triangle, u, v, true), i);
  }
}

TEST(Patches, PointsAreUniformInArea) {
  // Midpoints of 64 x 64 cells of (x, y): their mean is the patch's centroid except for O(1 / 64^2)
  // of its size. The centroid of a triangle in one patch is the mean of its corners.
  const scenes::Scene scene = assorted_scene();
  const Patches patches = subdivide(scene, 100.0);
  const std::uint32_t i = patches.find(4, 0.3, 0.3, true);
  Vec3 mean(0.0);
  for (int k = 0; k < 64 * 64; ++k) {
    mean += patches.point(i, (k / 64 + 0.5) / 64, (k % 64 + 0.5) / 64) / 4096.0;
  }
  Vec3 centroid(0.0);
  for (const std::uint32_t v : scene.triangles[4].vertex) centroid += scene.vertices[v] / 3.0;
  EXPECT_NEAR(glm::length(mean - centroid), 0.0, 7.0 / 4096.0);
}

TEST(Patches, NoCellIsLongerThanTheEdge) {
  const Patches patches = subdivide(assorted_scene(), 0.13);
  for (const Facet& f : patches.facets) {
    EXPECT_LE(glm::length(f.a) / f.s_count, 0.13 + 1e-9);
    const Vec3 across = f.parallelogram ? f.b : f.b - f.a;
    EXPECT_LE(glm::length(across) / f.t_count, 0.13 + 1e-9);
  }
}

TEST(Patches, ALongThinTriangleIsCutAlongItsLengthOnly) {
  // 7 m by 0.45 m: cells of about half a metre need 14 or 15 rows and one column, not 15 x 15.
  const Patches patches = subdivide(assorted_scene(), 0.5);
  for (const Facet& f : patches.facets) {
    if (f.parallelogram) continue;
    EXPECT_EQ(f.t_count, 1U);
    EXPECT_EQ(f.s_count, 15U);
  }
}

TEST(Patches, SheetsHaveTwoSidesAndOneSidedSurfacesABlackBack) {
  const scenes::Scene scene = assorted_scene();
  const Patches patches = subdivide(scene, 10.0);
  EXPECT_EQ(patches.find(0, 0.2, 0.2, false), no_patch);
  const std::uint32_t front = patches.find(2, 0.2, 0.2, true);
  const std::uint32_t back = patches.find(2, 0.2, 0.2, false);
  ASSERT_NE(back, no_patch);
  EXPECT_NE(front, back);
  EXPECT_NEAR(glm::dot(patches.normal(front), patches.normal(back)), -1.0, 1e-12);
}

}  // namespace
}  // namespace earthshine::radiosity
