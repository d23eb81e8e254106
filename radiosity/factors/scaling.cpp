// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/scaling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "radiosity/factors/column_sums.h"
#include "radiosity/factors/filled_hits.h"
#include "radiosity/factors/matrix_free.h"

namespace earthshine::radiosity {
namespace {

constexpr double largest_scale = 1e6;

}  // namespace

Scaling::Scaling(FormFactors& factors, std::span<const double> area_m2)
    : f_(factors),
      area_m2_(area_m2),
      own_(factors.shares.own(factors.count())),
      raw_(factors.row_scale.begin() + static_cast<std::ptrdiff_t>(own_.begin),
           factors.row_scale.begin() + static_cast<std::ptrdiff_t>(own_.end)),
      row_(factors.count(), 1.0),
      total_m2_(std::accumulate(area_m2.begin(), area_m2.end(), 0.0)) {
  update_sums();
}

Scaling::Task Scaling::say(Task task) const {
  f_.shares.tell_all(&task, 1);
  return task;
}

void Scaling::end() {
  say(Task::End);
  f_.shares.tell(row_.data());
}

void Scaling::serve() {
  for (Task task = say(Task::End); task != Task::End; task = say(Task::End)) {
    if (task == Task::Fill) {
      fill_own_rows();
    } else if (task == Task::CloseRows) {
      f_.shares.tell_all(f_.column_scale.data(), f_.count());
      close_own_rows();
    } else {
      std::vector<double> weighted(f_.count());
      (void)own_response(weighted);
    }
  }
  f_.shares.tell(row_.data());
}

void Scaling::start() {
  std::fill(f_.column_scale.begin(), f_.column_scale.end(), 1.0);
  close_rows();
}

std::size_t Scaling::fill() {
  say(Task::Fill);
  const std::size_t filled = fill_own_rows();
  start();
  return filled;
}

std::size_t Scaling::fill_own_rows() {
  std::copy(raw_.begin(), raw_.end(),
            f_.row_scale.begin() + static_cast<std::ptrdiff_t>(own_.begin));
  return fill_both_ways(f_, area_m2_);
}

double Scaling::defect() const {
  double sum = 0.0;
  for (std::size_t j = 0; j < sums_.size(); ++j) sum += std::abs(sums_[j] - area_m2_[j]);
  return total_m2_ > 0.0 ? sum / total_m2_ : 0.0;
}

std::uint32_t Scaling::worst() const {
  std::size_t worst = 0;
  const auto defect = [&](std::size_t j) { return std::abs(sums_[j] - area_m2_[j]); };
  for (std::size_t j = 1; j < sums_.size(); ++j) {
    if (defect(j) > defect(worst)) worst = j;
  }
  return static_cast<std::uint32_t>(worst);
}

double Scaling::held() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < row_.size(); ++i) {
    if (!keeps_its_own(f_, area_m2_, i)) continue;
    sum += area_m2_[i] * f_.kept[i] * own_share * row_[i] * f_.column_scale[i];
  }
  return sum / total_m2_;
}

void Scaling::sweep() {
  for (std::size_t j = 0; j < sums_.size(); ++j) {
    if (sums_[j] > 0.0) scale_column(j, area_m2_[j] / sums_[j]);
  }
  close_rows();
}

int Scaling::newton_step(int most_passes) {
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

void Scaling::close_rows() {
  say(Task::CloseRows);
  f_.shares.tell_all(f_.column_scale.data(), f_.count());
  close_own_rows();
}

void Scaling::close_own_rows() {
  base::parallel_chunks(own_.end - own_.begin, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = own_.begin + k;
      double landed = 0.0;
      for (std::uint64_t e = f_.row_start[i]; e < f_.row_start[i + 1]; ++e) {
        const std::uint32_t j = f_.column[e];
        landed += double(f_.hits[e]) * f_.kept[j] * f_.column_scale[j];
      }
      const double sum = landed * raw_[k] + seen(i);
      row_[i] = sum > 0.0 ? 1.0 / sum : 1.0;
      f_.row_scale[i] = raw_[k] * row_[i];
    }
  });
  update_sums();
}

void Scaling::finish() {
  const std::size_t parts = row_.empty() ? 0 : f_.sky_illuminance.size() / row_.size();
  for (std::size_t i = 0; i < row_.size(); ++i) {
    if (i < own_.begin || i >= own_.end) f_.row_scale[i] *= row_[i];
    f_.sky[i] *= row_[i];
    f_.black[i] *= row_[i];
    for (std::size_t p = 0; p < parts; ++p) f_.sky_illuminance[i * parts + p] *= row_[i];
    f_.escape[i] *= f_.column_scale[i];
    f_.lost[i] *= f_.column_scale[i];
  }
}

// The bound stops a column that too few rays reached to ever fill from running off to infinity.
void Scaling::scale_column(std::size_t j, double factor) {
  f_.column_scale[j] = std::min(f_.column_scale[j] * factor, largest_scale);
}

void Scaling::update_sums() {
  sums_ = weighted_column_sums(
      f_, [&](std::size_t i) { return area_m2_[i] * f_.kept[i]; }, base::Hears::First);
  for (std::size_t j = 0; j < sums_.size(); ++j) {
    sums_[j] += area_m2_[j] * f_.column_scale[j] * seen(j);
  }
}

// The change of a_j * sums when the column scales' logarithms change by `step`.
std::vector<double> Scaling::response(const std::vector<double>& step) const {
  const std::size_t count = step.size();
  std::vector<double> weighted(count);
  for (std::size_t j = 0; j < count; ++j) weighted[j] = f_.kept[j] * step[j];
  say(Task::Respond);
  std::vector<double> change = own_response(weighted);
  for (std::size_t j = 0; j < count; ++j) {
    change[j] = f_.kept[j] * (sums_[j] * step[j] - change[j]);
  }
  return change;
}

// What the rows that are here add to the columns' sums, summed over the ranks at the first.
// weighted: the first rank's.
std::vector<double> Scaling::own_response(std::vector<double>& weighted) const {
  f_.shares.tell_all(weighted.data(), weighted.size());
  std::vector<double> rows(own_.end - own_.begin);
  multiply(f_, weighted, rows, 1);
  return weighted_column_sums(
      f_, [&](std::size_t i) { return area_m2_[i] * f_.kept[i] * rows[i - own_.begin]; },
      base::Hears::First);
}

// Conjugate gradients in units in which the diagonal is 1 (the diagonal as preconditioner); a patch
// without one is left out. A tenth of the defect is left to the next step, which knows more.
int Scaling::solve_for_step(std::vector<double>& step, int most_passes) const {
  const std::size_t count = sums_.size();
  Eigen::VectorXd unit(count), missing(count);
  for (std::size_t j = 0; j < count; ++j) {
    const double diagonal = f_.kept[j] * sums_[j];
    unit[j] = diagonal > 0.0 ? 1.0 / std::sqrt(diagonal) : 0.0;
    missing[j] = unit[j] * f_.kept[j] * (area_m2_[j] - sums_[j]);
  }
  int passes = 0;
  bool broken = false;  // hits that have no scaling: further passes would bring nothing
  std::vector<double> way(count);
  const MatrixFree system(count, [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    if (broken || !(x.squaredNorm() > 0.0)) return x;  // Eigen begins with the product of 0
    ++passes;
    Eigen::Map<Eigen::VectorXd>(way.data(), x.size()) = unit.cwiseProduct(x);
    const std::vector<double> change = response(way);
    Eigen::VectorXd y =
        unit.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(change.data(), x.size()));
    broken = !(x.dot(y) > 0.0);
    return y;
  });
  Eigen::ConjugateGradient<MatrixFree, Eigen::Lower | Eigen::Upper, Eigen::IdentityPreconditioner>
      gradients;
  gradients.compute(system);
  gradients.setTolerance(0.1).setMaxIterations(most_passes);
  const Eigen::VectorXd found = unit.cwiseProduct(gradients.solve(missing));
  step.assign(count, 0.0);
  if (!broken && found.allFinite()) std::copy(found.begin(), found.end(), step.begin());
  // A perfect mirror keeps nothing, so that no row feels its column's scale: it follows alone.
  for (std::size_t j = 0; j < count; ++j) {
    if (f_.kept[j] <= 0.0 && sums_[j] > 0.0) step[j] = std::log(area_m2_[j] / sums_[j]);
  }
  return passes;
}

}  // namespace earthshine::radiosity
