// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/sky_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/numbers/random.h"

namespace earthshine::scenes {
namespace {

using base::pi;

double solid_angle_sr(const SkyCells& cells, std::size_t ring) {
  const double from = ring == 0 ? 1.0 : std::cos(cells.bounds_rad()[ring - 1]);
  return 2.0 * pi * (from - std::cos(cells.bounds_rad()[ring])) /
         static_cast<double>(cells.sectors()[ring]);
}

// For every cell, in the order of their indices.
std::vector<double> solid_angles_sr(const SkyCells& cells) {
  std::vector<double> all;
  for (std::size_t ring = 0; ring < cells.sectors().size(); ++ring) {
    all.insert(all.end(), cells.sectors()[ring], solid_angle_sr(cells, ring));
  }
  return all;
}

// Caps from the Earth seen from a million kilometres to the whole sphere, about axes in all
// directions.
std::vector<SkyCells> many_cells() {
  std::vector<SkyCells> all;
  const Vec3 axes[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {1, 2, -3}, {-1e-9, 0, -1}};
  for (const Vec3& axis : axes) {
    const Vec3 unit = glm::normalize(axis);
    for (const double half_angle : {6e-3, 0.3, 1.2, 1.57}) {
      for (const std::size_t wanted : {2, 3, 48, 500}) {
        all.push_back(cells_of_disc(unit, half_angle, wanted));
      }
    }
    all.emplace_back(axis, std::vector{pi}, std::vector<std::size_t>{1});
    all.emplace_back(axis, std::vector{0.5, 2.0, pi}, std::vector<std::size_t>{1, 7, 2});
  }
  for (const std::size_t wanted : {2, 5, 192, 1000}) all.push_back(cells_of_sphere(wanted));
  return all;
}

TEST(SkyCells, WhatACellVisitsBelongsToItAndToTheCap) {
  constexpr int side = 6;
  for (const SkyCells& cells : many_cells()) {
    const double half_angle = cells.bounds_rad().back();
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
      int visited = 0;
      cells.visit(cell, side, [&](const Vec3& direction) {
        ++visited;
        EXPECT_NEAR(glm::length(direction), 1.0, 1e-12);
        EXPECT_GE(glm::dot(direction, cells.axis()), std::cos(half_angle) - 1e-15);
        EXPECT_EQ(cells.cell_of(direction), cell) << cells.count() << ' ' << half_angle;
      });
      EXPECT_EQ(visited, side * side);
    }
  }
}

// From edge to edge: the outermost directions are at the rings' bounds, all of them within the
// cell.
TEST(SkyCells, TheLatticeReachesTheEdges) {
  for (const SkyCells& cells : many_cells()) {
    std::size_t cell = 0;
    for (std::size_t ring = 0; ring < cells.sectors().size(); ++ring) {
      for (std::size_t k = 0; k < cells.sectors()[ring]; ++k, ++cell) {
        double lowest = 1.0, highest = -1.0;
        int visited = 0;
        cells.visit_lattice(cell, 3, [&](const Vec3& direction) {
          ++visited;
          EXPECT_EQ(cells.cell_of(direction), cell);
          lowest = std::min(lowest, glm::dot(direction, cells.axis()));
          highest = std::max(highest, glm::dot(direction, cells.axis()));
        });
        EXPECT_EQ(visited, 16);
        EXPECT_NEAR(lowest, std::cos(cells.bounds_rad()[ring]), 2.1e-8);
        EXPECT_NEAR(highest, ring == 0 ? 1.0 : std::cos(cells.bounds_rad()[ring - 1]), 2.1e-8);
      }
    }
  }
}

// dot(axis, d) and 1 are linear in 1 - cos, in which the steps are equal, so that the midpoint rule
// is exact: the sum over cells of solid angle times mean is pi sin^2 h and 2 pi (1 - cos h).
TEST(SkyCells, CellsAddUpToTheCap) {
  for (const SkyCells& cells : many_cells()) {
    const double h = cells.bounds_rad().back();
    const std::vector<double> sizes = solid_angles_sr(cells);
    ASSERT_EQ(sizes.size(), cells.count());
    double whole = 0.0, projected = 0.0;
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
      double mean = 0.0;
      cells.visit(cell, 3, [&](const Vec3& d) { mean += glm::dot(d, cells.axis()) / 9.0; });
      whole += sizes[cell];
      projected += sizes[cell] * mean;
    }
    const double exact = 4.0 * pi * std::pow(std::sin(h / 2), 2);
    EXPECT_NEAR(whole / exact, 1.0, 1e-9) << h;
    EXPECT_NEAR(projected, pi * std::pow(std::sin(h), 2), 1e-9 * exact) << h;
  }
}

// Directions uniform over the cap fall into each cell in proportion to its solid angle, within four
// binomial standard errors (plus one direction, for cells with few).
TEST(SkyCells, EvenDirectionsFallIntoCellsBySolidAngle) {
  constexpr int count = 40000;
  for (const SkyCells& cells :
       {cells_of_disc(glm::normalize(Vec3(1, 2, -3)), 1.2, 48), cells_of_sphere(192),
        SkyCells({0, 1, 0}, {0.5, 2.0, pi}, {1, 7, 2})}) {
    const double h = cells.bounds_rad().back();
    const base::Frame3 frame = base::frame_around(cells.axis());
    std::vector<int> met(cells.count(), 0);
    base::Rng rng(base::Key(1, base::Stream::Test, cells.count()));
    for (int k = 0; k < count; ++k) {
      const double z = 1.0 - rng.next() * (1.0 - std::cos(h)), phi = 2.0 * pi * rng.next();
      const double sine = std::sqrt(1.0 - z * z);
      const std::size_t cell =
          cells.cell_of(frame.to_world({sine * std::cos(phi), sine * std::sin(phi), z}));
      ASSERT_LT(cell, cells.count());
      ++met[cell];
    }
    const std::vector<double> sizes = solid_angles_sr(cells);
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
      const double share = sizes[cell] / (2.0 * pi * (1.0 - std::cos(h)));
      const double error = std::sqrt(share * (1.0 - share) / count);
      EXPECT_NEAR(double(met[cell]) / count, share, 4.0 * error + 1.0 / count) << cell;
    }
  }
}

TEST(SkyCells, OutsideTheCapTheLastRingIsMeant) {
  const SkyCells cells = cells_of_disc({0, 0, 1}, 0.5, 48);
  const std::size_t last_ring = cells.count() - cells.sectors().back();
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, -1)}) {
    EXPECT_GE(cells.cell_of(direction), last_ring);
    EXPECT_LT(cells.cell_of(direction), cells.count());
  }
}

// Each ring's number of sectors is rounded, by at most a half, to one or more; rings of less than
// one sector are rare.
TEST(SkyCells, AsManyAsWanted) {
  EXPECT_EQ(cells_of_disc({0, 0, 1}, 1.2, 2).count(), 2U);
  EXPECT_EQ(cells_of_sphere(2).count(), 2U);
  for (const std::size_t wanted : {4, 12, 48, 192, 1000, 4096}) {
    for (const double half_angle : {0.01, 0.5, 1.2, 1.57}) {
      const SkyCells disc = cells_of_disc({0, 0, 1}, half_angle, wanted);
      EXPECT_NEAR(double(disc.count()), double(wanted), double(disc.sectors().size()))
          << half_angle;
    }
    const SkyCells sphere = cells_of_sphere(wanted);
    EXPECT_NEAR(double(sphere.count()), double(wanted), double(sphere.sectors().size()));
  }
}

// Rings of equal width w with sectors as wide as high at their middle have equal sizes except for
// rounding n to an integer: a factor of (n + 1/2) / n, with n = pi sin(w/2) 2 / w of about 3 at the
// poles.
TEST(SkyCells, CellsOfTheSphereAreNearlyOfOneSize) {
  for (const std::size_t wanted : {100, 192, 1000}) {
    const SkyCells cells = cells_of_sphere(wanted);
    const double mean = 4.0 * pi / static_cast<double>(cells.count());
    for (const double size : solid_angles_sr(cells)) EXPECT_NEAR(size / mean, 1.0, 0.5 / 3.0 + 0.1);
  }
}

// From 425 km the ground within 60 deg of the middle covers some 7 of the 20 deg of the cap: equal
// steps of it are narrow rings at the limb.
TEST(SkyCells, RingsNarrowTowardTheLimb) {
  const SkyCells cells = cells_of_disc({0, 0, 1}, std::asin(6371.0 / 6796.0), 48);
  double before = pi, from = 0.0;
  for (const double bound : cells.bounds_rad()) {
    EXPECT_LT(bound - from, before);
    before = bound - from;
    from = bound;
  }
}

}  // namespace
}  // namespace earthshine::scenes
