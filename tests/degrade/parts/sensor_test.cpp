// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "degrade/chain.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::flat;
using test::moments;

double sum(const Picture& picture) {
  return std::accumulate(picture.planes[0].begin(), picture.planes[0].end(), 0.0);
}

Picture point(int columns, int rows, int x, int y, float value) {
  Picture picture = flat(columns, rows, 0.0F);
  picture.planes[0][static_cast<std::size_t>(y * columns + x)] = value;
  return picture;
}

// y_j = (1 - l) x_j + l y_(j-1): a flash in field 0 leaves (1 - l) l^j in field j. Steady light
// reaches 1 - l^(j+1) after j fields.
TEST(Lag, LeavesAGeometricTailAndKeepsSteadyLight) {
  constexpr double lag = 0.42;
  Picture flash = after_lag(flat(2, 2, 1.0F), flat(2, 2, 0.0F), lag);
  Picture step = flash;
  for (int j = 1; j < 8; ++j) {
    flash = after_lag(flat(2, 2, 0.0F), flash, lag);
    step = after_lag(flat(2, 2, 1.0F), step, lag);
    EXPECT_NEAR(flash.planes[0][0], (1.0 - lag) * std::pow(lag, j), 1e-6) << j;
    EXPECT_NEAR(step.planes[0][3], 1.0 - std::pow(lag, j + 1), 1e-6) << j;
  }
  // The usual figure for these tubes: 7 % after three fields.
  EXPECT_NEAR(std::pow(lag, 3), 0.074, 5e-4);
}

// Var y = (1 - l)^2 v + l^2 Var y, hence Var y = v (1 - l) / (1 + l) at rest, 0.5385 v at l = 0.3.
// The first field after settled_charge has it already.
TEST(Lag, NoiseAtRestIsSmallerFromTheFirstFieldOn) {
  constexpr double lag = 0.3;
  constexpr int edge = 400;
  const NoiseLaw law{.b = 1e-3};
  const Picture still = flat(edge, edge, 0.5F);
  Picture charge = settled_charge(still, law, {1, 999, 0}, lag);
  const double v = law.variance(0.5) * (1.0 - lag) / (1.0 + lag);
  const double count = static_cast<double>(edge) * edge;
  for (std::uint64_t j = 0; j < 4; ++j) {
    EXPECT_NEAR(moments(charge.planes[0]).variance / v, 1.0, 4.0 * std::sqrt(2.0 / count)) << j;
    EXPECT_NEAR(moments(charge.planes[0]).mean, 0.5, 4.0 * std::sqrt(v / count)) << j;
    const Picture before = charge;
    charge = after_lag(add_grain(still, law, {1, j, 0}), charge, lag);
    // The correlation of consecutive fields is l.
    EXPECT_NEAR(test::correlation(before.planes[0], charge.planes[0], edge, edge, 0, 0), lag,
                4.0 / std::sqrt(count));
  }
}

// Every field has the pattern: lag does not reduce it.
TEST(Lag, LeavesAFixedPatternAlone) {
  const NoiseLaw law{.c = 1e-2, .c_is_fixed_pattern = true};
  const Picture still = flat(40, 40, 0.5F);
  EXPECT_EQ(settled_charge(still, law, {1, 7, 0}, 0.5).planes[0],
            differ_in_sensitivity(still, law, {1, 8, 0}).planes[0]);
}

// A bar of a tenth of the height at signal 1000, -90 dB: 1000 x 10^-4.5 = 0.0316 in its columns.
TEST(Smear, BrightTenthLeavesItsShareInItsColumnAlone) {
  Picture picture = flat(20, 100, 0.0F);
  for (std::size_t y = 30; y < 40; ++y) picture.planes[0][y * 20 + 7] = 1000.0F;
  const double share = std::pow(10.0, -90.0 / 20.0);
  const Picture out = smear_columns(picture, share);
  EXPECT_NEAR(out.planes[0][99 * 20 + 7], 1000.0 * share, 1e-6);
  EXPECT_NEAR(out.planes[0][35 * 20 + 7], 1000.0 * (1.0 + share), 1e-3);
  EXPECT_EQ(out.planes[0][99 * 20 + 8], 0.0F);
}

// Balance: the excess above saturation becomes halo or is drained. Sum out = sum in - (1 - b)
// excess.
TEST(Bloom, ExcessIsSpreadOrDrainedToTheLastElectron) {
  const Picture in = point(101, 81, 40, 30, 1000.0F);
  for (const double share : {0.25, 1.0}) {
    const Picture out = bloom_over(in, 4.0, share, 6.0);
    EXPECT_NEAR(sum(out), 1000.0 - (1.0 - share) * 996.0, 1e-3) << share;
    EXPECT_NEAR(share_above(in, 4.0), 0.996, 1e-9);
  }
}

// Far from the border the halo is the Gaussian. For 996 at sigma 6 it is 996 / (2 pi 36) in the
// middle and exp(-r^2 / 72) of this at r (the discrete Gaussian differs by 1 / (8 sigma^2) = 0.35 %
// there).
TEST(Bloom, HaloOfAPointIsTheGaussianOfItsRadius) {
  const Picture out = bloom_over(point(101, 81, 50, 40, 1000.0F), 4.0, 1.0, 6.0);
  const double middle = 996.0 / (2.0 * 3.14159265358979 * 36.0);
  EXPECT_NEAR(out.planes[0][40 * 101 + 50] - 4.0, middle, 0.01 * middle);
  EXPECT_NEAR(out.planes[0][40 * 101 + 62], middle * std::exp(-2.0), 0.01 * middle);
  EXPECT_NEAR(out.planes[0][52 * 101 + 50], middle * std::exp(-2.0), 0.01 * middle);
}

TEST(Bloom, BelowSaturationNothingChanges) {
  const Picture in = flat(30, 20, 3.9F);
  EXPECT_EQ(bloom_over(in, 4.0, 1.0, 6.0).planes[0], in.planes[0]);
  EXPECT_EQ(limit_above(in, 4.0).planes[0], in.planes[0]);
  EXPECT_EQ(share_above(in, 4.0), 0.0);
  EXPECT_EQ(share_above(flat(3, 3, 0.0F), 4.0), 0.0);
}

// A quarter of the picture at S = 3, the rest at 0.2: of the sum 0.75 + 0.15, 0.25 x 2 is above 1.
// Without bloom all of it is lost. With bloom of one half, the drained half and the newly clipped
// part are lost.
TEST(Bloom, ReportTellsWhatLayAboveSaturationAndWhatWasLost) {
  CctvCamera camera;
  camera.iris = IrisMode::Fixed;
  camera.transmittance = 1.0;
  camera.f_number = 1.0;
  camera.white_lux = 3.14159265358979 / 4.0;
  camera.saturation = 1.0;
  const base::Image scene =
      test::painted(400, 300, [](double x, double) { return x < 0.25 ? 3.0 : 0.2; });
  for (const bool interlace : {false, true}) {
    camera.interlace = interlace;
    camera.bloom = 0.0;
    const Report cut = degrade(scene, camera, {}).report;
    EXPECT_NEAR(cut.lost_share, 0.5 / 0.9, 1e-5);
    EXPECT_EQ(cut.excess_share, 0.0);
    camera.bloom = 0.5;
    const Result bloomed = degrade(scene, camera, {});
    EXPECT_NEAR(bloomed.report.excess_share, 0.5 / 0.9, 1e-5);
    double sum = 0.0;
    for (float v : bloomed.signal.channels[0].values) sum += std::pow(static_cast<double>(v), 2.2);
    // The signal and the lost share add up to 1.
    EXPECT_NEAR(sum / (400.0 * 300.0) / 0.9 + bloomed.report.lost_share, 1.0, 1e-4);
  }
}

}  // namespace
}  // namespace earthshine::degrade
