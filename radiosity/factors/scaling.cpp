// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/scaling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/free_memory.h"
#include "base/parallel.h"
#include "radiosity/factors/column_sums.h"
#include "radiosity/factors/filled_hits.h"
#include "radiosity/factors/row_sums.h"

namespace earthshine::radiosity {
namespace {

constexpr double largest_scale = 1e6;

}  // namespace

template <class Value>
double Scaling::sum_of(Value value) const {
  return sums_over_rows(f_, 1, [&](std::size_t begin, std::size_t end, double* sum) {
    for (std::size_t k = begin; k < end; ++k) sum[0] += value(k);
  })[0];
}

Scaling::Scaling(FormFactors& factors, std::span<const double> area_m2)
    : f_(factors),
      area_m2_(area_m2),
      own_(factors.shares.own(factors.count())),
      raw_(factors.row_scale.begin() + static_cast<std::ptrdiff_t>(own_.begin),
           factors.row_scale.begin() + static_cast<std::ptrdiff_t>(own_.end)),
      row_(raw_.size(), 1.0),
      total_m2_(std::accumulate(area_m2.begin(), area_m2.end(), 0.0)) {
  update_sums();
}

void Scaling::start() {
  std::fill(f_.column_scale.begin(), f_.column_scale.end(), 1.0);
  close_rows();
}

std::size_t Scaling::fill() {
  std::copy(raw_.begin(), raw_.end(),
            f_.row_scale.begin() + static_cast<std::ptrdiff_t>(own_.begin));
  const std::size_t filled = fill_reciprocal(f_, area_m2_);
  start();
  return filled;
}

double Scaling::defect() const {
  if (total_m2_ <= 0.0) return 0.0;
  return sum_of([&](std::size_t k) { return std::abs(sums_[k] - area_m2_[own_.begin + k]); }) /
         total_m2_;
}

std::uint32_t Scaling::most(const std::function<double(std::size_t k)>& value) const {
  struct Patch {
    double value = -1.0;
    std::uint32_t number = 0;
  } own;
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    if (const double v = value(k); v > own.value) {
      own = {v, static_cast<std::uint32_t>(own_.begin + k)};
    }
  }
  Patch of_all = f_.shares.divided() ? Patch() : own;
  f_.shares.sequential_reduce([&](base::Parcel& parcel) { parcel.pass(own); },
                              [&](base::Parcel& parcel) {
                                Patch theirs;
                                parcel.pass(theirs);
                                if (theirs.value > of_all.value) of_all = theirs;
                              });
  return of_all.number;
}

std::uint32_t Scaling::worst() const {
  return most([&](std::size_t k) { return std::abs(sums_[k] - area_m2_[own_.begin + k]); });
}

double Scaling::held_m2(std::size_t k) const {
  const std::size_t i = own_.begin + k;
  if (!keeps_its_own(f_, area_m2_, i)) return 0.0;
  return area_m2_[i] * f_.kept[i] * own_share * row_[k] * f_.column_scale[i];
}

double Scaling::held() const {
  return sum_of([&](std::size_t k) { return held_m2(k); }) / total_m2_;
}

std::uint32_t Scaling::holds_most() const {
  return most([&](std::size_t k) { return held_m2(k); });
}

void Scaling::sweep() {
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    const std::size_t j = own_.begin + k;
    if (sums_[k] > 0.0) scale_column(j, area_m2_[j] / sums_[k]);
  }
  close_rows();
}

int Scaling::newton_step(int most_passes) {
  const auto own = f_.column_scale.begin() + static_cast<std::ptrdiff_t>(own_.begin);
  const std::vector<double> old_scales(own, own + static_cast<std::ptrdiff_t>(row_.size()));
  const double before = defect();
  std::vector<double> step;
  int passes = solve_for_step(step, most_passes);
  std::vector<double> largest = {0.0};
  for (const double s : step) largest[0] = std::max(largest[0], std::abs(s));
  keep_largest(f_.shares, largest);
  // Limits the step where the first-order model is invalid.
  const double damping = std::min(1.0, 1.0 / std::max(1e-300, largest[0]));
  for (std::size_t k = 0; k < step.size(); ++k) {
    scale_column(own_.begin + k, std::exp(damping * step[k]));
  }
  close_rows();
  if (!(defect() < before)) {
    std::copy(old_scales.begin(), old_scales.end(), own);
    close_rows();
    sweep();
  }
  return passes + 1;
}

void Scaling::close_rows() {
  f_.shares.all_gather(f_.column_scale.data());
  base::parallel_chunks(row_.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = own_.begin + k;
      double landed = 0.0;
      for (std::uint64_t e = f_.row_start[i]; e < f_.row_start[i + 1]; ++e) {
        const std::uint32_t j = f_.column[e];
        landed += double(f_.hits[e]) * f_.kept[j] * f_.column_scale[j];
      }
      const double sum = landed * raw_[k] + seen(i);
      row_[k] = sum > 0.0 ? 1.0 / sum : 1.0;
      f_.row_scale[i] = raw_[k] * row_[k];
    }
  });
  update_sums();
}

void Scaling::finish() {
  base::release(raw_);
  base::release(sums_);
  const std::size_t count = f_.count();
  std::vector<double> row(count);
  std::copy(row_.begin(), row_.end(), row.begin() + static_cast<std::ptrdiff_t>(own_.begin));
  f_.shares.all_gather(row.data());
  const std::size_t parts = f_.sky_illuminance.size() / count;
  for (std::size_t i = 0; i < count; ++i) {
    if (i < own_.begin || i >= own_.end) f_.row_scale[i] *= row[i];
    f_.sky[i] *= row[i];
    f_.black[i] *= row[i];
    for (std::size_t p = 0; p < parts; ++p) f_.sky_illuminance[i * parts + p] *= row[i];
    f_.escape[i] *= f_.column_scale[i];
    f_.lost[i] *= f_.column_scale[i];
  }
}

// The bound stops the divergence of a column that too few rays hit.
void Scaling::scale_column(std::size_t j, double factor) {
  f_.column_scale[j] = std::min(f_.column_scale[j] * factor, largest_scale);
}

void Scaling::update_sums() {
  sums_ = weighted_column_sums(f_, [&](std::size_t i) { return area_m2_[i] * f_.kept[i]; });
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    const std::size_t j = own_.begin + k;
    sums_[k] += area_m2_[j] * f_.column_scale[j] * seen(j);
  }
}

// Change of a_j * sums for the change `step` of the column scales' logarithms.
std::vector<double> Scaling::response(const std::vector<double>& step) const {
  std::vector<double> weighted(step.size()), rows(step.size());
  for (std::size_t k = 0; k < step.size(); ++k) weighted[k] = f_.kept[own_.begin + k] * step[k];
  multiply(f_, weighted, rows, 1);
  std::vector<double> change = weighted_column_sums(
      f_, [&](std::size_t i) { return area_m2_[i] * f_.kept[i] * rows[i - own_.begin]; });
  for (std::size_t k = 0; k < step.size(); ++k) {
    change[k] = f_.kept[own_.begin + k] * (sums_[k] * step[k] - change[k]);
  }
  return change;
}

// Conjugate gradients in units in which the diagonal is 1 (diagonal preconditioner); patches with a
// diagonal of 0 are excluded. Stops at a tenth of the defect: the next step has a better model.
int Scaling::solve_for_step(std::vector<double>& step, int most_passes) const {
  constexpr double left = 0.1;
  const std::size_t count = sums_.size();
  std::vector<double> unit(count), missing(count), direction(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t j = own_.begin + k;
    const double diagonal = f_.kept[j] * sums_[k];
    unit[k] = diagonal > 0.0 ? 1.0 / std::sqrt(diagonal) : 0.0;
    missing[k] = unit[k] * f_.kept[j] * (area_m2_[j] - sums_[k]);
  }
  step.assign(count, 0.0);
  std::vector<double> along = missing;
  double square = sum_of([&](std::size_t k) { return missing[k] * missing[k]; });
  const double enough = left * left * square;
  int passes = 0;
  for (; passes < most_passes && square > enough; ++passes) {
    for (std::size_t k = 0; k < count; ++k) direction[k] = unit[k] * along[k];
    std::vector<double> change = response(direction);
    for (std::size_t k = 0; k < count; ++k) change[k] *= unit[k];
    const double curvature = sum_of([&](std::size_t k) { return along[k] * change[k]; });
    if (!(curvature > 0.0)) {  // no scaling exists: more iterations are useless
      std::fill(step.begin(), step.end(), 0.0);
      ++passes;
      break;
    }
    const double alpha = square / curvature;
    for (std::size_t k = 0; k < count; ++k) {
      step[k] += alpha * along[k];
      missing[k] -= alpha * change[k];
    }
    const double before = square;
    square = sum_of([&](std::size_t k) { return missing[k] * missing[k]; });
    for (std::size_t k = 0; k < count; ++k) along[k] = missing[k] + square / before * along[k];
  }
  const bool finite =
      sum_of([&](std::size_t k) { return std::isfinite(step[k]) ? 0.0 : 1.0; }) == 0.0;
  for (std::size_t k = 0; k < count; ++k) step[k] = finite ? unit[k] * step[k] : 0.0;
  // A perfect mirror keeps nothing, so that no row depends on its column's scale: it is set
  // directly.
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t j = own_.begin + k;
    if (f_.kept[j] <= 0.0 && sums_[k] > 0.0) step[k] = std::log(area_m2_[j] / sums_[k]);
  }
  return passes;
}

}  // namespace earthshine::radiosity
