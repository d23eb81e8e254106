// SPDX-License-Identifier: Apache-2.0
// ISO 12233's method for edges with known profile.
#include "degrade/certify/slanted_edge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "degrade/certify/block_statistics.h"
#include "degrade/parts/noise.h"
#include "degrade/parts/transfer_law.h"
#include "degrade/stage/axis_map.h"

namespace earthshine::degrade {
namespace {

constexpr int columns = 120, rows = 200;

Plane edge(double degrees, double offset, double low = 0.2, double high = 0.8) {
  const double angle = base::radians(degrees);
  Plane plane;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const double away = (x + 0.5 - 0.5 * columns - offset) * std::cos(angle) +
                          (y + 0.5 - 0.5 * rows) * std::sin(angle);
      plane.push_back(static_cast<float>(low + (high - low) * edge_coverage(angle, away)));
    }
  }
  return plane;
}

double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(base::pi * x) / (base::pi * x); }

TEST(SlantedEdge, FindsTheAngleAndTheEnds) {
  for (const double degrees : {-8.0, 3.0, 5.0}) {
    const SlantedEdge found = measure_edge(edge(degrees, 1.7), columns, rows, 8.0);
    EXPECT_NEAR(found.angle, -base::radians(degrees), 2e-4);
    EXPECT_NEAR(found.low, 0.2, 1e-6);
    EXPECT_NEAR(found.high, 0.8, 1e-6);
    EXPECT_NEAR(found.crossing(0.5), 0.0, 0.02);
  }
}

// The area average of the resel: sinc(f cos) sinc(f sin), measured to 0.01 up to Nyquist and
// beyond.
TEST(SlantedEdge, SharpEdgeHasTheModulationOfTheResel) {
  for (const double degrees : {4.0, 5.0, 7.0}) {
    const double angle = base::radians(degrees);
    const SlantedEdge found = measure_edge(edge(degrees, 0.3), columns, rows, 8.0);
    for (const double f : {0.0, 0.1, 0.25, 0.5, 0.8}) {
      EXPECT_NEAR(found.modulation(f), sinc(f * std::cos(angle)) * sinc(f * std::sin(angle)), 0.01)
          << degrees << " degrees, " << f;
    }
  }
}

TEST(SlantedEdge, BlurIsMeasuredAsItsTransfer) {
  const AxisMap along = gaussian_blur(columns, 0.8), across = gaussian_blur(rows, 0.5);
  const Picture blurred = apply({columns, rows, {edge(5.0, 0.0)}}, along, across);
  const SlantedEdge found = measure_edge(blurred.planes[0], columns, rows, 10.0);
  const double angle = base::radians(5.0);
  for (const double f : {0.1, 0.25, 0.4, 0.5}) {
    const double u = f * std::cos(angle), v = f * std::sin(angle);
    const double law = sinc(u) * sinc(v) *
                       std::exp(-0.64 * (1.0 - std::cos(2.0 * base::pi * u)) -
                                0.25 * (1.0 - std::cos(2.0 * base::pi * v)));
    EXPECT_NEAR(found.modulation(f), law, 0.01) << f;
  }
}

TEST(SlantedEdge, FineBinsGiveTheProfile) {
  const SlantedEdge found = measure_edge(edge(5.0, 0.0), columns, rows, 6.0, 16);
  for (const double x : {-0.6, -0.4, 0.0, 0.2, 0.45, 0.7}) {
    EXPECT_NEAR(found.profile_at(x), edge_coverage(base::radians(5.0), x), 0.02) << x;
  }
  EXPECT_NEAR(found.crossing(0.9) - found.crossing(0.1), 0.8 * std::cos(base::radians(5.0)), 0.03);
}

// Noise of a tenth of the step: measured within four standard errors of sixteen edges.
TEST(SlantedEdge, NoiseDoesNotShiftTheModulation) {
  std::vector<double> found;
  for (std::uint64_t frame = 0; frame < 16; ++frame) {
    const Picture noisy =
        add_read_noise({columns, rows, {edge(5.0, 0.0)}}, {.a = 36e-4}, {1, frame, 0});
    found.push_back(measure_edge(noisy.planes[0], columns, rows, 6.0).modulation(0.25));
  }
  const Estimate mean = mean_of(found);
  EXPECT_NEAR(mean.value, sinc(0.25 * std::cos(base::radians(5.0))), 4.0 * mean.error + 0.01);
}

// Noise alone and a picture of NaN have no edge; both return without one.
TEST(SlantedEdge, NoEdgeIsNoFault) {
  const Picture noise =
      add_read_noise({columns, rows, {Plane(columns * rows, 0.5F)}}, {.a = 1.0}, {});
  const SlantedEdge none = measure_edge(noise.planes[0], columns, rows, 8.0);
  EXPECT_LE(std::abs(none.angle), base::radians(15.0) + 1e-9);
  EXPECT_FALSE(none.profile.empty());
  const Plane invalid(columns * rows, std::nanf(""));
  EXPECT_TRUE(std::isnan(measure_edge(invalid, columns, rows, 8.0).modulation(0.2)));
}

TEST(SlantedEdge, FrequencyAtALevelIsThatOfTheCurve) {
  const auto line = [](double f) { return 1.0 - f; };
  EXPECT_NEAR(frequency_at(line, 0.5, 1.0), 0.5, 1e-12);
  EXPECT_EQ(frequency_at(line, 0.2, 0.5), 0.5);  // not reached
}

}  // namespace
}  // namespace earthshine::degrade
