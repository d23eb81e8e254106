// SPDX-License-Identifier: Apache-2.0
// Illuminance of patches by a sky in parts, against the undivided sky and against quadrature.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/sky/sky_cells.h"
#include "tests/support/scene_builder.h"
#include "tests/support/sky_in_parts.h"

namespace earthshine::radiosity {
namespace {

using base::pi;

constexpr double float_step = 0x1p-24;  // rounding of a float, relative

SolveOptions plain(int rays) {
  SolveOptions options;
  options.patch_edge_m = 0.25;
  options.form_factor_rays = rays;
  return options;
}

// A single plate of 1 m: 16 patches of equal area.
scenes::Scene lone_plate() {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  return builder.scene;
}

// Mean over the patches, which have equal areas.
std::vector<double> mean_direct(const scenes::Scene& scene, const SolveOptions& options) {
  const Solution solution = tests::Prepared(scene).solve(options);
  std::vector<double> means(solution.columns / 3, 0.0);
  const double count = double(solution.patches.count());
  for (std::size_t k = 0; k < solution.direct_lx.size(); k += 3) {
    means[k % solution.columns / 3] += double(solution.direct_lx[k]) / count;
  }
  return means;
}

// The same rays hit the same Earth: each of `cells` floats is rounded once, the sum once more.
TEST(SkyParts, CellsAddUpToTheWholeEarthOnEveryPatch) {
  for (const double half_angle_deg : {10.0, 69.6}) {  // from 30,000 km, and from 425 km
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(0.6));
    builder.plate(m, 2.0, 0.0, true);
    builder.plate(m, 1.0, 0.7, true);  // in between: a shadow, and reflected light
    builder.quad(m, {1, -1, 0}, {1, -1, 2}, {1, 1, 2}, {1, 1, 0});
    builder.scene.earth = tests::even_earth({-0.3, 0.4, 1.0}, half_angle_deg, 100.0);
    const scenes::Scene cells = tests::in_parts(builder.scene, 48);
    const scenes::Scene halves = tests::in_parts(builder.scene, 2);
    const Solution parts = tests::Prepared(cells).solve(plain(512));
    const Solution coarse = tests::Prepared(halves).solve(plain(512));
    const std::size_t count = parts.columns / 3;
    ASSERT_EQ(count, cells.sky_parts->cells->count());
    ASSERT_EQ(parts.patches.count(), coarse.patches.count());
    double brightest = 0.0;
    for (std::size_t p = 0; p < parts.patches.count(); ++p) {
      const auto sum = [p](const Solution& from, const std::vector<float>& values) {
        double all = 0.0;
        for (std::size_t k = 0; k < from.columns; k += 3) {
          all += double(values[p * from.columns + k]);
        }
        return all;
      };
      const double fine = sum(parts, parts.direct_lx);
      brightest = std::max(brightest, fine);
      EXPECT_NEAR(fine, sum(coarse, coarse.direct_lx), 2.0 * float_step * fine);
      // The solver stops at 1e-8 of the brightest patch for every group.
      EXPECT_NEAR(sum(parts, parts.radiosity), sum(coarse, coarse.radiosity),
                  2.0 * float_step * fine + 1e-8 * double(count) * 100.0 * pi);
    }
    EXPECT_GT(brightest, 1.0);
    if (half_angle_deg < 18.0) continue;  // an undivided narrow Earth is sampled by other rays
    const Solution whole = tests::Prepared(builder.scene).solve(plain(512));
    for (std::size_t p = 0; p < whole.patches.count(); ++p) {
      double fine = 0.0;
      for (std::size_t k = 0; k < parts.columns; k += 3) {
        fine += double(parts.direct_lx[p * parts.columns + k]);
      }
      EXPECT_NEAR(fine, double(whole.direct_lx[3 * p]), 2.0 * float_step * fine);
    }
  }
}

// E of cell k is the integral of L cos(theta) over it, here by 200 x 200 midpoints. The plate is
// open: of its cosine-distributed rays a share p = E / (pi L) hits the cell, with an error of
// sqrt(p (1 - p) / rays); stratified rays have less.
TEST(SkyParts, EachCellGivesItsOwnIlluminance) {
  for (const double half_angle_deg : {12.0, 69.6}) {
    scenes::Scene scene = lone_plate();
    const double radiance = 100.0;
    scene.earth = tests::even_earth({0.6, 0.2, 0.8}, half_angle_deg, radiance);
    scene = tests::in_parts(scene, 24);
    const scenes::SkyCells& cells = *scene.sky_parts->cells;
    const std::vector<double> found = mean_direct(scene, plain(4096));
    ASSERT_EQ(found.size(), cells.count());
    std::size_t cell = 0;
    for (std::size_t ring = 0; ring < cells.sectors().size(); ++ring) {
      const double from = ring == 0 ? 1.0 : std::cos(cells.bounds_rad()[ring - 1]);
      const double size = 2.0 * pi * (from - std::cos(cells.bounds_rad()[ring])) /
                          static_cast<double>(cells.sectors()[ring]);
      for (std::size_t k = 0; k < cells.sectors()[ring]; ++k, ++cell) {
        double mean = 0.0;
        cells.visit(cell, 200, [&](const Vec3& d) { mean += std::max(0.0, d.z) / 40000.0; });
        const double exact = radiance * size * mean, p = exact / (pi * radiance);
        const double error = pi * radiance * std::sqrt(p * (1.0 - p) / (16.0 * 4096.0));
        EXPECT_NEAR(found[cell], exact, 4.0 * error + 1e-9) << cell << " at " << half_angle_deg;
      }
    }
  }
}

// A point Sun over an unshadowed plate: E cos(theta) for any sample points.
TEST(SkyParts, APointSunIsThatOfTheScene) {
  scenes::Scene scene = lone_plate();
  scenes::Sun sun;
  sun.direction = glm::normalize(Vec3(1, 2, 3));
  sun.angular_radius_deg = 0.0;
  sun.illuminance_lx = Rgb(1000.0);
  scene.sun = sun;
  const double whole = mean_direct(scene, plain(64)).front();
  const double part = mean_direct(tests::in_parts(scene, 2), plain(64)).front();
  EXPECT_NEAR(whole, 1000.0 * sun.direction.z, 1000.0 * float_step);
  EXPECT_NEAR(part, whole, 1000.0 * float_step);
}

// A Sun of 5 deg and a screen that hides it from part of the plate. The Suns have different random
// numbers: their means over 24 seeds agree within four standard errors.
TEST(SkyParts, AWideSunThrowsTheSameShadow) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.0));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 0.55, 0.5, true);
  scenes::Sun sun;
  sun.direction = glm::normalize(Vec3(0.2, 0.1, 1));
  sun.angular_radius_deg = 5.0;
  sun.illuminance_lx = Rgb(1000.0);
  builder.scene.sun = sun;
  const scenes::Scene parts = tests::in_parts(builder.scene, 2);
  constexpr int seeds = 24;
  double sum = 0.0, squares = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    SolveOptions options = plain(16);
    options.seed = static_cast<std::uint64_t>(seed);
    const auto plate = [&options](const scenes::Scene& scene) {
      return tests::Prepared(scene).solve(options).report.objects[0].illuminance_lx.g;
    };
    const double difference = plate(parts) - plate(builder.scene);
    sum += difference;
    squares += difference * difference;
  }
  const double error = std::sqrt((squares - sum * sum / seeds) / (seeds * (seeds - 1.0)));
  EXPECT_GT(error, 0.0);
  EXPECT_LT(error, 1000.0 * 0.01);
  EXPECT_NEAR(sum / seeds, 0.0, 4.0 * error);
}

}  // namespace
}  // namespace earthshine::radiosity
