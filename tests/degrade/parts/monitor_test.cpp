// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/monitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "degrade/stage/point_map.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::flat;

constexpr Spread shapes[] = {Spread::None, Spread::Gaussian, Spread::Triangle, Spread::Sinc};
constexpr double fwhm_per_sigma = 2.3548200450309493;  // 2 sqrt(2 ln 2)

// Response of the screen to a step between two resels, dark left of 0 and bright right of it.
// Positions in resels.
struct Edge {
  std::vector<double> at, light;
};
Edge edge_of(Spread spread, double width, int pixels_per_resel) {
  constexpr int resels = 60;
  Picture step = flat(resels, 1, 0.0F);
  std::fill(step.planes[0].begin() + resels / 2, step.planes[0].end(), 1.0F);
  const Picture screen =
      apply(step, spread_map(spread, width, resels, pixels_per_resel), area_average(1, 1));
  Edge edge;
  for (std::size_t i = 0; i < screen.planes[0].size(); ++i) {
    edge.at.push_back((static_cast<double>(i) + 0.5) / pixels_per_resel - resels / 2.0);
    edge.light.push_back(static_cast<double>(screen.planes[0][i]));
  }
  return edge;
}

// First crossing of a level, by linear interpolation.
double crossing(const Edge& edge, double level) {
  for (std::size_t i = 1; i < edge.at.size(); ++i) {
    if (edge.light[i] < level) continue;
    const double t = (level - edge.light[i - 1]) / (edge.light[i] - edge.light[i - 1]);
    return edge.at[i - 1] + t * (edge.at[i] - edge.at[i - 1]);
  }
  return NAN;
}

TEST(PictureGrid, WholePictureWithSquareResels) {
  const Monitor monitor;
  const auto grid = [&](int w, int h) {
    const Grid g = picture_grid(w, h, monitor);
    return std::pair{g.columns, g.rows};
  };
  EXPECT_EQ(grid(640, 480), (std::pair{400, 300}));  // 4:3 fills the screen
  EXPECT_EQ(grid(512, 512), (std::pair{300, 300}));  // square: in the middle of the screen
  EXPECT_EQ(grid(100, 400), (std::pair{75, 300}));
  EXPECT_EQ(grid(1920, 1080), (std::pair{400, 225}));  // wider: bars above and below
  EXPECT_EQ(grid(1, 1), (std::pair{300, 300}));
  EXPECT_EQ(grid(16384, 1), (std::pair{400, 1}));
  EXPECT_EQ(grid(1, 16384), (std::pair{1, 300}));
}

TEST(Spread, FlatFieldStaysFlatUpToTheBorderForEveryShape) {
  for (const Spread spread : shapes) {
    for (const double width : {0.05, 1.0, 3.3}) {
      Monitor monitor;
      monitor.spread = spread;
      monitor.spread_width = width;
      double negative = 0.0;
      const Picture out = spread_on_screen(flat(25, 3, 40.0F), monitor, negative);
      EXPECT_EQ(out.columns, 75);
      EXPECT_EQ(out.rows, 9);
      for (float value : out.planes[0]) ASSERT_FLOAT_EQ(value, 40.0F) << word_of(spread) << width;
      EXPECT_EQ(negative, 0.0);
    }
  }
}

TEST(Spread, ImpulseKeepsItsLightForEveryShape) {
  for (const Spread spread : shapes) {
    for (const std::size_t at : {0U, 12U}) {
      Picture in = flat(25, 1, 0.0F);
      in.planes[0][at] = 1.0F;
      const Picture out = apply(in, spread_map(spread, 1.4, 25, 4), area_average(1, 1));
      EXPECT_NEAR(test::moments(out.planes[0]).mean * 25.0, 1.0, 1e-6) << word_of(spread) << at;
    }
  }
}

TEST(Spread, NoneRepeatsEachResel) {
  Monitor monitor;
  monitor.spread = Spread::None;
  monitor.pixels_per_resel = 2;
  Picture in{2, 1, {{3.0F, 5.0F}}};
  double negative = 0.0;
  EXPECT_EQ(spread_on_screen(in, monitor, negative).planes[0],
            (Plane{3.0F, 3.0F, 5.0F, 5.0F, 3.0F, 3.0F, 5.0F, 5.0F}));
}

// A step of constant resels, spread by a Gaussian, is the normal distribution function; its rise
// from 10 to 90 % is 2.563 sigma.
TEST(Spread, GaussianEdgeIsTheNormalIntegral) {
  for (const double fwhm : {0.6, 1.0, 2.5}) {
    const double sigma = fwhm / fwhm_per_sigma;
    const Edge edge = edge_of(Spread::Gaussian, fwhm, 8);
    for (std::size_t i = 0; i < edge.at.size(); ++i) {
      const double expected = 0.5 * std::erfc(-edge.at[i] / (sigma * std::sqrt(2.0)));
      ASSERT_NEAR(edge.light[i], expected, 1e-6) << fwhm << " at " << edge.at[i];
    }
    EXPECT_NEAR(crossing(edge, 0.9) - crossing(edge, 0.1), 2.563 * sigma, 0.02);
  }
}

// Integral of (1 - |x| / w) / w: 1 - (1 - x/w)^2 / 2 on the right; the rise from 10 to 90 % is
// 2 w (1 - sqrt(0.2)) = 1.1056 w.
TEST(Spread, TriangleEdgeIsTwoParabolas) {
  for (const double w : {1.0, 2.0}) {
    const Edge edge = edge_of(Spread::Triangle, w, 8);
    for (std::size_t i = 0; i < edge.at.size(); ++i) {
      const double tail = std::max(0.0, 1.0 - std::abs(edge.at[i]) / w);
      const double expected = edge.at[i] < 0.0 ? tail * tail / 2.0 : 1.0 - tail * tail / 2.0;
      ASSERT_NEAR(edge.light[i], expected, 1e-6);
    }
    EXPECT_NEAR(crossing(edge, 0.9) - crossing(edge, 0.1), 1.1056 * w, 0.01);
  }
}

// 1/2 + Si(pi x / p) / pi: the rise from 10 to 90 % is 0.892 p, and the light overshoots by 8.949 %
// one zero after the edge. The window of eight zeros reduces this by 0.0025, the sampling up to
// 0.06 resels beside the peak by up to 0.002.
TEST(Spread, SincEdgeRingsAsTheSineIntegral) {
  for (const double p : {1.0, 1.5}) {
    const Edge edge = edge_of(Spread::Sinc, p, 8);
    EXPECT_NEAR((crossing(edge, 0.9) - crossing(edge, 0.1)) / p, 0.892, 0.005);
    const double overshoot = *std::max_element(edge.light.begin(), edge.light.end()) - 1.0;
    EXPECT_NEAR(overshoot, 0.08949, 0.005);
  }
}

TEST(Spread, NegativeLightOfTheSincIsCutAndCounted) {
  Monitor monitor;
  monitor.spread = Spread::Sinc;
  Picture point = flat(31, 31, 0.0F);
  point.planes[0][31 * 15 + 15] = 1.0F;
  double negative = 0.0;
  const Picture out = spread_on_screen(point, monitor, negative);
  EXPECT_GT(negative, 0.01);
  EXPECT_GE(*std::min_element(out.planes[0].begin(), out.planes[0].end()), 0.0F);
  monitor.spread = Spread::Gaussian;
  static_cast<void>(spread_on_screen(point, monitor, negative));
  EXPECT_EQ(negative, 0.0);
}

TEST(Spread, RoundSpotOfTheGaussianIsTheSameInEveryDirection) {
  Monitor monitor;
  monitor.spread_width = 3.0;
  monitor.pixels_per_resel = 5;
  Picture point = flat(41, 41, 0.0F);
  point.planes[0][41 * 20 + 20] = 1000.0F;
  double negative = 0.0;
  const Picture out = spread_on_screen(point, monitor, negative);
  const auto at = [&](int dx, int dy) {
    return static_cast<double>(
        out.planes[0][static_cast<std::size_t>((102 + dy) * 205 + 102 + dx)]);
  };
  // 3-4-5 triangles: equal distances. A resel is a square, so that a small difference remains.
  EXPECT_NEAR(at(5, 0) / at(3, 4), 1.0, 1e-3);
  EXPECT_NEAR(at(10, 0) / at(6, 8), 1.0, 4e-3);
}

Picture driven(Picture line_signal, const Monitor& m) {
  PointMap map;
  map.screen(m.black_luminance, m.white_luminance, m.gamma);
  return transform(std::move(line_signal), map);
}

// Light is added after gamma: a fine checkerboard through a wide spot has half the light of white.
// With the spread before gamma it would have 0.5^2.2 = 0.218 of it.
TEST(Screen, GammaComesBeforeTheSpread) {
  Monitor monitor;
  monitor.black_luminance = 0.0;
  monitor.spread_width = 6.0;
  Picture board = flat(40, 40, 0.0F);
  for (std::size_t i = 0; i < board.pixel_count(); ++i) {
    board.planes[0][i] = static_cast<float>((i / 40 + i % 40) % 2);
  }
  double negative = 0.0;
  const Picture out = spread_on_screen(driven(board, monitor), monitor, negative);
  EXPECT_NEAR(out.planes[0][60 * 120 + 60], 0.5 * monitor.white_luminance, 1e-3);
}

TEST(Screen, DriveIsMonotoneFromBlackToWhiteAndClampedOutside) {
  const Monitor monitor;
  const Picture light = driven(Picture{6, 1, {{-1e9F, 0.0F, 0.25F, 0.5F, 1.0F, 7.0F}}}, monitor);
  const Plane& values = light.planes[0];
  EXPECT_FLOAT_EQ(values[0], 1.0F);
  EXPECT_FLOAT_EQ(values[1], 1.0F);
  EXPECT_NEAR(values[3], 1.0 + 99.0 * std::pow(0.5, 2.2), 1e-4);
  EXPECT_FLOAT_EQ(values[4], 100.0F);
  EXPECT_FLOAT_EQ(values[5], 100.0F);
  EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
}

// A Lambertian screen of reflectance 0.05 under 50 lx: 0.05 * 50 / pi = 0.796 cd/m^2.
TEST(Screen, RoomLightIsTheLambertianReflection) {
  EXPECT_NEAR(room_luminance(Monitor{}), 0.7958, 1e-4);
}

}  // namespace
}  // namespace earthshine::degrade
