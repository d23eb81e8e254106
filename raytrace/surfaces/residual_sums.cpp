// SPDX-License-Identifier: Apache-2.0
#include "raytrace/surfaces/residual_sums.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "raytrace/frame/frame.h"

namespace earthshine::raytrace {
namespace {

constexpr double far_apart = 0.1;     // difference of the halves of shadow rays, over the mean
constexpr double most_weighed = 2.0;  // limit on weighted gathered light, over the larger of bright
                                      // light and the solution

// Of n values: the squared mean without bias by noise, and the variance of the mean.
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
  p.gathered_lx[half] = base::luminance(gathered);
}

bool ResidualSums::is_unsure(std::size_t point, double mean) const {
  constexpr double another = 1.5;
  const Point& p = points_[point];
  const auto [least, most] = std::minmax({0.0, p.all[0], p.all[1]});
  return error_weight(p.radiosity + least, mean) > another * error_weight(p.radiosity + most, mean);
}

void ResidualSums::weigh_by(std::size_t point, const Rgb& lamps, const Rgb& gathered) {
  Point& p = points_[point];
  p.weighed_by = base::luminance(p.rho * (lamps - p.lamps + gathered - p.gathered));
}

void ResidualSums::finish(double mean, PatchResidual& residual) {
  MeanSquare all, lamps, products;
  double weights = 0.0, unweighted = 0.0;
  double apart = 0.0, lamps_apart = 0.0;  // sums of the variance of the two halves' mean
  std::array<double, 2> s_step{}, t_step{}, gathered{};
  for (Point& p : points_) {
    if (!p.placed) continue;
    const double off = p.weighed_by.value_or(0.5 * (p.all[0] + p.all[1]));
    const double weight = error_weight(p.radiosity + std::max(0.0, off), mean);
    weights += weight;
    unweighted += p.all[0] * p.all[1];
    // Limits outliers of gather rays: the true weighted value cannot exceed `most`, a single chance
    // hit can.
    const double most = mean > 0.0 ? most_weighed * std::max(p.radiosity, error_bright * mean)
                                   : std::numeric_limits<double>::infinity();
    for (std::size_t half = 0; half < 2; ++half) {
      const double brought = std::clamp(weight * (p.all[half] - p.by_lamps[half]), -most, most);
      p.by_lamps[half] *= weight;
      p.all[half] = p.by_lamps[half] + brought;
    }
    all.add(0.5 * (p.all[0] + p.all[1]));
    lamps.add(0.5 * (p.by_lamps[0] + p.by_lamps[1]));
    products.add(p.all[0] * p.all[1]);
    apart += 0.25 * (p.all[0] - p.all[1]) * (p.all[0] - p.all[1]);
    lamps_apart += 0.25 * (p.by_lamps[0] - p.by_lamps[1]) * (p.by_lamps[0] - p.by_lamps[1]);
    for (std::size_t half = 0; half < 2; ++half) {
      gathered[half] += p.gathered_lx[half];
      s_step[half] += p.x < 0.5 ? -p.all[half] : p.all[half];
      t_step[half] += p.y < 0.5 ? -p.all[half] : p.all[half];
    }
  }
  if (all.count == 0.0) return;
  const auto kept = [](double value) { return static_cast<float>(value); };
  residual.weight = kept(weights / all.count);
  residual.unweighted = kept(unweighted / all.count);
  residual.square = kept(products.sum / all.count);
  residual.square_error = kept(std::sqrt(products.variance()));
  residual.mean_square = kept(all.unbiased());
  residual.lamps_mean_square = kept(lamps.unbiased());
  const double n2 = all.count * all.count;
  residual.mean_variance = kept(apart / n2);
  residual.lamps_mean_variance = kept(lamps_apart / n2);
  residual.wants_shadow_rays = lamps_apart / all.count > base::squared(far_apart * mean);
  for (std::size_t h = 0; h < 2; ++h) residual.gathered[h] = kept(gathered[h] / all.count);
  residual.along_s = kept(std::max(0.0, s_step[0] * s_step[1] / n2));
  residual.along_t = kept(std::max(0.0, t_step[0] * t_step[1] / n2));
  finish_halves(residual);
}

void ResidualSums::finish_halves(PatchResidual& residual) const {
  std::array<Rgb, 2> half{Rgb(0.0), Rgb(0.0)};
  std::array<double, 2> half_count{}, mean_of{};
  std::size_t k = 0;
  for (const Point& p : points_) {
    if (!p.placed) continue;
    half[k % 2] += 0.5 * (p.rgb[0] + p.rgb[1]);
    mean_of[k % 2] += 0.5 * (p.all[0] + p.all[1]);
    half_count[k % 2] += 1.0;
    ++k;
  }
  for (std::size_t h = 0; h < 2; ++h) {
    if (half_count[h] <= 0.0) continue;
    residual.half[h] = glm::vec3(half[h] / half_count[h]);
    residual.mean[h] = static_cast<float>(mean_of[h] / half_count[h]);
  }
}

}  // namespace earthshine::raytrace
