// SPDX-License-Identifier: Apache-2.0
// Means over neighbours against the double sum.
#include <gtest/gtest.h>

#include <array>

#include "base/numbers/random.h"
#include "raytrace/share/share.h"

namespace earthshine::raytrace {
namespace {

// Points on a plane, a fifth of them holes.
std::vector<GatherPoint> plane_with_holes(const Window& window, base::Rng& rng) {
  std::vector<GatherPoint> points(window.pixel_count());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto columns = static_cast<std::size_t>(window.columns);
    points[p].position = glm::vec3(float(p % columns), float(p / columns), -200.0F);
    points[p].normal = glm::vec3(0.0F, 0.0F, 1.0F);
    points[p].reach_m = rng.next() < 0.2 ? -1.0F : 1.0F;
    points[p].triangle = static_cast<std::uint32_t>(p);
    points[p].spacing_m = 1.0F;
  }
  return points;
}

// sum over dy of k_dy sum over dx of k_dx w v, over the same of w, for points that are no holes; a
// row counts if its point in the column is no hole. Sizes with all kinds of chains: fewer rows than
// a step, more rows than a chain, single rows and columns.
TEST(Neighbours, MeansAreThoseOfTheDoubleSum) {
  constexpr std::array<double, 5> kernel = {1.0 / 16, 1.0 / 4, 3.0 / 8, 1.0 / 4, 1.0 / 16};
  base::Rng rng(base::Key(1, base::Stream::LightSample, 0));
  for (const auto& [columns, rows] :
       {std::array{1, 1}, {1, 70}, {70, 1}, {5, 150}, {37, 41}, {130, 3}}) {
    const Window window{0, 0, columns, rows};
    const std::vector<GatherPoint> points = plane_with_holes(window, rng);
    const Neighbours neighbours(window, points);
    Neighbours::Planes values(2, std::vector<float>(points.size())), means;
    std::vector<float> weight(points.size());
    for (std::size_t p = 0; p < points.size(); ++p) {
      for (auto& plane : values) plane[p] = static_cast<float>(rng.next());
      weight[p] = static_cast<float>(1.0 + rng.next());
    }
    const auto is_there = [&](int x, int y) {
      return x >= 0 && y >= 0 && x < columns && y < rows && points[window.index(x, y)].reach_m > 0;
    };
    for (std::size_t level = 0; level < share_levels + tuning::window_blurs - 1; ++level) {
      for (const bool weighted : {false, true}) {
        neighbours.blur(level, values, weighted ? &weight : nullptr, means);
        const int step = 1 << level;
        for (int y = 0; y < rows; ++y) {
          for (int x = 0; x < columns; ++x) {
            double sum = 0.0, all = 0.0;
            for (int dy = -2; is_there(x, y) && dy <= 2; ++dy) {
              for (int dx = -2; is_there(x, y + dy * step) && dx <= 2; ++dx) {
                const int qx = x + dx * step, qy = y + dy * step;
                if (!is_there(qx, qy)) continue;
                const std::size_t q = window.index(qx, qy);
                const double share = kernel[static_cast<std::size_t>(dx + 2)] *
                                     kernel[static_cast<std::size_t>(dy + 2)] *
                                     (weighted ? double(weight[q]) : 1.0);
                sum += share * double(values[1][q]);
                all += share;
              }
            }
            const double mean = all > 0.0 ? sum / all : 0.0;
            ASSERT_NEAR(means[1][window.index(x, y)], mean, 1e-6) << x << " " << y << " " << level;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace earthshine::raytrace
