// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "degrade/moments/point_moments.h"
#include "degrade/parts/noise.h"
#include "degrade/twin.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

constexpr int field_columns = 41, field_rows = 31;
constexpr std::size_t pixels = 41 * 31, centre = 15 * 41 + 20;

// A square of `edge` resels in the centre of the picture.
Plane square(int edge, float inside, float outside) {
  Plane plane(pixels, outside);
  for (int y = 15 - edge / 2; y <= 15 + edge / 2; ++y) {
    for (int x = 20 - edge / 2; x <= 20 + edge / 2; ++x) {
      plane[static_cast<std::size_t>(y * field_columns + x)] = inside;
    }
  }
  return plane;
}

Covariance white_noise(double sigma) {
  return white(field_columns, field_rows, Plane(pixels, static_cast<float>(sigma * sigma)));
}

// V43: k = Delta sqrt(N_eff) / sigma, 1 / N_eff = 1 / 25 + 1 / 96 for 5 x 5 within 11 x 11.
TEST(Detection, RosesKOfASquareInWhiteNoiseIsItsClosedForm) {
  const Detection found = detection(square(5, 0.53F, 0.5F), white_noise(0.04));
  const double k = 0.03 / 0.04 / std::sqrt(1.0 / 25.0 + 1.0 / 96.0);
  EXPECT_NEAR(found.signal[centre], 0.03, 1e-6);
  EXPECT_NEAR(found.snr[centre], k, 1e-5 * k);
  EXPECT_NEAR(found.probability[centre], normal_probability(k - 2.8), 1e-5);
  // Two resels aside, the target box contains 3 of the 5 columns, the surround the other two.
  EXPECT_NEAR(found.signal[centre + 2], 0.03 * (15.0 / 25.0 - 10.0 / 96.0), 1e-6);
  // A darker target has the same SNR.
  EXPECT_NEAR(detection(square(5, 0.47F, 0.5F), white_noise(0.04)).snr[centre], k, 1e-5 * k);
}

TEST(Detection, SnrOfTwoPointEightIsSeenHalfTheTime) {
  const double sigma = 0.03 / 2.8 / std::sqrt(1.0 / 9.0 + 1.0 / 40.0);
  const Detection found = detection(square(3, 0.53F, 0.5F), white_noise(sigma), {3, 2.8});
  EXPECT_NEAR(found.snr[centre], 2.8, 1e-5);
  EXPECT_NEAR(found.probability[centre], 0.5, 1e-5);
  EXPECT_NEAR(detection(square(3, 0.53F, 0.5F), white_noise(sigma), {3, 1.8}).probability[centre],
              0.841345, 1e-5);
}

// Blur makes grain with the autocovariance R(k) R(l), R(k) = e^-2t I_k(2t). The sums over
// concentric boxes of m and n resels have the covariance (sum over i, j of R(i - j))^2. Means of
// boxes are noisier than for white noise of the same variance per resel.
TEST(Detection, GrainLowersItAsItsAutocorrelationSays) {
  for (const double blur : {0.35, 1.0}) {
    const Covariance grain = filtered(white_noise(0.1), gaussian_blur(field_columns, blur),
                                      gaussian_blur(field_rows, blur));
    const double two_t = 2.0 * blur * blur;
    const auto covariance = [&](int m, int n) {
      double sum = 0.0;
      for (int i = -m / 2; i <= m / 2; ++i) {
        for (int j = -n / 2; j <= n / 2; ++j) {
          sum += std::exp(-two_t) * std::cyl_bessel_i(std::abs(i - j), two_t);
        }
      }
      return 0.01 * sum * sum;
    };
    const double b = 1.0 / 96.0, a = 1.0 / 25.0 + b;
    const double variance =
        a * a * covariance(5, 5) - 2.0 * a * b * covariance(5, 11) + b * b * covariance(11, 11);
    const Plane mean = square(5, 0.53F, 0.5F);
    const double k = static_cast<double>(detection(mean, grain).snr[centre]);
    EXPECT_NEAR(k, 0.03 / std::sqrt(variance), 2e-4 * k) << blur;
    const Plane alike(pixels, grain.variance()[centre]);
    EXPECT_LT(k, 0.95 * static_cast<double>(
                            detection(mean, white(field_columns, field_rows, alike)).snr[centre]));
  }
}

// Sampled noise: the difference of the two means over N frames has the predicted variance, within
// four times sqrt(2 / N M) for M distant positions, including corners.
TEST(Detection, DrawnGrainHasThePredictedNoise) {
  constexpr int frames = 400;
  const AxisMap along = gaussian_blur(field_columns, 0.8), across = gaussian_blur(field_rows, 0.5);
  const Detection predicted =
      detection(Plane(pixels, 0.0F), filtered(white_noise(0.1), along, across), {3, 2.8});
  const NoiseLaw law{0.01, 0.0, 0.0, false};
  double sum = 0.0, count = 0.0;
  for (std::uint64_t frame = 0; frame < frames; ++frame) {
    const Plane seen =
        apply(add_read_noise(test::flat(field_columns, field_rows, 0.0F), law, {9, frame, 0}),
              along, across)
            .planes.front();
    for (const int y : {0, 15, 30}) {
      for (const int x : {0, 20, 40}) {
        double inside = 0.0, around = 0.0, n_inside = 0.0, n_around = 0.0;
        for (int v = std::max(0, y - 3); v <= std::min(field_rows - 1, y + 3); ++v) {
          for (int u = std::max(0, x - 3); u <= std::min(field_columns - 1, x + 3); ++u) {
            const bool target = std::abs(u - x) <= 1 && std::abs(v - y) <= 1;
            (target ? inside : around) +=
                static_cast<double>(seen[static_cast<std::size_t>(v * field_columns + u)]);
            (target ? n_inside : n_around) += 1.0;
          }
        }
        const double sigma =
            static_cast<double>(predicted.noise[static_cast<std::size_t>(y * field_columns + x)]);
        const double z = (inside / n_inside - around / n_around) / sigma;
        sum += z * z;
        count += 1.0;
      }
    }
  }
  EXPECT_NEAR(sum / count, 1.0, 4.0 * std::sqrt(2.0 / count));
}

TEST(Detection, WithoutNoiseWhatDiffersIsSeenAndWhatDoesNotIsNot) {
  const Detection found = detection(square(5, 0.7003F, 0.7F), white_noise(0.0));
  EXPECT_EQ(found.snr[centre], static_cast<float>(most_snr));
  EXPECT_EQ(found.probability[centre], 1.0F);
  // Far from the square the picture is flat: rounding must not give a signal.
  for (const std::size_t i : {std::size_t{0}, std::size_t{400}, pixels - 1}) {
    EXPECT_EQ(found.signal[i], 0.0F);
    EXPECT_EQ(found.snr[i], 0.0F);
    EXPECT_NEAR(found.probability[i], normal_probability(-2.8), 1e-9);
  }
}

TEST(Detection, PicturesWithoutASurroundShowNothing) {
  const Detection one = detection({0.5F}, white(1, 1, {0.1F}));
  EXPECT_EQ(one.snr[0], 0.0F);
  const Detection small = detection({0.5F, 0.7F}, white(2, 1, {0.1F, 0.1F}), {1, 2.8});
  // Each resel is the other's surround: 0.2 / sqrt(0.1 + 0.1).
  EXPECT_NEAR(small.snr[0], 0.2 / std::sqrt(0.2), 1e-5);
}

TEST(Detection, LocalSnrIsMeanOverSigmaAndFinite) {
  const Plane snr = local_snr({0.5F, 0.5F, 0.0F, 0.0F, -0.5F}, {0.01F, 0.0F, 0.0F, 1.0F, 0.01F});
  EXPECT_FLOAT_EQ(snr[0], 5.0F);
  EXPECT_EQ(snr[1], static_cast<float>(most_snr));
  EXPECT_EQ(snr[2], 0.0F);
  EXPECT_EQ(snr[3], 0.0F);
  EXPECT_FLOAT_EQ(snr[4], -5.0F);
}

TEST(Detection, TargetsWithoutACentreAreRefused) {
  for (const int size : {-1, 0, 4, 201}) {
    EXPECT_THROW((void)detection(Plane(pixels), white_noise(0.1), {size, 2.8}), base::Error);
  }
  EXPECT_THROW((void)detection(Plane(3), white_noise(0.1)), base::Error);
}

}  // namespace
}  // namespace earthshine::degrade
