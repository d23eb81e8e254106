// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/patch_layout.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "base/numbers/random.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

constexpr std::uint32_t split = Patches::split_cell;  // halves along s,
constexpr std::uint32_t split_t = Patches::split_cell | Patches::halves_t;

// A square sheet and a triangle.
scenes::Scene sheet_and_triangle() {
  tests::SceneBuilder builder;
  scenes::Material sheet = tests::grey(0.5);
  sheet.two_sided = true;
  builder.quad(builder.material(sheet), {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  const auto v = static_cast<std::uint32_t>(builder.scene.vertices.size());
  builder.scene.vertices.insert(builder.scene.vertices.end(), {{0, 0, 1}, {2, 0, 1}, {2, 1, 1}});
  builder.scene.triangles.push_back({{v, v + 1, v + 2}, 0, builder.material(tests::grey(0.5)), 9});
  return builder.scene;
}

// The sheet is one cell, halved along s and then t, its last quarter likewise: 7 leaves per side.
// The triangle (area 1) is a row of two cells, divided at half its length: 1/4 and 3/4 of the area.
PatchLayout split_layout() {
  PatchLayout layout;
  layout.s_count = {1, 2};
  layout.t_count = {1, 1};
  layout.first_front = {0, 14};
  layout.first_back = {7, no_patch};
  layout.leaves = {7, 2};
  layout.tree_start = {0, no_tree};
  layout.tree = {split | 1,   split_t | 3,  split_t | 5, 0, 1, 2, split | 7,
                 split_t | 9, split_t | 11, 3,           4, 5, 6};
  for (int side = 0; side < 2; ++side) {
    layout.area_m2.insert(layout.area_m2.end(), 3, 0.25);
    layout.area_m2.insert(layout.area_m2.end(), 4, 0.0625);
  }
  layout.area_m2.insert(layout.area_m2.end(), {0.25, 0.75});
  return layout;
}

TEST(PatchLayout, SplitCellsComeBackAsTheirTreeSays) {
  const scenes::Scene scene = sheet_and_triangle();
  const Patches patches = rebuild_patches(scene, split_layout());
  ASSERT_EQ(patches.count(), 16U);
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    // A patch covers its stated area, and its middle is found in it.
    const auto c = patches.corners(i);
    const double area = 0.5 * glm::length(glm::cross(c[2] - c[0], c[3] - c[1]));
    EXPECT_NEAR(area, patches.area_m2[i], 1e-12) << i;
    const Rectangle r = patches.rectangle(i);
    const Facet& facet = patches.facets[patches.facet[i]];
    const std::uint32_t first = patches.is_back[i] != 0 ? facet.first_back : facet.first_front;
    EXPECT_EQ(first + patches.leaf(facet, {0.5 * (r.s0 + r.s1), 0.5 * (r.t0 + r.t1)}), i);
  }
  EXPECT_EQ(patches.cell[6].s_cuts, 2U);
  EXPECT_EQ(patches.cell[6].t_cuts, 2U);
  const PatchLayout again = layout_of(patches);
  EXPECT_EQ(again.tree, split_layout().tree);
  EXPECT_EQ(again.leaves, split_layout().leaves);
  EXPECT_EQ(again.tree_start, split_layout().tree_start);
}

TEST(PatchLayout, ACutSceneIsItsOwnLayout) {
  const scenes::Scene scene = sheet_and_triangle();
  const Patches cut = subdivide(scene, 0.13);
  const Patches rebuilt = rebuild_patches(scene, layout_of(cut));
  EXPECT_EQ(rebuilt.facet, cut.facet);
  EXPECT_EQ(rebuilt.is_back, cut.is_back);
  EXPECT_EQ(rebuilt.of_triangle, cut.of_triangle);
  for (std::uint32_t i = 0; i < cut.count(); ++i) EXPECT_EQ(rebuilt.corners(i), cut.corners(i));
}

TEST(PatchLayout, WhateverIsNotOneLeafPerPatchIsRefused) {
  const scenes::Scene scene = sheet_and_triangle();
  using Change = std::function<void(PatchLayout&)>;
  const std::vector<Change> changes = {
      [](PatchLayout& l) { l.s_count.pop_back(); },
      [](PatchLayout& l) { l.s_count[1] = 0; },
      [](PatchLayout& l) { l.s_count[1] = 0xFFFFFFFFU; },
      [](PatchLayout& l) { l.t_count[0] = 0x80000000U; },
      [](PatchLayout& l) { l.leaves[0] = 8; },
      [](PatchLayout& l) { l.leaves[0] = 0xFFFFFFFFU; },
      [](PatchLayout& l) { l.leaves[1] = 3; },
      [](PatchLayout& l) { l.first_front[1] = 13; },
      [](PatchLayout& l) { l.first_front[1] = no_patch; },
      [](PatchLayout& l) { l.first_back[0] = no_patch; },
      [](PatchLayout& l) { l.first_back[0] = 0; },
      [](PatchLayout& l) { l.first_back[1] = 14; },
      [](PatchLayout& l) { l.tree_start[0] = no_tree; },
      [](PatchLayout& l) { l.tree_start[0] = 13; },
      [](PatchLayout& l) { l.tree_start[1] = 1; },
      [](PatchLayout& l) { l.tree[0] = split | 0; },  // a pair that contains itself
      [](PatchLayout& l) { l.tree[6] = split | 1; },
      [](PatchLayout& l) { l.tree[6] = split | 12; },
      [](PatchLayout& l) { l.tree[6] = 3; },
      [](PatchLayout& l) { l.tree[9] = 4; },
      [](PatchLayout& l) { l.tree[9] = 7; },
      [](PatchLayout& l) { l.tree.clear(); },
      [](PatchLayout& l) { l.area_m2.push_back(0.1); },
      [](PatchLayout& l) { l.area_m2.pop_back(); },
      [](PatchLayout& l) { l.area_m2.clear(); },
      [](PatchLayout& l) { l.area_m2[0] = -0.25; },
      [](PatchLayout& l) { l.area_m2[0] = 0.26; },
      [](PatchLayout& l) { l.area_m2[15] = std::numeric_limits<double>::infinity(); },
      [](PatchLayout& l) { l.area_m2[15] = std::numeric_limits<double>::quiet_NaN(); },
  };
  for (std::size_t k = 0; k < changes.size(); ++k) {
    PatchLayout layout = split_layout();
    changes[k](layout);
    EXPECT_THROW((void)rebuild_patches(scene, layout), std::invalid_argument) << "change " << k;
  }
}

TEST(PatchLayout, AnyNumbersAreEitherRefusedOrWholePatches) {
  const scenes::Scene scene = sheet_and_triangle();
  base::Rng rng(base::Key(1, base::Stream::Test, 0));
  int refused = 0;
  for (int round = 0; round < 20000; ++round) {
    PatchLayout layout = split_layout();
    std::vector<std::uint32_t>* columns[] = {
        &layout.s_count, &layout.t_count,    &layout.first_front, &layout.first_back,
        &layout.leaves,  &layout.tree_start, &layout.tree};
    for (int change = 0; change < 2; ++change) {
      std::vector<std::uint32_t>& column = *columns[static_cast<std::size_t>(rng.next() * 7.0)];
      const double small = rng.next() < 0.8 ? 16.0 : 4294967296.0;
      const std::uint32_t mark = rng.next() < 0.3 ? split : 0;
      column[static_cast<std::size_t>(rng.next() * static_cast<double>(column.size()))] =
          mark | static_cast<std::uint32_t>(rng.next() * small);
    }
    try {
      const Patches patches = rebuild_patches(scene, layout);
      for (const std::uint32_t facet : patches.facet) ASSERT_LT(facet, 2U);
    } catch (const std::invalid_argument&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 15000);
}

// Every pair's first half is the next pair; areas are correct.
PatchLayout chain(std::uint32_t levels) {
  PatchLayout layout = split_layout();
  layout.tree = {split | 1};
  std::vector<double> side;
  double area = 1.0;
  for (std::uint32_t level = 1; level <= levels; ++level) {
    const auto next = static_cast<std::uint32_t>(layout.tree.size() + 2);
    const auto leaf = static_cast<std::uint32_t>(side.size());
    const std::uint32_t first = level < levels ? split | next : leaf + 1;
    layout.tree.insert(layout.tree.end(), {first, leaf});
    area /= 2.0;
    side.push_back(area);
  }
  side.push_back(area);
  layout.leaves[0] = layout.first_back[0] = static_cast<std::uint32_t>(side.size());
  layout.first_front[1] = 2 * layout.leaves[0];
  layout.area_m2 = side;
  layout.area_m2.insert(layout.area_m2.end(), side.begin(), side.end());
  layout.area_m2.insert(layout.area_m2.end(), {0.25, 0.75});
  return layout;
}

TEST(PatchLayout, ATreeMayBeDeepButNotBottomless) {
  const scenes::Scene scene = sheet_and_triangle();
  EXPECT_EQ(rebuild_patches(scene, chain(20)).count(), 2U * (20 + 1) + 2);
  EXPECT_THROW((void)rebuild_patches(scene, chain(100)), std::invalid_argument);
}

}  // namespace
}  // namespace earthshine::radiosity
