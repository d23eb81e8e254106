// SPDX-License-Identifier: Apache-2.0
// The laws against other closed forms, without the chain.
#include "degrade/parts/transfer_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/units.h"

namespace earthshine::degrade {
namespace {

CctvCamera blurred() {
  CctvCamera camera;
  camera.lens_blur = 0.4;
  camera.blur_h = 0.5;
  camera.blur_v = 0.3;
  camera.bandwidth_mhz = 2.0;
  camera.aperture_correction = 0.25;
  return camera;
}

// Discrete Gaussians cascade: their variances add, for the picture and the noise of the light.
TEST(TransferLaw, VariancesOfTheTapsAdd) {
  CctvCamera camera = blurred();
  camera.aperture_correction = 0.0;
  camera.bandwidth_mhz = 0.0;
  const auto variance = [&](Travels what, Axis axis) {
    const std::vector<double> h = taps(camera, {}, what, axis);
    const double middle = static_cast<double>(h.size() / 2);
    double sum = 0.0;
    for (std::size_t n = 0; n < h.size(); ++n) {
      sum += h[n] * std::pow(static_cast<double>(n) - middle, 2.0);
    }
    return sum;
  };
  EXPECT_NEAR(variance(Travels::Picture, Axis::Along), 0.16 + 0.25, 1e-6);
  EXPECT_NEAR(variance(Travels::LightNoise, Axis::Along), 0.25, 1e-6);
  EXPECT_NEAR(variance(Travels::LightNoise, Axis::Across), 0.09, 1e-6);
  EXPECT_NEAR(variance(Travels::AmplifierNoise, Axis::Along), 0.0, 1e-12);
}

TEST(TransferLaw, TapsSumToOneAndAreThoseOfTheTransfer) {
  for (const Travels what : {Travels::Picture, Travels::LightNoise, Travels::AmplifierNoise}) {
    const std::vector<double> h = taps(blurred(), {}, what, Axis::Along);
    EXPECT_NEAR(std::accumulate(h.begin(), h.end(), 0.0), 1.0, 1e-7);
    for (const double f : {0.1, 0.33, 0.5}) {
      double sum = 0.0;
      for (std::size_t n = 0; n < h.size(); ++n) {
        sum += h[n] * std::cos(2.0 * base::pi * f *
                               (static_cast<double>(n) - static_cast<double>(h.size() / 2)));
      }
      EXPECT_NEAR(sum, transfer(blurred(), {}, what, Axis::Along, f), 1e-7);
    }
  }
}

// -3 dB at B for any number of columns: 2 MHz are 2 * 52.66 cycles per line.
TEST(TransferLaw, BandwidthIsMinusThreeDecibelAtB) {
  CctvCamera camera;
  camera.bandwidth_mhz = 2.0;
  for (const int columns : {300, 400, 800}) {
    Monitor monitor;
    monitor.columns = columns;
    EXPECT_NEAR(
        transfer(camera, monitor, Travels::AmplifierNoise, Axis::Along, 2.0 * 52.66 / columns),
        1.0 / std::sqrt(2.0), 1e-12);
  }
  EXPECT_EQ(transfer(camera, {}, Travels::Picture, Axis::Across, 0.4), 1.0);
}

// e^-t I_0(t) and e^-t I_1(t) at t = 0.25, by the series of Abramowitz and Stegun.
TEST(TransferLaw, TapsOfTheDiscreteGaussianAreBesselFunctions) {
  const double i0 = 1.0 + 0.015625 + 0.015625 * 0.015625 / 4.0;
  const double i1 = 0.125 * (1.0 + 0.015625 / 2.0 + 0.015625 * 0.015625 / 12.0);
  EXPECT_NEAR(gaussian_tap(0.5, 0), std::exp(-0.25) * i0, 1e-6);
  EXPECT_NEAR(gaussian_tap(0.5, 1), std::exp(-0.25) * i1, 1e-6);
  EXPECT_NEAR(gaussian_tap(0.5, -1), gaussian_tap(0.5, 1), 1e-15);
}

// Upright: a ramp over the resel. At 45 degrees: two parabolas; 1/8 at half of the foot.
TEST(TransferLaw, EdgeCoversTheShareOfTheSquare) {
  EXPECT_DOUBLE_EQ(edge_coverage(0.0, 0.25), 0.75);
  EXPECT_DOUBLE_EQ(edge_coverage(0.0, -0.6), 0.0);
  EXPECT_NEAR(edge_coverage(base::pi / 4.0, -std::sqrt(0.125)), 0.125, 1e-12);
  EXPECT_NEAR(edge_coverage(base::pi / 4.0, 0.0), 0.5, 1e-12);
  for (const double x : {-0.7, -0.3, 0.1, 0.6}) {
    EXPECT_NEAR(edge_coverage(0.1, x) + edge_coverage(0.1, -x), 1.0, 1e-12);
  }
}

// The Fourier transform of the profile's derivative is the modulation.
TEST(TransferLaw, ProfileAndModulationAreATransformPair) {
  const Filter filter = filter_of(blurred(), {}, Travels::Picture);
  const double angle = 0.1, step = 1e-3;
  for (const double f : {0.0, 0.2, 0.5}) {
    double sum = 0.0;
    for (double x = -12.0; x < 12.0; x += step) {
      sum += (edge_profile(filter, Axis::Along, angle, x + step) -
              edge_profile(filter, Axis::Along, angle, x)) *
             std::cos(2.0 * base::pi * f * (x + 0.5 * step));
    }
    EXPECT_NEAR(sum, edge_modulation(blurred(), {}, Axis::Along, angle, f), 1e-5) << f;
  }
}

// 10 to 90 %: 1.088, 1.106 and 0.892 of the width (docs/cctv.md).
TEST(TransferLaw, PhosphorEdgesRiseAsTheirShapesDo) {
  constexpr std::pair<Spread, double> rises[] = {
      {Spread::Gaussian, 1.0882}, {Spread::Triangle, 1.1056}, {Spread::Sinc, 0.892}};
  for (const auto& [spread, rise] : rises) {
    Monitor monitor;
    monitor.spread = spread;
    monitor.spread_width = 1.5;
    double up = 0.0;
    while (phosphor_edge(monitor, up) < 0.9) up += 1e-4;
    EXPECT_NEAR(2.0 * up / 1.5, rise, 2e-3) << word_of(spread);
    EXPECT_NEAR(phosphor_edge(monitor, 40.0), 1.0, 1e-9);
    EXPECT_NEAR(phosphor_edge(monitor, -40.0), 0.0, 1e-9);
    EXPECT_DOUBLE_EQ(phosphor_edge(monitor, 0.0), 0.5);
  }
}

// Variances by hand: n = 100, read 2, F^2 = 2, dark 3, lag 0.5 in fields, no filters.
TEST(TransferLaw, NoiseOfTheLineByHand) {
  CctvCamera camera;
  camera.noise = NoiseMode::Photon;
  camera.electrons_at_white = 100.0;
  camera.read_electrons = 2.0;
  camera.excess_noise = 2.0;
  camera.dark_electrons = 3.0;
  camera.prnu_percent = 10.0;
  camera.dsnu_percent = 1.0;
  camera.lag = 0.5;
  camera.interlace = true;
  const LineNoise line = line_noise(camera, {});
  EXPECT_NEAR(line.in_time(0.5), (6e-4 + 0.02 * 0.5) / 3.0 + 4e-4, 1e-12);
  EXPECT_NEAR(line.fixed(0.5), 0.01 * 0.25 + 1e-4, 1e-12);
  // The next line belongs to another field, and without filters they are not correlated.
  EXPECT_NEAR(line.total(0.5, 0, 1), 0.0, 1e-12);
  // With blur they are, and half of the charge is from the previous field.
  CctvCamera soft = camera;
  soft.blur_v = 0.5;
  const double h2 = gaussian_tap(std::sqrt(0.5), 0), h1 = gaussian_tap(std::sqrt(0.5), 1);
  const LineNoise next = line_noise(soft, {});
  EXPECT_NEAR(next.in_time(0.5, 0, 0), (6e-4 + 0.01) / 3.0 * h2 + 4e-4, 1e-9);
  EXPECT_NEAR(next.in_time(0.5, 0, 1), 0.5 * (6e-4 + 0.01) / 3.0 * h1, 1e-9);
  EXPECT_NEAR(next.fixed(0.5, 0, 1), 0.01 * 0.25 * h1, 1e-9);
  camera.interlace = false;  // a frame lasts two fields: 0.25 remains, 0.75 / 1.25 of the variance
  EXPECT_NEAR(line_noise(camera, {}).in_time(0.5), 0.6 * (6e-4 + 0.01) + 4e-4, 1e-12);
}

}  // namespace
}  // namespace earthshine::degrade
