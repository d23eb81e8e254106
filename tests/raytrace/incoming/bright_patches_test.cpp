// SPDX-License-Identifier: Apache-2.0
#include "raytrace/incoming/bright_patches.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/numbers/random.h"
#include "radiosity/patches/patches.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

constexpr double edge_m = 0.05;

// Small squares above a dark floor, facing down; each is a patch with its own radiosity.
struct Squares {
  struct Square {
    Vec3 middle;
    double radiosity;
  };
  explicit Squares(const std::vector<Square>& squares) : all(squares) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(0.5));
    builder.plate(m, 4.0, -1.0, true);
    for (const auto& [at, b] : squares) {
      const double h = edge_m / 2;
      builder.quad(m, at + Vec3(-h, -h, 0), at + Vec3(-h, h, 0), at + Vec3(h, h, 0),
                   at + Vec3(h, -h, 0));
    }
    solution.patches = radiosity::subdivide(builder.scene, 10.0);
    solution.columns = 3;
    for (std::uint32_t i = 0; i < solution.patches.count(); ++i) {
      const float b = i == 0 ? 0.0F : static_cast<float>(squares[i - 1].radiosity);
      solution.radiosity.insert(solution.radiosity.end(), {b, b, b});
    }
  }
  // dE / B of a point of a square, times its area.
  static double geometry(const BrightPatches::Place& from, const Vec3& point) {
    const Vec3 way = point - from.position;
    const double d2 = glm::dot(way, way);
    return edge_m * edge_m * std::max(0.0, glm::dot(way, from.normal)) * std::max(0.0, way.z) /
           (base::pi * d2 * d2);
  }
  // The probability of aiming at the patch of a point, from the density there.
  static double probability(const BrightPatches& bright, const BrightPatches::Place& from,
                            std::uint32_t patch, const Vec3& point) {
    const Vec3 way = point - from.position;
    const double d = glm::length(way), cosine = way.z / d;
    return bright.density_per_sr(from, patch, d, cosine) * edge_m * edge_m * cosine / (d * d);
  }
  std::vector<Square> all;
  radiosity::Solution solution;
};

const std::vector<Squares::Square> several = {
    {{0.3, 0.1, 0.5}, 900.0},   {{-0.6, 0.4, 1.5}, 4000.0},
    {{0.1, -0.8, 0.7}, 2000.0}, {{-0.2, -0.3, 0.2}, 300.0},
    {{0.9, 0.9, 1.0}, 1500.0},  {{0.2, 0.0, -0.5}, 5000.0}};  // below the place
const BrightPatches::Place slanted = {Vec3(0.0), glm::normalize(Vec3(0.2, -0.3, 1.0))};

// E = sum of B dA cos cos / (pi d^2), by a midpoint rule of 64 x 64 points a square.
TEST(BrightPatches, AimedRaysBringWhatAllOfThemSend) {
  const Squares squares(several);
  const BrightPatches bright(squares.solution);
  double exact = 0.0;
  constexpr int points = 64;
  for (const auto& [at, radiosity] : squares.all) {
    for (int k = 0; k < points * points; ++k) {
      const Vec3 point = at + edge_m * Vec3((k % points + 0.5) / points - 0.5,
                                            (double(k / points) + 0.5) / points - 0.5, 0.0);
      exact += radiosity * Squares::geometry(slanted, point) / (points * points);
    }
  }
  base::Rng rng(base::Key(1, base::Stream::LightSample, 0));
  constexpr int tries = 20000;
  double sum = 0.0, squared = 0.0;
  std::vector<int> picked(several.size() + 1, 0);
  std::vector<double> expected(several.size() + 1, 0.0);
  for (int k = 0; k < tries; ++k) {
    const double choice = rng.next(), x = rng.next(), y = rng.next();
    const auto aimed = bright.aim(slanted, choice, x, y);
    ASSERT_TRUE(aimed.has_value());
    const double p = Squares::probability(bright, slanted, aimed->patch, aimed->point);
    ++picked[aimed->patch];
    expected[aimed->patch] = p;
    const double e =
        squares.all[aimed->patch - 1].radiosity * Squares::geometry(slanted, aimed->point) / p;
    sum += e / tries;
    squared += e * e / tries;
  }
  EXPECT_NEAR(sum, exact, 4.0 * std::sqrt((squared - sum * sum) / (tries - 1)));
  double all = 0.0;
  for (std::size_t k = 1; k < picked.size(); ++k) {
    EXPECT_NEAR(picked[k], tries * expected[k],
                4.0 * std::sqrt(tries * expected[k] * (1.0 - expected[k])) + 1e-9);
    all += expected[k];
  }
  EXPECT_NEAR(all, 1.0, 1e-12);
}

// A square at height h and horizontal distance x sends B cos / d^2 = B h / (x^2 + h^2)^(3/2).
TEST(BrightPatches, OfTwoTheNearerIsAimedAtAsMuchMoreAsItSends) {
  const Squares squares({{{0.1, 0.0, 0.2}, 1000.0}, {{-0.1, 0.0, 2.0}, 1000.0}});
  const BrightPatches bright(squares.solution);
  const BrightPatches::Place from = {Vec3(0.0), Vec3(0, 0, 1)};
  const double near = 0.2 / std::pow(0.01 + 0.04, 1.5), far = 2.0 / std::pow(0.01 + 4.0, 1.5);
  EXPECT_NEAR(Squares::probability(bright, from, 1, squares.all[0].middle), near / (near + far),
              1e-12);
  EXPECT_NEAR(Squares::probability(bright, from, 2, squares.all[1].middle), far / (near + far),
              1e-12);
}

TEST(BrightPatches, WhatIsBehindTheSurfaceIsNotAimedAt) {
  const Squares squares(several);
  const BrightPatches bright(squares.solution);
  const BrightPatches::Place above = {Vec3(0.0, 0.0, 3.0), Vec3(0, 0, 1)};
  EXPECT_FALSE(bright.aim(above, 0.5, 0.5, 0.5).has_value());
  EXPECT_EQ(bright.density_per_sr(above, 1, 1.0, 1.0), 0.0);
  const BrightPatches::Place between = {Vec3(0.0, 0.0, 1.2), Vec3(0, 0, 1)};
  for (const double choice : {0.0, 0.5, 0.999}) {
    const auto aimed = bright.aim(between, choice, 0.5, 0.5);
    ASSERT_TRUE(aimed.has_value());
    EXPECT_EQ(aimed->patch, 2U);  // the only one above it
  }
}

// For any place, in the boxes of the tree or beside a square: the remainder of the probabilities to
// 1 is not aimed, if a box has a corner above the surface and neither of its halves has one.
TEST(BrightPatches, WhatProbabilitiesLackIsAimedAtNothing) {
  const Squares squares(several);
  const BrightPatches bright(squares.solution);
  base::Rng rng(base::Key(2, base::Stream::LightSample, 0));
  for (const Vec3& at : {Vec3(0.1, 0.1, 0.6), Vec3(-0.2, -0.3, 0.199), Vec3(0.0, 0.0, -0.6)}) {
    for (const Vec3& normal : {Vec3(0, 0, 1), glm::normalize(Vec3(1, -2, 0.3))}) {
      const BrightPatches::Place from = {at, normal};
      double all = 0.0;
      for (std::uint32_t k = 1; k <= several.size(); ++k) {
        all += bright.density_per_sr(from, k, 1.0, 1.0) * edge_m * edge_m;  // probability / area
      }
      EXPECT_LE(all, 1.0 + 1e-12);
      constexpr int tries = 4000;
      int aimed_at = 0;
      for (int k = 0; k < tries; ++k) {
        const double choice = k == 0 ? 0.0 : k == 1 ? 1.0 - 0x1p-53 : rng.next();
        const auto aimed = bright.aim(from, choice, 0.5, 0.5);
        if (!aimed) continue;
        ++aimed_at;
        EXPECT_GT(bright.density_per_sr(from, aimed->patch, 1.0, 1.0), 0.0);
      }
      EXPECT_NEAR(aimed_at, tries * all,
                  4.0 * std::sqrt(tries * std::max(0.0, all * (1.0 - all))) + 2.0);
    }
  }
}

TEST(BrightPatches, AnEvenlyLitSceneHasNone) {
  Squares squares({{{0.0, 0.0, 1.0}, 1.0}});
  squares.solution.radiosity.assign(squares.solution.radiosity.size(), 1.0F);
  EXPECT_TRUE(BrightPatches(squares.solution).empty());
}

}  // namespace
}  // namespace earthshine::raytrace
