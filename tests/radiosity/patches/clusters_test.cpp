// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/clusters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "base/numbers/random.h"
#include "radiosity/factors/hit_targets.h"
#include "radiosity/patches/patch_layout.h"
#include "radiosity/patches/split.h"
#include "tests/support/fine_meshes.h"

namespace earthshine::radiosity {
namespace {

using base::Key;
using base::Stream;
using base::uniform;

// A sphere of 1984 triangles, a wall of two.
scenes::Scene sphere_and_wall(bool sheets = false) {
  tests::SceneBuilder builder;
  scenes::Material material = tests::grey(0.5);
  material.two_sided = sheets;
  const std::uint32_t m = builder.material(material);
  tests::fine_sphere(builder, m, {0.0, 0.0, 2.0}, 0.7, 16);
  builder.quad(m, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  return builder.scene;
}

// Halves three quarters of the divisible patches of clusters.
Patches cut_at_random(Patches patches, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    std::vector<Cut> wanted(patches.count(), Cut::None);
    for (std::uint32_t i = 0; i < patches.count(); ++i) {
      const Key key(3, Stream::ErrorBudget, std::uint64_t(round) << 32 | i);
      if (!patches.facets[patches.facet[i]].is_cluster() || uniform(key, 0) > 0.75) continue;
      wanted[i] = uniform(key, 1) < 0.5 && can_cut(patches, i, Cut::T) ? Cut::T : Cut::S;
    }
    patches = split(patches, wanted).patches;
  }
  return patches;
}

// A wall of 64 x 64 x 2 triangles has as many patches as a wall of two triangles.
TEST(Clusters, AFinelyCutWallHasThePatchesOfTheWall) {
  for (const double edge_m : {0.3, 0.5, 1.0, 2.0}) {
    tests::SceneBuilder fine, plain;
    const Vec3 a{2.0, 0.5, 0.0}, b{-0.5, 2.0, 1.0};
    tests::fine_wall(fine, fine.material(tests::grey(0.5)), {1, 2, 3}, a, b, 64);
    const Vec3 c{1, 2, 3};
    plain.quad(plain.material(tests::grey(0.5)), c, c + a, c + a + b, c + b);
    const double here = double(subdivide(fine.scene, edge_m, edge_m).count());
    const double there = double(count_patches(plain.scene, edge_m));
    EXPECT_LE(here, 1.5 * there) << edge_m;
    EXPECT_GE(here, 0.5 * there) << edge_m;
    EXPECT_EQ(count_patches(fine.scene, edge_m), std::size_t(here));
  }
}

// Larger faces, mirrors, glass and single polygons are not clustered.
TEST(Clusters, ScenesOfLargeFacesHaveNone) {
  tests::SceneBuilder builder;
  builder.room({builder.material(tests::grey(0.5)), 0, 0, 0, 0, 0});
  const Patches plain = subdivide(builder.scene, 0.25), same = subdivide(builder.scene, 0.25, 0.25);
  EXPECT_EQ(same.clustered, nullptr);
  EXPECT_EQ(same.area_m2, plain.area_m2);
  EXPECT_EQ(subdivide(builder.scene, 10.0, 10.0).clustered, nullptr);  // six quadrilaterals
  scenes::Material mirror = tests::grey(0.1);
  mirror.mirror = Rgb(0.8);
  tests::SceneBuilder shiny;
  tests::fine_wall(shiny, shiny.material(mirror), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8);
  EXPECT_EQ(subdivide(shiny.scene, 1.0, 1.0).clustered, nullptr);
}

// Clusters do not cross objects, materials or creases: each patch of a finely divided cube has one
// normal.
TEST(Clusters, EdgesOfABodyPartThem) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  tests::fine_wall(builder, m, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8);
  tests::fine_wall(builder, m, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 8);
  for (scenes::Triangle& t : builder.scene.triangles) t.object = 0;
  const Patches patches = subdivide(builder.scene, 2.0, 2.0);
  EXPECT_EQ(patches.count(), 2U);
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    EXPECT_NEAR(glm::length(patches.normal(i)), 1.0, 1e-12);
    for (int k = 0; k < 64; ++k) {
      const SurfacePoint at = patches.at(i, k / 64.0, 0.5);
      EXPECT_NEAR(glm::dot(at.normal, patches.normal(i)), 1.0, 1e-12);
    }
  }
  builder.scene.triangles.back().object = 1;
  EXPECT_EQ(subdivide(builder.scene, 2.0, 2.0).count(), 3U);
  // Two treads and the riser between them: the treads have equal normals but are not connected.
  tests::SceneBuilder stair;
  stair.material(tests::grey(0.5));
  tests::fine_wall(stair, m, {0, 0, 0}, {0.4, 0, 0}, {0, 1, 0}, 8);
  tests::fine_wall(stair, m, {0.4, 0, 0}, {0, 0, 0.1}, {0, 1, 0}, 8);
  tests::fine_wall(stair, m, {0.4, 0, 0.1}, {0.4, 0, 0}, {0, 1, 0}, 8);
  for (scenes::Triangle& t : stair.scene.triangles) t.object = 0;
  EXPECT_EQ(subdivide(stair.scene, 2.0, 2.0).count(), 3U);
}

// For any divisions: the patches of a side that contain a triangle cover its area once, patches of
// a cluster add up to it, and the two halves of a patch to the patch.
TEST(Clusters, HalvesCoverTheTrianglesOnce) {
  const scenes::Scene scene = sphere_and_wall(true);
  const Patches whole = subdivide(scene, 0.6, 0.6);
  ASSERT_NE(whole.clustered, nullptr);
  Patches patches = whole;
  for (int round = 0; round < 14; ++round) {
    const Patches before = patches;
    std::vector<Cut> wanted(before.count(), Cut::None);
    for (std::uint32_t i = 0; i < before.count(); i += 1 + round % 3) {
      if (before.facets[before.facet[i]].is_cluster()) wanted[i] = Cut::S;
    }
    Split made = split(before, wanted);
    std::vector<double> of_parent(before.count(), 0.0);
    for (std::uint32_t i = 0; i < made.patches.count(); ++i) {
      of_parent[made.parent[i]] += made.patches.area_m2[i];
    }
    for (std::uint32_t i = 0; i < before.count(); ++i) {
      EXPECT_NEAR(of_parent[i] / before.area_m2[i], 1.0, 1e-9) << round << ' ' << i;
    }
    patches = std::move(made.patches);
  }
  std::vector<double> of_triangle(scene.triangles.size(), 0.0);
  std::size_t lone = 0;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    const Facet& facet = patches.facets[patches.facet[i]];
    if (!facet.is_cluster() || patches.is_back[i] != 0) continue;
    const ClusterSpan span = span_of(facet, patches.cell[i]);
    lone += span.count == 1 ? 1 : 0;
    for (std::uint32_t m = span.first; m < span.first + span.count; ++m) {
      const std::uint32_t t = patches.clustered->triangle[m];
      of_triangle[t] += span.count == 1 ? patches.area_m2[i] : scenes::triangle_area(scene, t);
    }
  }
  EXPECT_GT(lone, 100U);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (!whole.facets[whole.of_triangle[t]].is_cluster()) continue;
    EXPECT_NEAR(of_triangle[t] / scenes::triangle_area(scene, t), 1.0, 1e-12) << t;
  }
}

// Searching a point's position like a ray's hit finds its patch; the ray counters' single precision
// finds the same except at borders.
TEST(Clusters, APointsPlaceFindsItsPatch) {
  const scenes::Scene scene = sphere_and_wall(true);
  const Patches patches = cut_at_random(subdivide(scene, 0.6, 0.6), 9);
  ASSERT_GT(patches.count(), 1000U);
  const HitTargets targets(patches, {false});
  int other = 0, tried = 0;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    for (std::uint64_t k = 0; k < 8; ++k) {
      const Key key(5, Stream::ErrorBudget, 8 * std::uint64_t(i) + k);
      const double x = 0.001 + 0.998 * uniform(key, 0), y = 0.001 + 0.998 * uniform(key, 1);
      const auto [triangle, u, v] = patches.on_triangle(i, x, y);
      const bool front = patches.is_back[i] == 0;
      EXPECT_EQ(patches.find(triangle, u, v, front), i) << x << ' ' << y;
      ++tried;
      if (targets.find(triangle, float(u), float(v), front) != i) ++other;
      const auto& c = scene.triangles[triangle].vertex;
      const Vec3 &a = scene.vertices[c[0]], &b = scene.vertices[c[1]], &d = scene.vertices[c[2]];
      const SurfacePoint at = patches.at(i, x, y);
      EXPECT_NEAR(glm::length(at.position - (a + u * (b - a) + v * (d - a))), 0.0, 1e-12);
      const Vec3 normal = glm::normalize(glm::cross(b - a, d - a)) * (front ? 1.0 : -1.0);
      EXPECT_NEAR(glm::length(at.normal - normal), 0.0, 1e-12);
      EXPECT_NEAR(glm::length(patches.normal_at(triangle, front) - normal), 0.0, 1e-12);
    }
  }
  EXPECT_LT(other, tried / 1000);
}

// Points of a cluster are distributed over the triangles in proportion to area, here from 1/16 to
// 7/16: of n = 2^16 points of a lattice in x a triangle with share p gets n p to within one, as its
// part of x is one interval. Over a triangle their mean is its centre: for uniform x and y, to 1 %
// of its size.
TEST(Clusters, PointsAreUniformInArea) {
  tests::SceneBuilder builder;
  tests::fine_wall(builder, builder.material(tests::grey(0.5)), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  for (Vec3& p : builder.scene.vertices) p.x *= p.x;
  const Patches patches = subdivide(builder.scene, 1.0, 1.0);
  ASSERT_EQ(patches.count(), 1U);
  ASSERT_EQ(patches.facets[0].members, 32U);
  constexpr std::uint32_t patch = 0;
  constexpr int n = 1 << 16, rows = 16;
  std::map<std::uint32_t, int> hits;
  std::map<std::uint32_t, Vec3> sum;
  for (int k = 0; k < n; ++k) {
    const double x = (k + 0.5) / n, y = (k % rows + 0.5) / rows;
    const std::uint32_t t = patches.on_triangle(patch, x, y).triangle;
    ++hits[t];
    sum.try_emplace(t, 0.0).first->second += patches.point(patch, x, y);
  }
  EXPECT_EQ(hits.size(), 32U);
  for (const auto& [t, count] : hits) {
    const double area = scenes::triangle_area(builder.scene, t);
    EXPECT_NEAR(count, n * area / patches.area_m2[patch], 1.0 + 1e-6);
    const auto& v = builder.scene.triangles[t].vertex;
    const Vec3 centre = (builder.scene.vertices[v[0]] + builder.scene.vertices[v[1]] +
                         builder.scene.vertices[v[2]]) /
                        3.0;
    EXPECT_NEAR(glm::length(sum.at(t) / double(count) - centre), 0.0, 0.01 * std::sqrt(area)) << t;
  }
}

// The stored layout reproduces the patches.
TEST(Clusters, ALayoutComesBack) {
  const scenes::Scene scene = sphere_and_wall(true);
  const Patches patches = cut_at_random(subdivide(scene, 0.6, 0.6), 8);
  const Patches rebuilt = rebuild_patches(scene, layout_of(patches));
  EXPECT_EQ(rebuilt.area_m2, patches.area_m2);
  EXPECT_EQ(rebuilt.of_triangle, patches.of_triangle);
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    EXPECT_EQ(rebuilt.point(i, 0.3, 0.6), patches.point(i, 0.3, 0.6));
  }
  PatchLayout bad = layout_of(patches);
  bad.cluster_edge_m = -1.0;
  EXPECT_THROW((void)rebuild_patches(scene, bad), std::invalid_argument);
  bad = layout_of(patches);
  bad.cluster_edge_m = 0.0;
  EXPECT_THROW((void)rebuild_patches(scene, bad), std::invalid_argument);
  bad = layout_of(patches);
  for (std::uint32_t& entry : bad.tree) {  // a cell of several triangles halved along t
    if ((entry & Patches::split_cell) != 0) entry |= Patches::halves_t;
  }
  EXPECT_THROW((void)rebuild_patches(scene, bad), std::invalid_argument);
}

// The box and the rectangle of a patch contain its points.
TEST(Clusters, BoxesHoldTheirPoints) {
  const scenes::Scene scene = sphere_and_wall();
  const Patches patches = cut_at_random(subdivide(scene, 0.6, 0.6), 5);
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    const auto [low, high] = patches.box(i);
    const auto corner = patches.corners(i);
    const Vec3 a = corner[1] - corner[0], b = corner[3] - corner[0];
    if (patches.is_several(i)) {
      EXPECT_NEAR(glm::dot(glm::normalize(glm::cross(a, b)), patches.normal(i)), 1.0, 1e-12);
    }
    for (int k = 0; k < 16; ++k) {
      const Vec3 p = patches.point(i, (k + 0.5) / 16, 0.4);
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(p, low - 1e-12)) &&
                  glm::all(glm::lessThanEqual(p, high + 1e-12)));
      if (!patches.is_several(i)) continue;
      const double s = glm::dot(p - corner[0], a) / glm::dot(a, a);
      const double t = glm::dot(p - corner[0], b) / glm::dot(b, b);
      EXPECT_TRUE(s >= -1e-9 && s <= 1.0 + 1e-9 && t >= -1e-9 && t <= 1.0 + 1e-9) << i;
    }
  }
}

}  // namespace
}  // namespace earthshine::radiosity
