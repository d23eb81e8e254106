// SPDX-License-Identifier: Apache-2.0
#include "studies/sight/johnson.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/units.h"

namespace earthshine::studies {
namespace {

TEST(Johnson, HalfOfAllDoItWithTheCyclesNeeded) {
  const CyclesNeeded needed;
  EXPECT_DOUBLE_EQ(johnson_probability(1.0, needed).detect, 0.5);
  EXPECT_DOUBLE_EQ(johnson_probability(4.0, needed).recognise, 0.5);
  EXPECT_DOUBLE_EQ(johnson_probability(6.4, needed).identify, 0.5);
}

TEST(Johnson, FollowsTheTargetTransferFunction) {
  // r = 2: q = 4.1, 2^4.1 = 17.148; r = 1/2: q = 3.05, 2^-3.05 = 0.12074.
  EXPECT_NEAR(johnson_probability(2.0, 1.0), 17.148 / 18.148, 1e-5);
  EXPECT_NEAR(johnson_probability(3.2, 6.4), 0.12074 / 1.12074, 1e-5);
  EXPECT_EQ(johnson_probability(0.0, 1.0), 0.0);
  EXPECT_EQ(johnson_probability(1e6, 1.0), 1.0);
  double before = 0.0;
  for (double cycles = 0.01; cycles < 30.0; cycles *= 1.1) {
    const Probability p = johnson_probability(cycles, CyclesNeeded{});
    EXPECT_GE(p.detect, p.recognise);
    EXPECT_GE(p.recognise, p.identify);
    EXPECT_GE(p.identify, before);
    before = p.identify;
  }
}

// The pixels of a picture of 200 x 100 whose centres satisfy inside(x, y).
template <class F>
std::vector<std::uint32_t> pixels_of(F inside) {
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t y = 0; y < 100; ++y) {
    for (std::uint32_t x = 0; x < 200; ++x) {
      if (inside(x + 0.5 - 100.0, y + 0.5 - 50.0)) pixels.push_back(y * 200 + x);
    }
  }
  return pixels;
}

scenes::Camera camera_of_40_deg() {
  scenes::Camera camera;
  camera.look_at = Vec3(1.0, 0.0, 0.0);
  camera.fov_deg = 40.0;
  return camera;
}

Extent extent_of(const std::vector<std::uint32_t>& pixels) {
  return least_extent(pixels, camera_of_40_deg(), 200, 100);
}

TEST(LeastExtent, OfRectanglesIsTheShorterSide) {
  const Extent flat =
      extent_of(pixels_of([](double x, double y) { return std::abs(x) < 30 && std::abs(y) < 5; }));
  EXPECT_NEAR(flat.pixels, 10.0, 1e-12);
  EXPECT_NEAR(std::abs(std::sin(flat.direction_rad)), 1.0, 1e-12);  // across the two lines
  const Extent upright =
      extent_of(pixels_of([](double x, double y) { return std::abs(x) < 4 && std::abs(y) < 20; }));
  EXPECT_NEAR(upright.pixels, 8.0, 1e-12);
  EXPECT_NEAR(std::abs(std::cos(upright.direction_rad)), 1.0, 1e-12);
}

TEST(LeastExtent, OfASlantedStripIsItsWidth) {
  // Corners of pixels extend beyond the strip by up to (cos + sin) / 2 on each side.
  const double c = std::cos(0.6), s = std::sin(0.6);
  const Extent strip = extent_of(pixels_of([&](double x, double y) {
    return std::abs(c * x + s * y) < 40 && std::abs(c * y - s * x) < 4;
  }));
  EXPECT_GT(strip.pixels, 7.5);
  EXPECT_LT(strip.pixels, 8.0 + c + s);
  EXPECT_NEAR(std::abs(std::sin(strip.direction_rad - 0.6)), 1.0, 1e-3);
}

TEST(LeastExtent, OfADiscIsItsDiameterAndOfOnePixelOne) {
  EXPECT_NEAR(extent_of(pixels_of([](double x, double y) { return x * x + y * y < 400; })).pixels,
              40.0, 0.5);
  EXPECT_NEAR(extent_of({5050}).pixels, 1.0, 1e-12);
}

TEST(LeastExtent, OfPixelsFarApartIsThatOfTheirArea) {
  // Nine pixels over 80 x 80: the disc of their area has a diameter of 2 sqrt(9 / pi).
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t y = 10; y < 100; y += 40) {
    for (std::uint32_t x = 10; x < 100; x += 40) pixels.push_back(y * 200 + x);
  }
  EXPECT_NEAR(extent_of(pixels).pixels, 2.0 * std::sqrt(9.0 / base::pi), 1e-12);
}

TEST(LeastExtent, AngleIsThatBetweenTheRaysToItsEnds) {
  // 20 of 100 rows in the middle of 40 degrees.
  const Extent extent =
      extent_of(pixels_of([](double x, double y) { return std::abs(x) < 30 && std::abs(y) < 10; }));
  EXPECT_NEAR(extent.angle_deg, base::degrees(2.0 * std::atan(0.2 * std::tan(base::radians(20.0)))),
              1e-9);
}

// A plate of 50 columns by 40 rows with fx = 500 and fy = 200 is 0.1 wide and 0.2 high at unit
// distance: its width is the shorter side, 0.1 * 200 heights of a pixel.
TEST(LeastExtent, ComparesLengthsInTheScene) {
  scenes::Camera camera = camera_of_40_deg();
  camera.columns = 200;
  camera.rows = 100;
  camera.intrinsics = {500.0, 200.0, 100.0, 50.0};
  const auto plate =
      pixels_of([](double x, double y) { return std::abs(x) < 25 && std::abs(y) < 20; });
  const Extent extent = least_extent(plate, camera, 200, 100);
  EXPECT_NEAR(extent.pixels, 20.0, 1e-9);
  EXPECT_NEAR(std::abs(std::cos(extent.direction_rad)), 1.0, 1e-12);
  EXPECT_NEAR(extent.angle_deg, base::degrees(2.0 * std::atan(0.05)), 1e-9);
}

TEST(Eye, ThresholdsAreThoseOfThePublishedLaw) {
  // x = 2: 10^(2 - 1.255); x = -5: 10^-2.86; x = -1: rods, 10^(-1 - 0.395); x = 0: cones,
  // 0.65^2.7 - 0.72 = -0.40749.
  EXPECT_NEAR(threshold_difference(100.0), std::pow(10.0, 0.745), 1e-9);
  EXPECT_NEAR(threshold_difference(1e-5), std::pow(10.0, -2.86), 1e-9);
  EXPECT_NEAR(threshold_difference(0.1), std::pow(10.0, -1.395), 1e-9);
  EXPECT_NEAR(threshold_difference(1.0), std::pow(10.0, -0.40749), 1e-5);
  EXPECT_EQ(threshold_difference(0.0), threshold_difference(1e-5));
  // The parts are continuous within 4 % at each joint, the rounding of the law.
  for (const double x : {-3.94, -1.44, -0.0184, 1.9}) {
    EXPECT_NEAR(threshold_difference(std::pow(10.0, x - 1e-6)) /
                    threshold_difference(std::pow(10.0, x + 1e-6)),
                1.0, 0.04);
  }
}

TEST(Eye, AcuityIsThatOfThePublishedLaw) {
  // atan(0.35) = 0.33667, atan(4.55) = 1.35447, atan(-3.85) = -1.31667.
  EXPECT_NEAR(acuity_cycles_per_deg(1.0), 17.25 * 0.33667 + 25.72, 1e-3);
  EXPECT_NEAR(acuity_cycles_per_deg(1000.0), 17.25 * 1.35447 + 25.72, 1e-3);
  EXPECT_NEAR(acuity_cycles_per_deg(1e-3), 25.72 - 17.25 * 1.31667, 1e-3);
  EXPECT_EQ(acuity_cycles_per_deg(0.0), 0.0);
}

TEST(Eye, HalfSeeADifferenceAtThreshold) {
  EXPECT_EQ(seeing_probability(1.0), 0.5);
  EXPECT_EQ(seeing_probability(0.0), 0.0);
  EXPECT_NEAR(seeing_probability(2.0), 1.0 - std::exp2(-std::exp2(3.5)), 1e-12);
  EXPECT_LT(seeing_probability(0.5), 0.07);
}

}  // namespace
}  // namespace earthshine::studies
