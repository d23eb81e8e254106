// SPDX-License-Identifier: Apache-2.0
// Moments of the noise of flat fields of M values. Standard errors: of the mean sqrt(v / M), of the
// variance sqrt((k4 + 2 v^2) / M), with k4 the fourth cumulant (0 for a Gaussian).
#include "degrade/parts/noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::flat;
using test::moments;

constexpr int edge = 500;
constexpr double count = 250'000.0;

test::Moments noisy(const NoiseLaw& law, float signal, const NoiseKey& key = {}) {
  const Picture in = flat(edge, edge, signal);
  return moments(add_read_noise(add_signal_noise(in, law, key), law, key).planes[0]);
}

CctvCamera camera_with(NoiseMode mode) {
  CctvCamera camera;
  camera.noise = mode;
  return camera;
}

// Phi(1.959963985) = 0.975 and so on; the formula has an accuracy of 16 digits.
TEST(NormalQuantile, InvertsTheNormalDistributionFunction) {
  for (const double x : {-8.0, -5.5, -3.0, -1.0, -0.2, 0.0, 0.4, 2.0, 4.0}) {
    const double p = 0.5 * std::erfc(-x / std::sqrt(2.0));
    EXPECT_NEAR(normal_quantile(p), x,
                2e-12 / std::exp(-x * x / 2.0) * (x > 0.0 ? 1e-3 : 0.0) + 1e-9);
  }
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
}

TEST(NoiseLaw, ReportIsAShareOfTheSignalAndSpecAConstant) {
  CctvCamera camera = camera_with(NoiseMode::Report);
  camera.snr_db = 20.0;  // +-10 %
  EXPECT_NEAR(noise_law(camera).c, 0.01, 1e-15);
  EXPECT_EQ(noise_law(camera).a, 0.0);
  camera.noise = NoiseMode::Spec;
  EXPECT_NEAR(noise_law(camera).a, 0.01, 1e-15);
  EXPECT_EQ(noise_law(camera).c, 0.0);
}

// EMVA 1288: shot noise sqrt(n) of n electrons at white gives b = 1/n; 640 electrons, 28.06 dB.
TEST(NoiseLaw, PhotonsGiveTheirTextbookSignalToNoiseRatio) {
  CctvCamera camera = camera_with(NoiseMode::Photon);
  camera.electrons_at_white = 640.0;
  EXPECT_NEAR(noise_figures(camera).snr_db, 10.0 * std::log10(640.0), 1e-9);
  camera.excess_noise = 2.0;
  EXPECT_NEAR(noise_figures(camera).electrons_at_white, 320.0, 1e-9);
  camera.read_electrons = 64.0;
  EXPECT_NEAR(noise_law(camera).a, 0.01, 1e-15);
  EXPECT_NEAR(noise_figures(camera).floor_db, 20.0, 1e-9);
}

TEST(NoiseLaw, EveryWayOfGivingItLeadsToTheSameLaw) {
  CctvCamera spec = camera_with(NoiseMode::Spec);
  spec.snr_db = 34.0;
  CctvCamera law = camera_with(NoiseMode::Law);
  law.noise_a = noise_law(spec).a;
  EXPECT_EQ(describe_noise(spec), describe_noise(law));
  EXPECT_EQ(describe_noise(camera_with(NoiseMode::None)), "no noise");
}

TEST(Noise, ReportModeIsProportionalToTheSignalAndLeavesBlackAlone) {
  CctvCamera camera = camera_with(NoiseMode::Report);
  camera.snr_db = 20.0;
  const NoiseLaw law = noise_law(camera);
  for (const float s : {0.01F, 0.05F, 0.1F, 0.2F, 0.4F, 0.6F, 0.8F, 1.0F}) {
    const test::Moments m = noisy(law, s);
    const double variance = 0.01 * static_cast<double>(s) * static_cast<double>(s);
    EXPECT_NEAR(m.mean, s, 4.0 * std::sqrt(variance / count)) << s;
    EXPECT_NEAR(m.variance, variance, 4.0 * variance * std::sqrt(2.0 / count)) << s;
  }
  const test::Moments black = noisy(law, 0.0F);
  EXPECT_EQ(black.mean, 0.0);
  EXPECT_EQ(black.variance, 0.0);
}

TEST(Noise, VarianceFollowsTheLawAtEveryLevel) {
  const NoiseLaw law{1e-4, 4e-4, 2.5e-3, false};
  for (const float s : {0.0F, 0.02F, 0.1F, 0.3F, 0.5F, 0.7F, 1.0F, 4.0F}) {
    const double variance = law.variance(static_cast<double>(s));
    const test::Moments m = noisy(law, s);
    // The Poisson part b * Poisson(s / b) has the fourth cumulant b^3 s.
    const double k4 = std::pow(law.b, 3.0) * static_cast<double>(s);
    EXPECT_NEAR(m.mean, s, 4.0 * std::sqrt(variance / count)) << s;
    EXPECT_NEAR(m.variance, variance, 4.0 * std::sqrt((k4 + 2.0 * variance * variance) / count))
        << s;
  }
}

// Poisson: every cumulant is n. The standard error of the third central moment is sqrt((k6 + 9 k2
// k4 + 9 k3^2 + 6 k2^3) / M).
TEST(Noise, ShotNoiseHasVarianceAndThirdMomentEqualToItsMean) {
  for (const double n : {0.1, 1.0, 10.0, 63.0, 64.5, 100.0, 1e5}) {
    // Signals in electrons: b = 1.
    const test::Moments m = noisy({0.0, 1.0, 0.0, false}, static_cast<float>(n));
    EXPECT_NEAR(m.mean, n, 4.0 * std::sqrt(n / count)) << n;
    EXPECT_NEAR(m.variance, n, 4.0 * std::sqrt((n + 2.0 * n * n) / count)) << n;
    EXPECT_NEAR(m.third, n, 4.0 * std::sqrt((n + 18.0 * n * n + 6.0 * n * n * n) / count)) << n;
  }
}

// Dark counts of rate I during t: Poisson of mean I t. The mean is subtracted, so that the mean of
// the signal is unchanged and its variance grows by I t (neither I t^2 nor 0).
TEST(Noise, DarkCountsHaveTheVarianceOfTheirMean) {
  for (const double t : {0.01, 1.0, 100.0}) {
    CctvCamera camera;
    camera.noise = NoiseMode::Photon;
    camera.electrons_at_white = 1.0;  // signals in electrons
    camera.dark_electrons = 3.0 * t;
    const double n = 3.0 * t;
    const test::Moments m = noisy(noise_law(camera), 0.0F);
    EXPECT_NEAR(m.mean, 0.0, 4.0 * std::sqrt(n / count)) << t;
    EXPECT_NEAR(m.variance, n, 4.0 * std::sqrt((n + 2.0 * n * n) / count)) << t;
    EXPECT_NEAR(noise_law(camera).at_black(), n, 1e-12) << t;
  }
}

// An intensifier multiplies the variance of light and dark by F^2.
TEST(Noise, ExcessNoiseMultipliesTheVarianceOfAllCounts) {
  CctvCamera camera;
  camera.noise = NoiseMode::Photon;
  camera.electrons_at_white = 1000.0;
  camera.dark_electrons = 50.0;
  camera.excess_noise = 1.6;
  const test::Moments m = noisy(noise_law(camera), 0.2F);
  const double v = 1.6 * (200.0 + 50.0) / 1e6;
  EXPECT_NEAR(m.mean, 0.2, 4.0 * std::sqrt(v / count));
  EXPECT_NEAR(m.variance / v, 1.0, 4.0 * std::sqrt(2.1 / count));
}

// Fixed patterns have the mean 1 and the stated deviation: the dark pattern relative to white, the
// sensitivity relative to its mean.
TEST(Noise, PatternsHaveMeanOneAndTheirSpread) {
  CctvCamera camera;
  camera.noise = NoiseMode::Photon;
  camera.electrons_at_white = 1e9;
  camera.prnu_percent = 2.0;
  camera.dsnu_percent = 0.5;
  const NoiseLaw law = noise_law(camera);
  const test::Moments light = noisy(law, 0.5F);
  const double v = 0.01 * 0.01 + 0.005 * 0.005;  // 2 % of 0.5, and 0.5 % of white
  EXPECT_NEAR(light.mean, 0.5, 4.0 * std::sqrt(v / count));
  EXPECT_NEAR(light.variance / v, 1.0, 4.0 * std::sqrt(2.0 / count));
  const Picture black = add_read_noise(flat(edge, edge, 0.0F), law, {});
  EXPECT_NEAR(std::sqrt(moments(black.planes[0]).variance) / 0.005, 1.0,
              4.0 * std::sqrt(0.5 / count));
  EXPECT_EQ(black.planes[0], add_read_noise(flat(edge, edge, 0.0F), law, {1, 9, 0}).planes[0]);
}

TEST(Noise, FewElectronsAreCountedWhole) {
  const Picture out = add_signal_noise(flat(50, 50, 3.0F), {0.0, 1.0, 0.0, false}, {});
  for (float value : out.planes[0]) ASSERT_EQ(value, std::round(value));
}

// P(0) = e^-n, P(1) = n e^-n.
TEST(Noise, PoissonCountsHaveTheirProbabilities) {
  const Picture out = add_signal_noise(flat(edge, edge, 0.7F), {0.0, 1.0, 0.0, false}, {});
  double none = 0.0, one = 0.0;
  for (float value : out.planes[0]) {
    none += value == 0.0F ? 1.0 : 0.0;
    one += value == 1.0F ? 1.0 : 0.0;
  }
  const double p0 = std::exp(-0.7), p1 = 0.7 * p0;
  EXPECT_NEAR(none / count, p0, 4.0 * std::sqrt(p0 * (1.0 - p0) / count));
  EXPECT_NEAR(one / count, p1, 4.0 * std::sqrt(p1 * (1.0 - p1) / count));
}

// Skewness and excess kurtosis of a Gaussian are 0, with the standard errors sqrt(6 / M) and
// sqrt(24 / M).
TEST(Noise, AmplifierNoiseIsGaussian) {
  const test::Moments m = noisy({0.04, 0.0, 0.0, false}, 0.5F);
  EXPECT_NEAR(m.third / std::pow(m.variance, 1.5), 0.0, 4.0 * std::sqrt(6.0 / count));
  EXPECT_NEAR(m.fourth / (m.variance * m.variance) - 3.0, 0.0, 4.0 * std::sqrt(24.0 / count));
}

}  // namespace
}  // namespace earthshine::degrade
