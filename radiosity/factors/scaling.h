// SPDX-License-Identifier: Apache-2.0
// Iterative scales of rows and columns that balance form factors (form_factors.h).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

// In the logarithms of the scales, closure and balance are the gradient of a convex function
// (Sinkhorn's problem with the sky and the black backs as an additional row and column). Rows are
// kept exact; the unknown is the columns' defect as a function of the column scales.
//
// All functions are collective over the ranks that divide the factors; each rank has the sums and
// Newton vectors of its own patches.
class Scaling {
 public:
  Scaling(FormFactors& factors, std::span<const double> area_m2);

  // Initialises from the present hits, without scales.
  void start();
  // Adds hits to the matrix and restarts. Returns their number.
  std::size_t fill();
  // sum_j |column sum_j - A_j| / sum_j A_j.
  [[nodiscard]] double defect() const;
  // The patch with the largest column defect.
  [[nodiscard]] std::uint32_t worst() const;
  // Iterative proportional fitting: scales every column to its target, then every row.
  void sweep();
  // Newton's step: solves the first-order model, with exact rows, for all columns at once. Sweeps
  // converge slowly if parts of a scene exchange little light; this does not. Keeps the step only
  // if it reduces the defect. Returns the number of passes over the matrix.
  int newton_step(int most_passes);

  // After fill(): light that patches send to themselves, as a share of sum_j A_j; and the patch
  // with the most.
  [[nodiscard]] double held() const;
  [[nodiscard]] std::uint32_t holds_most() const;
  // Sets the shares of sky and black backs from the scales. Call last.
  void finish();

 private:
  // For this rank's k-th patch; and the patch of all ranks with the maximum.
  [[nodiscard]] double held_m2(std::size_t k) const;
  [[nodiscard]] std::uint32_t most(const std::function<double(std::size_t k)>& value) const;
  void close_rows();
  void scale_column(std::size_t j, double factor);
  void update_sums();
  [[nodiscard]] double seen(std::size_t i) const { return f_.sky[i] + f_.black[i]; }
  // Sum of a value per own patch, counted from the first one.
  template <class Value>
  [[nodiscard]] double sum_of(Value value) const;
  [[nodiscard]] std::vector<double> response(const std::vector<double>& step) const;
  int solve_for_step(std::vector<double>& step, int most_passes) const;

  FormFactors& f_;
  std::span<const double> area_m2_;
  base::Shares::Range own_;
  // For own patches. f_.row_scale has the scales of others as cast.
  std::vector<double> raw_;   // row scales as cast
  std::vector<double> row_;   // relative to raw_
  std::vector<double> sums_;  // sum_i A_i a_i F_ij + A_j (escape_j + lost_j)
  double total_m2_;
};

}  // namespace earthshine::radiosity
