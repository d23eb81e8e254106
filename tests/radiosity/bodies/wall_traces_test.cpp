// SPDX-License-Identifier: Apache-2.0
#include "radiosity/bodies/wall_traces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "radiosity/near_lamps.h"
#include "radiosity/patches/parted_cell.h"
#include "radiosity/patches/patch_layout.h"
#include "radiosity/patches/split.h"
#include "tests/support/boxes.h"
#include "tests/support/random_cuts.h"

namespace earthshine::radiosity {
namespace {

using tests::grey;

enum class Wall { Sheet, Slanted, Pierces, ThinBox, BackToBack };
constexpr Wall walls[] = {Wall::Sheet, Wall::Slanted, Wall::Pierces, Wall::ThinBox,
                          Wall::BackToBack};

// The room [0,1]^3 divided by a wall that meets y = 0 at x = 0.37, and y = 1 also there, or at
// 0.51.
tests::SceneBuilder two_rooms(Wall wall, double diffuse = 0.6, double emit = 0.0) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(diffuse, emit));
  builder.room({m, m, m, m, m, m});
  const double at = 0.37, end = wall == Wall::Slanted ? 0.51 : at;
  // Parts of the wall beyond the room are outside, and dark.
  const double low = wall == Wall::Pierces ? -0.1 : 0.0, high = 1.0 - low;
  scenes::Material sheet = grey(diffuse, emit);
  sheet.two_sided = wall != Wall::BackToBack;
  const Vec3 a{at, low, low}, b{end, high, low}, c{end, high, high}, d{at, low, high};
  const Vec3 beside(0.001, 0.0, 0.0);
  if (wall == Wall::ThinBox) {
    tests::add_box(builder, m, {at, 0.0, 0.0}, {at + 0.01, 1.0, 1.0});
  } else {
    const std::uint32_t of_wall = builder.material(sheet);
    builder.quad(of_wall, a, d, c, b);
    if (wall == Wall::BackToBack) {
      builder.quad(of_wall, a + beside, b + beside, c + beside, d + beside);
    }
  }
  return builder;
}

scenes::Lamp lamp_in_the_small_room() {
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = {0.2, 0.5, 0.7};
  lamp.intensity_cd = Rgb(100.0);
  return lamp;
}

SolveOptions even(double edge_m, int rays = 256) {
  SolveOptions options;
  options.patch_edge_m = edge_m;
  options.form_factor_rays = rays;
  options.refine.on = false;
  return options;
}

double middle_x(const Patches& patches, std::uint32_t i) {
  const auto c = patches.corners(i);
  return 0.25 * (c[0].x + c[1].x + c[2].x + c[3].x);
}

// No path leads from the lamp into the other room: its light is exactly 0.
TEST(WallTraces, ARoomBehindAThinWallIsDark) {
  for (const Wall wall : walls) {
    tests::SceneBuilder builder = two_rooms(wall);
    builder.scene.lamps.push_back(lamp_in_the_small_room());
    const tests::Prepared prepared(builder.scene);
    for (const double edge_m : {1.0, 0.3}) {
      const Solution solution = prepared.solve(even(edge_m));
      int dark = 0;
      for (std::uint32_t i = 0; i < solution.patches.count(); ++i) {
        const auto c = solution.patches.corners(i);
        const double y = 0.25 * (c[0].y + c[1].y + c[2].y + c[3].y);
        const double wall_x = 0.37 + (wall == Wall::Slanted ? 0.14 * y : 0.0);
        const bool on_wall = std::abs(middle_x(solution.patches, i) - wall_x) < 0.011;
        if (on_wall || middle_x(solution.patches, i) < wall_x) continue;
        ++dark;
        EXPECT_EQ(solution.radiosity[i * 3], 0.0F) << int(wall) << " " << edge_m << " " << i;
      }
      EXPECT_GE(dark, 5);  // all walls of the dark room
      EXPECT_TRUE(solution.report.balance.balanced);
      ASSERT_EQ(solution.report.groups.size(), 1U);
      EXPECT_LT(solution.report.groups[0].imbalance, 1e-12);
    }
  }
}

// Two adjacent furnaces: with emission 1 - rho everywhere, B = 1 for any geometry.
TEST(WallTraces, FurnacesOnBothSidesStayUniform) {
  for (const Wall wall : walls) {
    const double gap = wall == Wall::ThinBox ? 0.01 : wall == Wall::BackToBack ? 0.001 : -1.0;
    tests::SceneBuilder builder = two_rooms(wall, 0.6, 0.4);
    const Solution solution = tests::Prepared(builder.scene).solve(even(0.3));
    ASSERT_FALSE(solution.radiosity.empty());
    for (std::uint32_t i = 0; i < solution.patches.count(); ++i) {
      const auto c = solution.patches.corners(i);
      const Vec3 middle = 0.25 * (c[0] + c[1] + c[2] + c[3]);
      if (glm::any(glm::lessThan(middle, Vec3(-1e-9))) ||
          glm::any(glm::greaterThan(middle, Vec3(1.0 + 1e-9)))) {
        continue;  // outside
      }
      if (middle.x > 0.37 && middle.x < 0.37 + gap - 1e-9) continue;  // in the wall
      EXPECT_NEAR(double(solution.radiosity[i * 3]), 1.0, 1e-6) << int(wall) << " " << i;
    }
  }
}

Patches parted(const scenes::Scene& scene, double edge_m) {
  Patches patches = subdivide(scene, edge_m);
  return part_along(patches, find_wall_traces(scene, patches));
}

// A point of a part is found in the part, its corners enclose its stated area, and the parts of a
// facet add up to the facet: on quads and triangles, after random splits.
TEST(WallTraces, PartsTileTheirFacets) {
  tests::SceneBuilder builder = two_rooms(Wall::Slanted);
  scenes::Scene& scene = builder.scene;
  const auto v = static_cast<std::uint32_t>(scene.vertices.size());
  scene.vertices.insert(scene.vertices.end(), {{0, 0, 0.5}, {1, 0.1, 0.5}, {0.2, 0.9, 0.5}});
  scene.triangles.push_back({{v, v + 1, v + 2}, 0, 0, 1000});
  const Patches even_cut = parted(scene, 0.3);
  std::size_t parts = 0;
  for (std::uint32_t i = 0; i < even_cut.count(); ++i) parts += even_cut.is_part(i) ? 1 : 0;
  EXPECT_GT(parts, 20U);
  for (std::uint64_t seed = 0; seed <= 8; ++seed) {
    const Patches patches = seed == 0 ? even_cut : tests::random_cuts(even_cut, 3, 0.3, seed);
    std::vector<double> of_facet(patches.facets.size(), 0.0);
    for (std::uint32_t i = 0; i < patches.count(); ++i) {
      const auto c = patches.corners(i);
      const double area = 0.5 * glm::length(glm::cross(c[2] - c[0], c[3] - c[1]));
      ASSERT_NEAR(area, patches.area_m2[i], 1e-12);
      if (patches.is_back[i] == 0) of_facet[patches.facet[i]] += area;
      for (const double x : {0.0, 0.3, 0.6, 1.0}) {
        for (const double y : {0.0, 0.5, 1.0}) {
          if (!patches.is_part(i) && (x * y == 0.0 || x == 1.0 || y == 1.0)) continue;
          const TrianglePlace at = patches.on_triangle(i, x, y);
          ASSERT_EQ(patches.find(at.triangle, at.u, at.v, patches.is_back[i] == 0), i);
        }
      }
    }
    for (std::size_t f = 0; f < of_facet.size(); ++f) {
      ASSERT_NEAR(of_facet[f], patches.facets[f].area_m2, 1e-12);
    }
  }
}

TEST(WallTraces, PartsComeBackFromTheirLayout) {
  const scenes::Scene scene = two_rooms(Wall::Slanted).scene;
  const Patches patches = tests::random_cuts(parted(scene, 0.3), 2, 0.3, 5);
  const Patches again = rebuild_patches(scene, layout_of(patches), find_wall_traces);
  ASSERT_EQ(again.count(), patches.count());
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    EXPECT_EQ(again.is_part(i), patches.is_part(i));
    EXPECT_EQ(again.corners(i), patches.corners(i));
  }
  EXPECT_THROW((void)rebuild_patches(scene, layout_of(patches)), std::invalid_argument);
}

// The area under a body gets no light, so that its outline divides no cell. Neither does a wall
// that runs along a facet's edge, has a gap to it, or transmits light.
TEST(WallTraces, OnlyWallsWithLightOnBothSidesPartCells) {
  const auto count = [](tests::SceneBuilder& builder) {
    return parted(builder.scene, 0.3).count() - subdivide(builder.scene, 0.3).count();
  };
  tests::SceneBuilder box;
  const std::uint32_t m = box.material(grey(0.5));
  box.room({m, m, m, m, m, m});
  tests::add_box(box, m, {0.23, 0.28, 0.0}, {0.71, 0.83, 0.4});
  EXPECT_EQ(count(box), 0U);
  tests::SceneBuilder raised;
  scenes::Material sheet = grey(0.5);
  sheet.two_sided = true;
  const std::uint32_t s = raised.material(sheet);
  raised.room({s, s, s, s, s, s});
  raised.quad(s, {0.4, 0.1, 0.1}, {0.4, 0.9, 0.1}, {0.4, 0.9, 0.9}, {0.4, 0.1, 0.9});
  EXPECT_EQ(count(raised), 0U);
  tests::SceneBuilder glass;
  glass.room({glass.material(grey(0.5)), 0, 0, 0, 0, 0});
  sheet.transmit = Rgb(0.5);
  const std::uint32_t g = glass.material(sheet);
  glass.quad(g, {0.4, 0, 0}, {0.4, 1, 0}, {0.4, 1, 1}, {0.4, 0, 1});
  EXPECT_EQ(count(glass), 0U);
}

// A wall of many pieces, as in a finely divided mesh, divides cells like a wall of one piece.
TEST(WallTraces, PiecesOfOneWallAreOneWall) {
  const auto cells = [](int pieces) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(grey(0.5));
    builder.room({m, m, m, m, m, m});
    scenes::Material sheet = grey(0.5);
    sheet.two_sided = true;
    const std::uint32_t s = builder.material(sheet);
    for (int k = 0; k < pieces; ++k) {
      const double y0 = double(k) / pieces, y1 = double(k + 1) / pieces;
      builder.quad(s, {0.37, y0, 0}, {0.37, y1, 0}, {0.37, y1, 1}, {0.37, y0, 1});
    }
    const Patches patches = parted(builder.scene, 0.25);
    std::size_t parts = 0;
    for (std::uint32_t i = 0; i < patches.count(); ++i) {
      parts += patches.is_part(i) && patches.object(i) == 4 ? 1 : 0;  // of the floor
    }
    return parts;
  };
  EXPECT_EQ(cells(1), 8U);
  EXPECT_EQ(cells(9), 8U);
  EXPECT_EQ(cells(200), 8U);
}

// A line through a corner of a part crosses the border twice there. A part with collinear corners
// has no area and would cast rays from nowhere.
TEST(PartedCell, WallsThroughCornersLeavePartsWithArea) {
  Facet facet;
  facet.parallelogram = true;
  facet.a = Vec3(1.0, 0.0, 0.0), facet.b = Vec3(0.0, 1.0, 0.0);
  facet.s_count = facet.t_count = 1;
  const auto wall = [](const PlanePoint& from, const PlanePoint& to) {
    const PlanePoint along = to - from, way{-along.y, along.x};
    return Trace{from, to, way, glm::dot(way, from), Vec3(way.x, way.y, 0.0), false};
  };
  const PlanePoint a{0, 0}, b{1, 0}, c{1, 1}, d{0, 1}, middle{0.5, 0.5};
  for (const std::vector<Trace>& walls :
       {std::vector{wall(a, c)}, std::vector{wall(a, c), wall(b, d)},
        std::vector{wall(c, a), wall(middle, d), wall({0.25, 0.25}, d), wall(b, {0.25, 0.25})},
        std::vector{wall({0.5, 0}, {0.5, 1}), wall(a, middle), wall(middle, c), wall(d, b)}}) {
    const PartedCell parted = part_cell(facet, {}, walls);
    ASSERT_GT(parted.outlines.size(), walls.size());  // each divides the remaining area
    double all = 0.0;
    for (const Outline& o : parted.outlines) {
      const auto twice = [&](std::size_t k) {
        const PlanePoint u = o[k] - o[0], v = o[k + 1] - o[0];
        return u.x * v.y - u.y * v.x;
      };
      const double area = 0.5 * (twice(1) + twice(2));
      EXPECT_GT(area, 1e-4);
      all += area;
    }
    EXPECT_NEAR(all, 1.0, 1e-14);
  }
}

}  // namespace
}  // namespace earthshine::radiosity
