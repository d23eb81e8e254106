// SPDX-License-Identifier: Apache-2.0
#include "degrade/moments/point_moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "base/numbers/gauss_rule.h"
#include "base/parallel.h"

namespace earthshine::degrade {
namespace {

constexpr double reach = 8.5;  // sigma; the probability beyond is 2e-17

// Means of g = f - reference, g^2, g z and g (z^2 - 1) over a standard normal z. The reference is
// near the mean, which avoids cancellation in the variance.
struct Sums {
  double g = 0.0, g2 = 0.0, gz = 0.0, gzz = 0.0;

  void add(double value, double z, double weight) {
    g += weight * value;
    g2 += weight * value * value;
    gz += weight * value * z;
    gzz += weight * value * (z * z - 1.0);
  }
  [[nodiscard]] PointMoments moments(double reference, double sigma) const {
    // The variance is at least the sum of its first two orders, despite rounding.
    return {reference + g, std::max(g2 - g * g, gz * gz + 0.5 * gzz * gzz), gz / sigma,
            gzz / (sigma * sigma)};
  }
};

// For smooth f: the trapezoidal rule of step 1 is exact to exp(-2 pi^2) = 3e-9.
PointMoments far_from_kinks(const PointMap& map, double mean, double sigma, double reference) {
  static const auto weight = [] {
    std::array<double, 13> w{};
    double total = 0.0;
    for (int k = 0; k < 13; ++k) total += w[static_cast<std::size_t>(k)] = normal_density(k - 6);
    for (double& value : w) value /= total;
    return w;
  }();
  Sums sums;
  for (int k = 0; k < 13; ++k) {
    const double z = k - 6;
    sums.add(map(mean + sigma * z) - reference, z, weight[static_cast<std::size_t>(k)]);
  }
  return sums.moments(reference, sigma);
}

// Adds a smooth interval from z = a to b.
template <class F>
void add_smooth(Sums& sums, double a, double b, bool kink_at_a, F g) {
  if (kink_at_a) {
    // S^(1/gamma) has an infinite slope at its kink. z = a + (end - a) t^3 turns S^p into
    // t^(3p + 2), which Gauss's rule integrates like a polynomial.
    const double end = std::min(b, a + 2.0);
    const base::GaussRule& rule = base::gauss_rule(14);
    for (std::size_t k = 0; k < rule.node.size(); ++k) {
      const double t = rule.node[k], z = a + (end - a) * t * t * t;
      sums.add(g(z), z, 3.0 * t * t * (end - a) * rule.weight[k] * normal_density(z));
    }
    a = end;
  }
  const int panels = static_cast<int>(std::ceil((b - a) / 4.0));
  const base::GaussRule& rule = base::gauss_rule(10);
  const double width = (b - a) / std::max(1, panels);
  for (int panel = 0; panel < panels; ++panel) {
    for (std::size_t k = 0; k < rule.node.size(); ++k) {
      const double z = a + (panel + rule.node[k]) * width;
      sums.add(g(z), z, width * rule.weight[k] * normal_density(z));
    }
  }
}

// Spacing of the table in mean / sigma, and a finer one in ln sigma because tails change fast with
// it.
constexpr double spacing = 0.2, log_spacing = 0.1;
constexpr int before = 2, after = 3;  // nodes of the fifth-degree polynomial around a point

// Moments at the nodes mean = i * spacing * sigma of one sigma = exp(level * log_spacing).
struct Row {
  double sigma = 0.0;
  std::int64_t first = 0, last = -1;
  using Node = std::array<double, 4>;  // mean, variance, slope, curvature
  std::vector<Node> at;

  void cover(double low, double high) {
    const std::int64_t from =
        static_cast<std::int64_t>(std::floor(low / (spacing * sigma))) - before;
    const std::int64_t to = static_cast<std::int64_t>(std::floor(high / (spacing * sigma))) + after;
    if (last < first) first = from, last = to;
    first = std::min(first, from);
    last = std::max(last, to);
  }
};

// Lagrange weights of the nodes -2 to 3 at t in [0, 1].
using Weights = std::array<double, before + 1 + after>;
Weights lagrange(double t) {
  const double a = t + 2.0, b = t + 1.0, c = t, d = t - 1.0, e = t - 2.0, f = t - 3.0;
  const double ab = a * b, cd = c * d, ef = e * f;
  return {(-1.0 / 120.0) * b * cd * ef, (1.0 / 24.0) * a * cd * ef,  (-1.0 / 12.0) * ab * d * ef,
          (1.0 / 12.0) * ab * c * ef,   (-1.0 / 24.0) * ab * cd * f, (1.0 / 120.0) * ab * cd * e};
}

double row_sigma(int level) { return std::exp(level * log_spacing); }
int level_of(double sigma) { return static_cast<int>(std::floor(std::log(sigma) / log_spacing)); }

// Interpolates the moments in (mean / sigma, ln sigma). Both scale with sigma, because noise
// smooths any f at the scale of sigma. Only levels for which a table saves time are tabulated.
class Table {
 public:
  Table(const PointMap& map, const Plane& mean, const Plane& variance) {
    struct Use {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      std::size_t count = 0;
    };
    std::map<int, Use> uses;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      if (!(variance[i] > 0.0F)) continue;
      Use& use = uses[level_of(std::sqrt(static_cast<double>(variance[i])))];
      use.low = std::min(use.low, static_cast<double>(mean[i]));
      use.high = std::max(use.high, static_cast<double>(mean[i]));
      ++use.count;
    }
    if (uses.empty()) return;
    lowest_ = uses.begin()->first;
    const auto levels = static_cast<std::size_t>(uses.rbegin()->first - lowest_ + 1);
    is_tabulated_.assign(levels, false);
    rows_.resize(levels + before + after);
    for (const auto& [level, use] : uses) {
      const double nodes =
          6.0 * ((use.high - use.low) / (spacing * row_sigma(level - before)) + 6.0);
      if (!(2.0 * nodes < static_cast<double>(use.count))) continue;
      for (int k = level - before; k <= level + after; ++k) {
        Row& row = rows_[static_cast<std::size_t>(k - lowest_ + before)];
        row.sigma = row_sigma(k);
        row.cover(use.low, use.high);
      }
      is_tabulated_[static_cast<std::size_t>(level - lowest_)] = true;
    }
    for (Row& row : rows_) {
      row.at.resize(static_cast<std::size_t>(row.last - row.first + 1));
      base::parallel_chunks(row.at.size(), 64, [&, r = &row](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const double node = static_cast<double>(r->first + static_cast<std::int64_t>(i));
          const PointMoments m = through(map, node * spacing * r->sigma, r->sigma);
          r->at[i] = {m.mean, m.variance, m.slope, m.curvature};
        }
      });
    }
  }

  [[nodiscard]] std::optional<PointMoments> operator()(double mean, double sigma) const {
    const auto all = interpolated<4>(mean, sigma);
    if (!all) return {};
    PointMoments sum{(*all)[0], (*all)[1], (*all)[2], (*all)[3]};
    // The polynomial may overshoot where the variance vanishes.
    sum.slope = std::max(sum.slope, 0.0);
    const double first = sum.slope * sigma, second = sum.curvature * sigma * sigma;
    sum.variance = std::max(sum.variance, first * first + 0.5 * second * second);
    return sum;
  }
  [[nodiscard]] std::optional<double> mean(double mean, double sigma) const {
    const auto all = interpolated<1>(mean, sigma);
    return all ? std::optional(all->front()) : std::nullopt;
  }

 private:
  // The first `count` moments of a node.
  template <std::size_t count>
  [[nodiscard]] std::optional<std::array<double, count>> interpolated(double mean,
                                                                      double sigma) const {
    const double log_sigma = std::log(sigma) / log_spacing, below = std::floor(log_sigma);
    const int level = static_cast<int>(below) - lowest_;
    if (level < 0 || level >= static_cast<int>(is_tabulated_.size())) return {};
    if (!is_tabulated_[static_cast<std::size_t>(level)]) return {};
    const Weights across = lagrange(log_sigma - below);
    std::array<double, count> all{};
    for (std::size_t j = 0; j < across.size(); ++j) {
      const Row& r = rows_[static_cast<std::size_t>(level) + j];  // from level - before
      const double place = mean / (spacing * r.sigma), node = std::floor(place);
      const Weights along = lagrange(place - node);
      const Row::Node* at =
          &r.at[static_cast<std::size_t>(static_cast<std::int64_t>(node) - before - r.first)];
      std::array<double, count> of_row{};
      for (std::size_t k = 0; k < along.size(); ++k) {
        for (std::size_t m = 0; m < count; ++m) of_row[m] += along[k] * at[k][m];
      }
      for (std::size_t m = 0; m < count; ++m) all[m] += across[j] * of_row[m];
    }
    return all;
  }

  int lowest_ = 0;
  std::vector<Row> rows_;           // from lowest_ - before on
  std::vector<bool> is_tabulated_;  // from lowest_ on
};

}  // namespace

double normal_probability(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_density(double z) {
  return 0.5 * std::numbers::inv_sqrtpi * std::numbers::sqrt2 * std::exp(-0.5 * z * z);
}

PointMoments clamped(double mean, double sigma, double low, double high) {
  if (!(sigma > 0.0)) return {std::clamp(mean, low, high), 0.0, 0.0, 0.0};
  const double reference = std::clamp(mean, low, high);
  const double a = (low - mean) / sigma, b = (high - mean) / sigma;
  const double r = (reference - mean) / sigma;
  // Moments of z - r between the limits, and at the limits, in units of sigma.
  const double inside = a > 0.0 ? normal_probability(-a) - normal_probability(-b)
                                : normal_probability(b) - normal_probability(a);
  const double pa = std::isfinite(a) ? normal_density(a) : 0.0;
  const double pb = std::isfinite(b) ? normal_density(b) : 0.0;
  double first = pa - pb - r * inside;
  double second = inside * (1.0 + r * r) + 2.0 * r * (pb - pa);
  if (std::isfinite(a)) {
    second += a * pa;
    first += (a - r) * normal_probability(a);
    second += (a - r) * (a - r) * normal_probability(a);
  }
  if (std::isfinite(b)) {
    second -= b * pb;
    first += (b - r) * normal_probability(-b);
    second += (b - r) * (b - r) * normal_probability(-b);
  }
  return {reference + sigma * first, sigma * sigma * std::max(0.0, second - first * first), inside,
          (pa - pb) / sigma};
}

PointMoments through(const PointMap& map, double mean, double sigma) {
  const double reference = map(mean);
  if (!(sigma > 0.0)) return {reference, 0.0, 0.0, 0.0};
  const std::vector<double>& kinks = map.kinks();
  const auto in_reach = [&](double z) {
    return static_cast<std::size_t>(std::lower_bound(kinks.begin(), kinks.end(), mean + z * sigma) -
                                    kinks.begin());
  };
  const std::size_t first = in_reach(-reach), last = in_reach(reach);
  if (first == last) {
    if (map.stretches()[first].level) return {reference, 0.0, 0.0, 0.0};
    return far_from_kinks(map, mean, sigma, reference);
  }
  Sums sums;
  double a = -reach, below = 0.0, density = 0.0;
  for (std::size_t k = first; k <= last; ++k) {
    const double b = k < last ? (kinks[k] - mean) / sigma : reach;
    const double below_b = k < last ? normal_probability(b) : 1.0;
    const double density_b = k < last ? normal_density(b) : 0.0;
    if (const PointMap::Stretch& stretch = map.stretches()[k]; stretch.level) {
      const double value = stretch.value - reference;
      sums.g += value * (below_b - below);
      sums.g2 += value * value * (below_b - below);
      sums.gz += value * (density - density_b);
      sums.gzz += value * (a * density - b * density_b);
    } else {
      add_smooth(sums, a, b, k > first,
                 [&](double z) { return map(mean + sigma * z) - reference; });
    }
    a = b;
    below = below_b;
    density = density_b;
  }
  return sums.moments(reference, sigma);
}

namespace {

// Calls take(i, mean, sigma, table) for each pixel.
template <class Take>
void for_each_pixel(const PointMap& map, const Plane& mean, const Plane& variance, Take take) {
  const Table table(map, mean, variance);
  base::parallel_chunks(mean.size(), 2048, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      take(i, static_cast<double>(mean[i]),
           std::sqrt(std::max(0.0, static_cast<double>(variance[i]))), table);
    }
  });
}

}  // namespace

MomentPlanes through(const PointMap& map, const Plane& mean, const Plane& variance) {
  MomentPlanes out{Plane(mean.size()), Plane(mean.size()), Plane(mean.size()), Plane(mean.size())};
  const auto take = [&](std::size_t i, double mu, double sigma, const Table& table) {
    std::optional<PointMoments> m;
    if (sigma > 0.0) m = table(mu, sigma);
    if (!m) m = through(map, mu, sigma);
    out.mean[i] = static_cast<float>(m->mean);
    out.variance[i] = static_cast<float>(m->variance);
    out.slope[i] = static_cast<float>(m->slope);
    out.curvature[i] = static_cast<float>(m->curvature);
  };
  for_each_pixel(map, mean, variance, take);
  return out;
}

Plane mean_through(const PointMap& map, const Plane& mean, const Plane& variance) {
  Plane out(mean.size());
  const auto take = [&](std::size_t i, double mu, double sigma, const Table& table) {
    std::optional<double> m;
    if (sigma > 0.0) m = table.mean(mu, sigma);
    out[i] = static_cast<float>(m ? *m : through(map, mu, sigma).mean);
  };
  for_each_pixel(map, mean, variance, take);
  return out;
}

}  // namespace earthshine::degrade
