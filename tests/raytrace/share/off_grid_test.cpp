// SPDX-License-Identifier: Apache-2.0
// Off-grid gather points, with synthetic estimates.
#include "raytrace/share/off_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/numbers/random.h"

namespace earthshine::raytrace {
namespace {

// One grid point of value 10, and off-grid points of two samples each.
struct Written {
  std::vector<OffGridPoint> off_grid_points;
  Estimate estimate;
  Shared shared;

  explicit Written(std::size_t count)
      : off_grid_points(count, OffGridPoint{0, 0, 0, 0.5F}), estimate(1 + count, 1, 1) {
    shared.layers = 1;
    shared.radiance = {glm::vec3(10.0F)};
    shared.resize(1);
  }
  // Sets the means of the halves of this number of samples.
  void sample(std::size_t off_grid_point, double first, double second, double samples = 2.0) {
    first *= samples / 2.0, second *= samples / 2.0;
    estimate.clear(1 + off_grid_point);
    estimate.add_luminance(1 + off_grid_point, static_cast<float>(first),
                           static_cast<float>(second));
    estimate.sum[1 + off_grid_point] = glm::vec3(static_cast<float>(first + second));
    estimate.samples[1 + off_grid_point] = static_cast<float>(samples);
  }
  [[nodiscard]] double value(std::size_t off_grid_point) const {
    return double(shared.radiance[1 + off_grid_point].g);
  }
};

TEST(OffGrid, WithoutSamplesTheyTakeWhatTheirSurfaceSays) {
  Written written(1);
  add_off_grid_points(written.off_grid_points, written.estimate, written.shared);
  EXPECT_EQ(written.value(0), 10.0);
}

TEST(OffGrid, WithoutSamplesTheyStateWhatTheOthersAreOffBy) {
  // The others differ by 2 from the shared value, without noise: mean square 4.
  Written written(9);
  for (std::size_t k = 1; k < 9; ++k) written.sample(k, 12.0, 12.0);
  add_off_grid_points(written.off_grid_points, written.estimate, written.shared);
  EXPECT_NEAR(double(written.shared.squared_error[1]), 4.0, 1e-5);
  for (std::size_t k = 1; k < 9; ++k) EXPECT_EQ(written.shared.squared_error[1 + k], 0.0F);
}

TEST(OffGrid, WithoutASurfaceBesideThemTheyKeepTheirOwn) {
  Written written(2);
  written.off_grid_points[0].base = no_base;
  written.sample(0, 3.0, 5.0);
  add_off_grid_points(written.off_grid_points, written.estimate, written.shared);
  EXPECT_DOUBLE_EQ(written.value(0), 4.0);
  EXPECT_NEAR(double(written.shared.squared_error[1]), 1.0, 1e-4);  // ((3 - 5) / 2)^2
}

TEST(OffGrid, WhatIsNoNoiseIsKeptWhole) {
  Written written(8);
  for (std::size_t k = 0; k < 8; ++k) written.sample(k, 4.0 + double(k), 4.0 + double(k));
  add_off_grid_points(written.off_grid_points, written.estimate, written.shared);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR(written.value(k), 4.0 + double(k), 1e-5);
}

TEST(OffGrid, WhatNoiseHidesIsNotStatedAsNone) {
  // Halves of 10 - 3 and 10 + 3, whose mean is the shared value: the mean square, 0, minus the
  // noise q = 9 is negative. The gain is 0. The signal is set to the standard error of a mean of
  // nine squares, q sqrt(2 / 9). With four times the samples it is a quarter of that.
  Written written(9);
  for (std::size_t k = 0; k < 9; ++k) written.sample(k, 7.0, 13.0);
  add_off_grid_points(written.off_grid_points, written.estimate, written.shared);
  const double hidden = 9.0 * std::sqrt(2.0 / 9.0);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_EQ(written.value(k), 10.0);
    EXPECT_NEAR(double(written.shared.squared_error[1 + k]), hidden, 1e-5);
    EXPECT_NEAR(written.shared.squared_error_with(1 + k, 4.0), hidden / 4.0, 1e-5);
  }
}

TEST(OffGrid, TheirErrorIsAsStated) {
  // True differences of variance s from the shared value, means of two samples with noise q: a gain
  // c leaves (1 - c)^2 s + c^2 q on average. Means of squares of normal numbers have the relative
  // standard error sqrt(2 / count): the remaining error, and in the stated one q and s, the latter
  // as the difference of s + q and q.
  constexpr std::size_t count = 4000;
  for (const double q : {0.1, 0.5, 4.0}) {
    constexpr double s = 1.0;
    Written written(count);
    base::Rng rng(base::Key(7, base::Stream::Test, 12));
    const auto normal = [&] {
      return std::sqrt(-2.0 * std::log(1.0 - rng.next())) * std::cos(2.0 * base::pi * rng.next());
    };
    std::vector<double> truth;
    for (std::size_t k = 0; k < count; ++k) {
      truth.push_back(10.0 + std::sqrt(s) * normal());
      const double noise = std::sqrt(2.0 * q);
      written.sample(k, truth[k] + noise * normal(), truth[k] + noise * normal());
    }
    add_off_grid_points(written.off_grid_points, written.estimate, written.shared);
    double found = 0.0, stated = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      found += std::pow(written.value(k) - truth[k], 2) / count;
      stated += double(written.shared.squared_error[1 + k]) / count;
    }
    const double c =
        double(wiener_gain(static_cast<float>(s), static_cast<float>(q), 1.0F / float(count)));
    const double left = (1.0 - c) * (1.0 - c) * s + c * c * q;
    const double error = left + (1.0 - c) * (1.0 - c) * (s + 2.0 * q) + c * c * q;
    EXPECT_NEAR(stated, found, 4.0 * std::sqrt(2.0 / count) * error) << q;
    EXPECT_LT(found, std::min(s, q) * (1.0 + 4.0 * std::sqrt(2.0 / count))) << q;
  }
}

TEST(OffGrid, MoreSamplesAreStatedAsWhatTheyAre) {
  // Every sample has the variance v = 2. A tenth of the off-grid points have 200 samples, the
  // others 2: their means have the noise v / 200 and v / 2. For a difference of variance s, the
  // gain c leaves (1 - c)^2 s + c^2 q in each class by its q. Means over the points of a class have
  // the errors of the test above; v comes from all points.
  constexpr std::size_t count = 8000;
  constexpr double s = 1.0, v = 2.0;
  Written written(count);
  base::Rng rng(base::Key(7, base::Stream::Test, 14));
  const auto normal = [&] {
    return std::sqrt(-2.0 * std::log(1.0 - rng.next())) * std::cos(2.0 * base::pi * rng.next());
  };
  const auto samples = [](std::size_t k) { return k % 10 == 0 ? 200.0 : 2.0; };
  std::vector<double> truth;
  for (std::size_t k = 0; k < count; ++k) {
    truth.push_back(10.0 + std::sqrt(s) * normal());
    const double noise = std::sqrt(v / (samples(k) / 2.0));
    written.sample(k, truth[k] + noise * normal(), truth[k] + noise * normal(), samples(k));
  }
  add_off_grid_points(written.off_grid_points, written.estimate, written.shared);
  for (const std::size_t kind : {std::size_t{0}, std::size_t{1}}) {
    double found = 0.0, stated = 0.0, of = 0.0;
    for (std::size_t k = kind; k < count; k += kind == 0 ? 10 : 1) {
      if (kind == 1 && k % 10 == 0) continue;
      found += std::pow(written.value(k) - truth[k], 2);
      stated += double(written.shared.squared_error[1 + k]);
      of += 1.0;
    }
    const double q = v / samples(kind);
    const double c =
        double(wiener_gain(static_cast<float>(s), static_cast<float>(q), 1.0F / float(count)));
    const double left = (1.0 - c) * (1.0 - c) * s + c * c * q;
    // q has the relative error sqrt(2 / count), and so has s + q of the others.
    const double error = left * std::sqrt(2.0 / of) +
                         ((1.0 - c) * (1.0 - c) * (s + v) + c * c * q) * std::sqrt(2.0 / count);
    EXPECT_NEAR(stated / of, found / of, 4.0 * error) << samples(kind) << " samples";
    EXPECT_LT(found / of, std::min(s, q) * (1.0 + 4.0 * std::sqrt(2.0 / of))) << samples(kind);
  }
}

// A row of off-grid points, one per pixel; points up to three pixels apart are mirror neighbours.
class Row {
 public:
  explicit Row(std::size_t count) : written(count), masks_(count, 0U) {
    for (std::size_t k = 0; k < count; ++k) {
      written.off_grid_points[k] = {static_cast<std::uint32_t>(k), no_base, 0, 1.0F};
      first_.push_back(static_cast<std::uint32_t>(k));
      for (std::size_t q = k < 3 ? 0 : k - 3; q <= std::min(count - 1, k + 3); ++q) {
        masks_[k] |= std::uint64_t{1} << (24 + q - k);  // the off-grid point is the middle of 7 x 7
      }
    }
    first_.push_back(static_cast<std::uint32_t>(count));
  }
  void share() {
    add_off_grid_points(written.off_grid_points, written.estimate, written.shared);
    share_among_mirror_neighbours({written.off_grid_points, first_, masks_, 1000}, written.estimate,
                                  written.shared);
  }
  Written written;

 private:
  std::vector<std::uint32_t> first_;
  std::vector<std::uint64_t> masks_;
};

TEST(MirrorNeighbourhood, WhatIsNoNoiseIsKeptWhole) {
  Row row(20);
  for (std::size_t k = 0; k < 20; ++k) row.written.sample(k, 4.0 + double(k), 4.0 + double(k));
  row.share();
  for (std::size_t k = 0; k < 20; ++k) EXPECT_NEAR(row.written.value(k), 4.0 + double(k), 1e-5);
}

TEST(MirrorNeighbourhood, NoiseOfOneSurfaceIsTheirMeans) {
  // Means of two samples of noise 2 q: the mean of seven leaves q / 7 if the gain is 0. Where seven
  // pairs happen to differ little, the gain is positive by chance, and its part is stated, too.
  constexpr std::size_t count = 4000;
  constexpr double q = 0.5;
  Row row(count);
  base::Rng rng(base::Key(7, base::Stream::Test, 13));
  const auto normal = [&] {
    return std::sqrt(-2.0 * std::log(1.0 - rng.next())) * std::cos(2.0 * base::pi * rng.next());
  };
  for (std::size_t k = 0; k < count; ++k) {
    row.written.sample(k, 10.0 + std::sqrt(2.0 * q) * normal(),
                       10.0 + std::sqrt(2.0 * q) * normal());
  }
  row.share();
  double left = 0.0, stated = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    left += std::pow(row.written.value(k) - 10.0, 2) / count;
    stated += double(row.written.shared.squared_error[1 + k]) / count;
  }
  EXPECT_GT(left, q / 7.0);
  EXPECT_GT(stated, left);
  EXPECT_LT(stated, q / 2.0);
}

TEST(MirrorNeighbourhood, MoreSamplesAreStatedAsWhatTheyAre) {
  // A sample has the variance v = 2; every tenth off-grid point has 200, its six mirror neighbours
  // 2 each. Their differences are far larger, so that the gain is 1. The stated error is v / 200,
  // and the noise of the mean of all seven is (6 v / 2 + v / 200) / 7^2. Both come from the squares
  // of six normal numbers at each of 400 places.
  constexpr std::size_t count = 4000;
  constexpr double v = 2.0;
  Row row(count);
  base::Rng rng(base::Key(7, base::Stream::Test, 15));
  const auto normal = [&] {
    return std::sqrt(-2.0 * std::log(1.0 - rng.next())) * std::cos(2.0 * base::pi * rng.next());
  };
  for (std::size_t k = 0; k < count; ++k) {
    const double samples = k % 10 == 5 ? 200.0 : 2.0, noise = std::sqrt(v / (samples / 2.0));
    const double truth = 100.0 + 10.0 * normal();
    row.written.sample(k, truth + noise * normal(), truth + noise * normal(), samples);
  }
  row.share();
  double stated = 0.0;
  for (std::size_t k = 5; k < count; k += 10) {
    stated += double(row.written.shared.squared_error[1 + k]) / (count / 10.0);
  }
  const double expected = v / 200.0 + (6.0 * v / 2.0 + v / 200.0) / 49.0;
  EXPECT_NEAR(stated, expected, 4.0 * expected * std::sqrt(2.0 / (6.0 * count / 10.0)));
}

TEST(MirrorNeighbourhood, OneThatWasNotSampledIsTheMeanOfThoseThatWere) {
  Row row(7);
  for (const std::size_t k : {0U, 1U, 2U, 4U, 5U, 6U}) row.written.sample(k, 3.0, 3.0);
  row.share();
  EXPECT_NEAR(row.written.value(3), 3.0, 1e-6);
}

}  // namespace
}  // namespace earthshine::raytrace
