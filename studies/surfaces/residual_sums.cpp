// SPDX-License-Identifier: Apache-2.0
#include "studies/surfaces/residual_sums.h"

#include <algorithm>

#include "raytrace/frame/frame.h"

namespace earthshine::studies {
namespace {

// Of n values the square of their mean without what chance adds, and the variance of the mean.
struct MeanSquare {
  double sum = 0.0, squares = 0.0, count = 0.0;
  void add(double value) {
    sum += value;
    squares += value * value;
    count += 1.0;
  }
  [[nodiscard]] double unbiased() const {
    return count > 1.0 ? (sum * sum - squares) / (count * (count - 1.0)) : 0.0;
  }
  [[nodiscard]] double variance() const {
    return count > 1.0 ? std::max(0.0, squares - sum * sum / count) / (count * (count - 1.0))
                       : squares;
  }
};

}  // namespace

void ResidualSums::set(std::size_t point, std::size_t half, const Rgb& lamps, const Rgb& gathered) {
  Point& p = points_[point];
  const Rgb by_lamps = p.rho * (lamps - p.lamps);
  p.rgb[half] = by_lamps + p.rho * (gathered - p.gathered);
  p.by_lamps[half] = base::luminance(by_lamps);
  p.all[half] = base::luminance(p.rgb[half]);
}

void ResidualSums::finish(double mean, PatchResidual& residual) {
  MeanSquare all, lamps, products;
  double apart = 0.0, lamps_apart = 0.0;  // sums of the variance of the two halves' mean
  std::array<double, 2> s_step{}, t_step{}, half_count{};
  for (Point& p : points_) {
    if (!p.placed) continue;
    const double weight = raytrace::error_weight(p.radiosity + 0.5 * (p.all[0] + p.all[1]), mean);
    for (double* value : {&p.all[0], &p.all[1], &p.by_lamps[0], &p.by_lamps[1]}) *value *= weight;
    all.add(0.5 * (p.all[0] + p.all[1]));
    lamps.add(0.5 * (p.by_lamps[0] + p.by_lamps[1]));
    products.add(p.all[0] * p.all[1]);
    apart += 0.25 * (p.all[0] - p.all[1]) * (p.all[0] - p.all[1]);
    lamps_apart += 0.25 * (p.by_lamps[0] - p.by_lamps[1]) * (p.by_lamps[0] - p.by_lamps[1]);
    for (std::size_t half = 0; half < 2; ++half) {
      s_step[half] += p.x < 0.5 ? -p.all[half] : p.all[half];
      t_step[half] += p.y < 0.5 ? -p.all[half] : p.all[half];
    }
  }
  if (all.count == 0.0) return;
  residual.square = products.sum / all.count;
  residual.square_variance = products.variance();
  residual.mean_square = all.unbiased();
  residual.lamps_mean_square = lamps.unbiased();
  const double n2 = all.count * all.count;
  residual.mean_variance = apart / n2;
  residual.lamps_mean_variance = lamps_apart / n2;
  residual.along_s = std::max(0.0, s_step[0] * s_step[1] / n2);
  residual.along_t = std::max(0.0, t_step[0] * t_step[1] / n2);
  // Every other of the points that are there.
  std::size_t k = 0;
  for (const Point& p : points_) {
    if (!p.placed) continue;
    residual.half[k % 2] += 0.5 * (p.rgb[0] + p.rgb[1]);
    half_count[k % 2] += 1.0;
    ++k;
  }
  for (std::size_t half = 0; half < 2; ++half) {
    if (half_count[half] > 0.0) residual.half[half] /= half_count[half];
  }
}

}  // namespace earthshine::studies
