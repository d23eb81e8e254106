// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/random_cuts.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

void add_triangle(tests::SceneBuilder& builder, std::uint32_t material, const Vec3& a,
                  const Vec3& b, const Vec3& c) {
  const auto v = static_cast<std::uint32_t>(builder.scene.vertices.size());
  const auto number = static_cast<std::uint32_t>(builder.scene.triangles.size());
  builder.scene.vertices.insert(builder.scene.vertices.end(), {a, b, c});
  builder.scene.triangles.push_back({{v, v + 1, v + 2}, 0, material, 1000 + number});
}

// A parallelogram, a sheet, a sliver triangle (9 m by 3 cm) and an ordinary triangle.
scenes::Scene mixed_scene() {
  tests::SceneBuilder builder;
  const std::uint32_t plain = builder.material(tests::grey(0.5));
  scenes::Material sheet = tests::grey(0.5);
  sheet.two_sided = true;
  const std::uint32_t thin = builder.material(sheet);
  builder.quad(plain, {0, 0, 0}, {2, 0.5, 0}, {3, 2.5, 1}, {1, 2, 1});
  builder.quad(thin, {5, 0, 0}, {6, 0, 0}, {6, 1, 0}, {5, 1, 0});
  add_triangle(builder, plain, {0, 9, 0}, {9, 9, 0}, {9, 9.03, 0});
  add_triangle(builder, thin, {0, 5, 0}, {1, 5, 0}, {0.3, 6, 0.2});
  return builder.scene;
}

TEST(Split, APointOfAPatchIsFoundInThatPatchOnRandomTrees) {
  const scenes::Scene scene = mixed_scene();
  base::Rng rng(base::Key(3, base::Stream::Test, 1));
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Patches patches = tests::random_cuts(subdivide(scene, 0.7), 10, 0.3, seed);
    ASSERT_GT(patches.count(), 100U);
    for (std::uint32_t i = 0; i < patches.count(); ++i) {
      const Facet& facet = patches.facets[patches.facet[i]];
      const Rectangle r = patches.rectangle(i);
      const Parameters at{r.s0 + (0.01 + 0.98 * rng.next()) * (r.s1 - r.s0),
                          r.t0 + (0.01 + 0.98 * rng.next()) * (r.t1 - r.t0)};
      const std::uint32_t first = patches.is_back[i] != 0 ? facet.first_back : facet.first_front;
      ASSERT_EQ(first + patches.leaf(facet, at), i);
    }
  }
}

TEST(Split, AreasOfLeavesAddUpToTheirParentAndToTheFacet) {
  const scenes::Scene scene = mixed_scene();
  const Patches before = tests::random_cuts(subdivide(scene, 0.7), 4, 0.3, 7);
  std::vector<Cut> wanted(before.count(), Cut::None);
  for (std::size_t i = 0; i < wanted.size(); i += 3) wanted[i] = i % 2 == 0 ? Cut::S : Cut::T;
  const Split cut = split(before, wanted);
  std::vector<double> of_parent(before.count(), 0.0), of_facet(before.facets.size(), 0.0);
  for (std::size_t i = 0; i < cut.patches.count(); ++i) {
    of_parent[cut.parent[i]] += cut.patches.area_m2[i];
    if (cut.patches.is_back[i] == 0) of_facet[cut.patches.facet[i]] += cut.patches.area_m2[i];
  }
  for (std::size_t i = 0; i < before.count(); ++i) {
    EXPECT_NEAR(of_parent[i] / before.area_m2[i], 1.0, 1e-12);
  }
  for (std::size_t f = 0; f < of_facet.size(); ++f) {
    EXPECT_NEAR(of_facet[f] / before.facets[f].area_m2, 1.0, 1e-12);
  }
}

TEST(Split, TheParentOfAPatchHoldsItsPoints) {
  const Patches before = tests::random_cuts(subdivide(mixed_scene(), 0.7), 3, 0.4, 2);
  const Split cut = split(before, std::vector(before.count(), Cut::T));
  for (std::uint32_t i = 0; i < cut.patches.count(); ++i) {
    const Rectangle child = cut.patches.rectangle(i), r = before.rectangle(cut.parent[i]);
    EXPECT_EQ(cut.patches.facet[i], before.facet[cut.parent[i]]);
    EXPECT_EQ(cut.patches.is_back[i], before.is_back[cut.parent[i]]);
    EXPECT_TRUE(child.s0 >= r.s0 && child.s1 <= r.s1 && child.t0 >= r.t0 && child.t1 <= r.t1);
  }
}

TEST(Split, HalvingEveryCellBothWaysIsTheGridOfHalfTheEdge) {
  // A square of 1 m at 0.25 m: 4 x 4 cells; at 0.125 m: 8 x 8. The areas are the same multiset.
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  const Patches coarse = subdivide(builder.scene, 0.25), fine = subdivide(builder.scene, 0.125);
  const Patches cut = tests::all_in_four(coarse);
  ASSERT_EQ(cut.count(), fine.count());
  base::Rng rng(base::Key(3, base::Stream::Test, 2));
  for (int k = 0; k < 1000; ++k) {
    const Parameters at{rng.next(), rng.next()};
    const Rectangle a = cut.rectangle(cut.leaf(cut.facets[0], at));
    const Rectangle b = fine.rectangle(fine.leaf(fine.facets[0], at));
    EXPECT_EQ(a.s0, b.s0);
    EXPECT_EQ(a.s1, b.s1);
    EXPECT_EQ(a.t0, b.t0);
    EXPECT_EQ(a.t1, b.t1);
  }
  for (const double area : cut.area_m2) EXPECT_NEAR(area, 1.0 / 64.0, 1e-15);
}

TEST(Split, BothSidesOfASheetShareTheTree) {
  Patches patches = subdivide(mixed_scene(), 0.7);
  for (int round = 0; round < 5; ++round) {  // requested on the back only
    std::vector<Cut> wanted(patches.count(), Cut::None);
    for (std::uint32_t i = 0; i < patches.count(); i += 2) {
      if (patches.is_back[i] != 0) wanted[i] = round % 2 == 0 ? Cut::S : Cut::T;
    }
    patches = split(patches, wanted).patches;
  }
  std::size_t sheets = 0;
  for (const Facet& facet : patches.facets) {
    if (facet.first_back == no_patch) continue;
    ++sheets;
    EXPECT_NE(facet.tree, no_tree);
    for (std::uint32_t leaf = 0; leaf < facet.leaves; ++leaf) {
      const Cell &front = patches.cell[facet.first_front + leaf],
                 &back = patches.cell[facet.first_back + leaf];
      EXPECT_EQ(front.s, back.s);
      EXPECT_EQ(front.t, back.t);
      EXPECT_EQ(front.s_cuts, back.s_cuts);
      EXPECT_EQ(front.t_cuts, back.t_cuts);
    }
  }
  EXPECT_EQ(sheets, 2U);
}

TEST(Split, ACellThatSinglePrecisionCannotTellFromItsNeighbourStaysWhole) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  Patches patches = subdivide(builder.scene, 1.0);
  for (int round = 0; round < 20; ++round) {
    ASSERT_TRUE(can_cut(patches, 0, Cut::T));
    std::vector<Cut> wanted(patches.count(), Cut::None);
    wanted[0] = Cut::T;
    patches = split(patches, wanted).patches;
  }
  EXPECT_FALSE(can_cut(patches, 0, Cut::T));
  EXPECT_TRUE(can_cut(patches, 0, Cut::S));
  const std::size_t count = patches.count();
  std::vector<Cut> wanted(count, Cut::None);
  wanted[0] = Cut::T;
  EXPECT_EQ(split(patches, wanted).patches.count(), count);
}

TEST(Split, CellSizesAreThoseOfBothSidesOfASheet) {
  // 7 m x 0.4 m, divided into cells of at most 0.7 m: 10 x 1 cells of 0.7 m x 0.4 m.
  tests::SceneBuilder builder;
  scenes::Material sheet = tests::grey(0.5);
  sheet.two_sided = true;
  builder.quad(builder.material(sheet), {0, 0, 0}, {7, 0, 0}, {7, 0.4, 0}, {0, 0.4, 0});
  const Patches patches = subdivide(builder.scene, 0.7);
  ASSERT_EQ(patches.count(), 20U);
  for (std::uint32_t i = 0; i < 20; ++i) {
    EXPECT_NEAR(cell_size(patches, i).s_m, 0.7, 1e-12);
    EXPECT_NEAR(cell_size(patches, i).t_m, 0.4, 1e-12);
  }
}

TEST(Split, GradedNeighboursAreAtMostTwiceAsLong) {
  const Patches patches = tests::random_cuts(subdivide(mixed_scene(), 0.7), 10, 0.1, 4, true);
  std::size_t hanging = 0;
  base::Rng rng(base::Key(3, base::Stream::Test, 5));
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    const Facet& facet = patches.facets[patches.facet[i]];
    const std::uint32_t first = patches.is_back[i] != 0 ? facet.first_back : facet.first_front;
    const Rectangle r = patches.rectangle(i);
    const double step = 1e-7, x = rng.next();  // beyond the right and the upper side
    for (const Parameters& p : {Parameters{r.s1 + step, r.t0 + x * (r.t1 - r.t0)},
                                Parameters{r.s0 + x * (r.s1 - r.s0), r.t1 + step}}) {
      if (p.s > 1.0 || p.t > 1.0) continue;
      const Cell &a = patches.cell[i], &b = patches.cell[first + patches.leaf(facet, p)];
      EXPECT_LE(std::abs(a.s_cuts - b.s_cuts), 1);
      EXPECT_LE(std::abs(a.t_cuts - b.t_cuts), 1);
      hanging += a.s_cuts != b.s_cuts || a.t_cuts != b.t_cuts ? 1 : 0;
    }
  }
  EXPECT_GT(hanging, 20U);
}

}  // namespace
}  // namespace earthshine::radiosity
