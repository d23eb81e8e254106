// SPDX-License-Identifier: Apache-2.0
// Chance signals, and the stated variance of the signal.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "base/numbers/random.h"
#include "tests/raytrace/share/flat_estimate.h"

namespace earthshine::raytrace::flat_estimate {
namespace {

// Where the true signal is 0: its square minus the stated variance.
double more_than_stated(const Shared& shared, std::size_t p, std::size_t level) {
  const double noise = double(shared.noise[level][p]), found = double(shared.signal[level][p]);
  return found * found - noise * noise * 2.0 * double(shared.inverse_dof[level][p]);
}

// The left columns are another surface, whose signals vary so much more than by chance that no
// window is moved toward the common ratio.
constexpr int strip_px = 8;
std::vector<GatherPoint> with_a_strip() {
  std::vector<GatherPoint> points = flat();
  for (std::size_t p = 0; p < count; ++p) {
    if (p % edge_px < strip_px) points[p].position.z = -3.0F;
  }
  return points;
}
double strip_signal(std::size_t p) {
  return p % edge_px < strip_px ? 1e4 * base::uniform(base::Key(1, base::Stream::Test, p), 0) : 0.0;
}

// Expects a mean of zero, within the scatter of the values.
void expect_none(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0, square = 0.0;
  for (const double value : values) mean += value / n, square += value * value / n;
  EXPECT_NEAR(mean, 0.0, 4.0 * std::sqrt((square - mean * mean) / (n - 1.0)));
}

TEST(Signals, ASmoothPictureStatesLittleThatNoiseMayHide) {
  // Noise only. Each window's signal has the standard error sigma = q sqrt(2 / N), 100 details; its
  // positive part, sigma / sqrt(2 pi) on average, would be stated. The mean of the plane's
  // 48^2 / 100 windows has an error of a fifth of that, and so has the remaining share of each
  // window.
  constexpr int fields = 50;
  const Neighbours neighbours(window, flat());
  double found = 0.0, stated = 0.0, alone = 0.0;
  for (std::uint64_t seed = 1; seed <= fields; ++seed) {
    base::Rng rng(base::Key(seed, base::Stream::Test, 34));
    const Shared shared = share(neighbours, estimate_of([&](int, int, std::size_t) {
                                  return 10.0 + std::sqrt(12.0) * (rng.next() - 0.5);
                                }));
    for (std::size_t p = 0; p < count; ++p) {
      const double off = double(shared.radiance[p].g) - 10.0;
      found += off * off;
      stated += double(shared.squared_error[p]);
      const double sigma =
          double(shared.noise[0][p]) * std::sqrt(2.0 * double(shared.inverse_dof[0][p]));
      alone += sigma / std::sqrt(2.0 * base::pi);
    }
  }
  EXPECT_LT(found, stated);
  EXPECT_LT(stated - found, 0.5 * alone);
}

TEST(Signals, HowFarOffASignalIsByChanceIsStated) {
  // One of ten samples has all the light: the signal is 0, and its estimate, the difference of two
  // chance squares over a window, has the variance q^2 2 / N, for details of 1 to 8 pixels. In the
  // mean over 400 fields, within their scatter.
  constexpr int fields = 400;
  const Neighbours neighbours(window, with_a_strip());
  std::array<std::vector<double>, 4> more;
  for (std::uint64_t seed = 1; seed <= fields; ++seed) {
    base::Rng rng(base::Key(seed, base::Stream::Test, 32));
    const Shared shared =
        share(neighbours, estimate_of([&](int x, int y, std::size_t) {
                return strip_signal(pixel(x, y)) + (rng.next() < 0.1 ? 10.0 : 0.0);
              }));
    const std::size_t p = pixel(24, 24);
    for (std::size_t level = 0; level < more.size(); ++level) {
      more[level].push_back(more_than_stated(shared, p, level));
    }
  }
  for (const std::vector<double>& of_level : more) expect_none(of_level);
}

TEST(Signals, HowFarOffASignalIsByChanceGoesByTheSamplesThere) {
  // Noise of variance 1 per sample. Blocks of 2 x 2, one block of four, have 64 samples in each
  // half, all other points one: s and q of a point are for its own number of samples. As above, for
  // a point of each class.
  constexpr int fields = 400;
  const Neighbours neighbours(window, with_a_strip());
  std::array<std::vector<double>, 2> more;
  for (std::uint64_t seed = 1; seed <= fields; ++seed) {
    base::Rng rng(base::Key(seed, base::Stream::Test, 33));
    Estimate estimate(count, 1, 1);
    for (std::size_t p = 0; p < count; ++p) {
      const bool many = p % edge_px / 2 % 2 == 0 && p / edge_px / 2 % 2 == 0;
      const double half = many ? 64.0 : 1.0;
      const auto of_half = [&] {
        const double noise = std::sqrt(12.0 / half) * (rng.next() - 0.5);
        return static_cast<float>(half * (10.0 + strip_signal(p) + noise));
      };
      const float first = of_half(), second = of_half();
      estimate.add_luminance(p, first, second);
      estimate.sum[p] = glm::vec3(first + second);
      estimate.samples[p] = static_cast<float>(2.0 * half);
    }
    const Shared shared = share(neighbours, estimate);
    for (std::size_t inverse_dof = 0; inverse_dof < more.size(); ++inverse_dof) {
      const std::size_t p = inverse_dof == 0 ? pixel(24, 24) : pixel(26, 26);
      more[inverse_dof].push_back(more_than_stated(shared, p, 0));
    }
  }
  for (const std::vector<double>& of_point : more) expect_none(of_point);
}

}  // namespace
}  // namespace earthshine::raytrace::flat_estimate
