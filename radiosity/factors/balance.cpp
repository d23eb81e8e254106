// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/free_memory.h"
#include "base/parallel.h"
#include "radiosity/factors/column_sums.h"
#include "radiosity/factors/filled_hits.h"
#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {
namespace {

constexpr int most_sweeps = 500;  // passes over the matrix there and back
constexpr int plain_sweeps = 4;
constexpr double largest_scale = 1e6;

// The scaling in progress. In logarithms of the scales the two laws are the gradient of a convex
// function (Sinkhorn's problem with the sky and the black backs as one more row and column); rows
// are kept exact, so that what is left to bring to zero is the columns' defect as a function of the
// column scales.
class Scaling {
 public:
  Scaling(FormFactors& factors, std::span<const double> area_m2)
      : f_(factors),
        area_m2_(area_m2),
        raw_row_scale_(factors.row_scale),
        row_(factors.count(), 1.0),
        seen_(factors.count()),
        total_m2_(std::accumulate(area_m2.begin(), area_m2.end(), 0.0)) {
    for (std::size_t i = 0; i < seen_.size(); ++i) seen_[i] = f_.sky[i] + f_.black[i];
    update_sums();
  }

  // From the hits as they are now, without scales.
  void start() {
    f_.row_scale = raw_row_scale_;
    std::fill(f_.column_scale.begin(), f_.column_scale.end(), 1.0);
    close_rows();
  }

  // Gives the matrix more hits and starts anew. Returns how many.
  std::size_t fill() {
    f_.row_scale = raw_row_scale_;
    const std::size_t filled = fill_both_ways(f_, area_m2_);
    start();
    return filled;
  }

  // sum_j |what the columns hold - A_j| / sum_j A_j.
  [[nodiscard]] double defect() const {
    double sum = 0.0;
    for (std::size_t j = 0; j < sums_.size(); ++j) sum += std::abs(sums_[j] - area_m2_[j]);
    return total_m2_ > 0.0 ? sum / total_m2_ : 0.0;
  }

  // The patch whose column is furthest from its sum.
  [[nodiscard]] std::uint32_t worst() const {
    std::size_t worst = 0;
    const auto defect = [&](std::size_t j) { return std::abs(sums_[j] - area_m2_[j]); };
    for (std::size_t j = 1; j < sums_.size(); ++j) {
      if (defect(j) > defect(worst)) worst = j;
    }
    return static_cast<std::uint32_t>(worst);
  }

  // After fill(): what the patches keep for themselves, of sum_j A_j.
  [[nodiscard]] double held() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (!keeps_its_own(f_, area_m2_, i)) continue;
      sum += area_m2_[i] * f_.kept[i] * own_share * row_[i] * f_.column_scale[i];
    }
    return sum / total_m2_;
  }

  // Iterative proportional fitting: every column to its target, then every row.
  void sweep() {
    for (std::size_t j = 0; j < sums_.size(); ++j) {
      if (sums_[j] > 0.0) scale_column(j, area_m2_[j] / sums_[j]);
    }
    close_rows();
  }

  // Newton's step: what the sums would be to first order, rows following, is right for all columns
  // at once. Sweeps creep where parts of a scene exchange little light; this does not. Keeps the
  // step only if it helps. Returns the passes over the matrix.
  int newton_step(int most_passes) {
    const std::vector<double> old_column = f_.column_scale;
    const double before = defect();
    std::vector<double> step;
    int passes = solve_for_step(step, most_passes);
    const double largest = *std::max_element(
        step.begin(), step.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    // Logarithms beyond this are outside of what first order says.
    const double damping = std::min(1.0, 1.0 / std::max(1e-300, std::abs(largest)));
    for (std::size_t j = 0; j < step.size(); ++j) scale_column(j, std::exp(damping * step[j]));
    close_rows();
    if (!(defect() < before)) {
      f_.column_scale = old_column;
      close_rows();
      sweep();
    }
    return passes + 1;
  }

  void close_rows() {
    const base::Shares::Range own = f_.shares.own(f_.count());
    base::parallel_chunks(own.end - own.begin, 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = own.begin + begin; i < own.begin + end; ++i) {
        double landed = 0.0;
        for (std::uint64_t e = f_.row_start[i]; e < f_.row_start[i + 1]; ++e) {
          const std::uint32_t j = f_.column[e];
          landed += double(f_.hits[e]) * f_.kept[j] * f_.column_scale[j];
        }
        const double sum = landed * raw_row_scale_[i] + seen_[i];
        row_[i] = sum > 0.0 ? 1.0 / sum : 1.0;
      }
    });
    f_.shares.tell(row_.data());
    for (std::size_t i = 0; i < row_.size(); ++i) f_.row_scale[i] = raw_row_scale_[i] * row_[i];
    update_sums();
  }

  // The shares of sky and black backs follow the scales.
  void finish() {
    const std::size_t parts = row_.empty() ? 0 : f_.sky_illuminance.size() / row_.size();
    for (std::size_t i = 0; i < row_.size(); ++i) {
      f_.sky[i] *= row_[i];
      f_.black[i] *= row_[i];
      for (std::size_t p = 0; p < parts; ++p) f_.sky_illuminance[i * parts + p] *= row_[i];
      f_.escape[i] *= f_.column_scale[i];
      f_.lost[i] *= f_.column_scale[i];
    }
  }

 private:
  // The bound stops a column that too few rays reached to ever fill from running off to infinity.
  void scale_column(std::size_t j, double factor) {
    f_.column_scale[j] = std::min(f_.column_scale[j] * factor, largest_scale);
  }

  void update_sums() {
    sums_ = weighted_column_sums(f_, [&](std::size_t i) { return area_m2_[i] * f_.kept[i]; });
    for (std::size_t j = 0; j < sums_.size(); ++j) {
      sums_[j] += area_m2_[j] * f_.column_scale[j] * seen_[j];
    }
  }

  // The change of a_j * sums when the column scales' logarithms change by `step`.
  [[nodiscard]] std::vector<double> response(const std::vector<double>& step) const {
    const std::size_t count = step.size();
    std::vector<double> weighted(count), rows(count);
    for (std::size_t j = 0; j < count; ++j) weighted[j] = f_.kept[j] * step[j];
    multiply(f_, weighted, rows, 1);
    std::vector<double> change =
        weighted_column_sums(f_, [&](std::size_t i) { return area_m2_[i] * f_.kept[i] * rows[i]; });
    for (std::size_t j = 0; j < count; ++j) {
      change[j] = f_.kept[j] * (sums_[j] * step[j] - change[j]);
    }
    return change;
  }

  // Conjugate gradients with the diagonal as preconditioner; a tenth of the defect is left to the
  // next step, which knows more.
  int solve_for_step(std::vector<double>& step, int most_passes) const {
    const std::size_t count = sums_.size();
    step.assign(count, 0.0);
    std::vector<double> left(count), way(count), diagonal(count);
    const auto dot = [count](const std::vector<double>& a, const std::vector<double>& b) {
      double sum = 0.0;
      for (std::size_t j = 0; j < count; ++j) sum += a[j] * b[j];
      return sum;
    };
    const auto conditioned = [&](const std::vector<double>& v) {
      std::vector<double> w(count);
      for (std::size_t j = 0; j < count; ++j) w[j] = diagonal[j] > 0.0 ? v[j] / diagonal[j] : 0.0;
      return w;
    };
    for (std::size_t j = 0; j < count; ++j) {
      diagonal[j] = f_.kept[j] * sums_[j];
      left[j] = f_.kept[j] * (area_m2_[j] - sums_[j]);
    }
    std::vector<double> z = conditioned(left);
    way = z;
    double size = dot(left, z);
    const double wanted = 0.01 * size;  // a tenth in the norm whose square this is
    int passes = 0;
    while (passes < most_passes && size > wanted) {
      const std::vector<double> change = response(way);
      ++passes;
      const double curvature = dot(way, change);
      if (!(curvature > 0.0)) break;
      const double length = size / curvature;
      for (std::size_t j = 0; j < count; ++j) {
        step[j] += length * way[j];
        left[j] -= length * change[j];
      }
      z = conditioned(left);
      const double next = dot(left, z);
      for (std::size_t j = 0; j < count; ++j) way[j] = z[j] + next / size * way[j];
      size = next;
    }
    // A perfect mirror keeps nothing, so that no row feels its column's scale: it follows alone.
    for (std::size_t j = 0; j < count; ++j) {
      if (f_.kept[j] <= 0.0 && sums_[j] > 0.0) step[j] = std::log(area_m2_[j] / sums_[j]);
    }
    return passes;
  }

  FormFactors& f_;
  std::span<const double> area_m2_;
  std::vector<double> raw_row_scale_;
  std::vector<double> row_;   // relative to the raw rows
  std::vector<double> seen_;  // raw F_i,sky + F_i,black
  std::vector<double> sums_;  // sum_i A_i a_i F_ij + A_j (escape_j + lost_j)
  double total_m2_;
};

// When to stop trying.
struct Patience {
  int passes_a_step;  // of conjugate gradients; where a scaling exists some ten bring a tenth
  double least_gain;  // a step that leaves more of the defect than that is the last
};
// The hits as cast may admit no scaling: the defect then stays, or shrinks by about e a step, while
// scales run off and take hits that fit nowhere to nothing.
constexpr Patience with_hits{60, 0.25};
// Filled ones do: what ends it is rounding.
constexpr Patience with_filled{most_sweeps, 0.999};

// Sweeps until the defect is `enough` or patience ends.
void iterate(Scaling& scaling, double enough, const Patience& patience, BalanceReport& report) {
  int passes = 0;
  report.after = scaling.defect();
  while (passes < most_sweeps && report.after > enough) {
    const double previous = report.after;
    if (passes < plain_sweeps) {
      scaling.sweep();
      ++passes;
    } else {
      passes += scaling.newton_step(std::min(patience.passes_a_step, most_sweeps - passes));
    }
    report.after = scaling.defect();
    if (report.after > patience.least_gain * previous && passes > plain_sweeps) break;
  }
  report.sweeps += passes;
}

}  // namespace

BalanceReport balance(FormFactors& factors, std::span<const double> area_m2, double enough) {
  constexpr double rounding = 1e-12;
  BalanceReport report;
  if (factors.count() == 0) {
    report.balanced = true;
    return report;
  }
  report.before = Scaling(factors, area_m2).defect();
  report.borrowed = borrow_starved_columns(factors, area_m2);
  Scaling scaling(factors, area_m2);
  scaling.start();
  iterate(scaling, enough, with_hits, report);
  if (report.after > std::max(enough, rounding)) {
    report.filled = scaling.fill();
    iterate(scaling, enough, with_filled, report);
    report.held = scaling.held();
  }
  report.balanced = report.after <= rounding;
  if (!report.balanced) report.worst = scaling.worst();
  scaling.finish();
  base::give_back_freed_memory();
  return report;
}

}  // namespace earthshine::radiosity
