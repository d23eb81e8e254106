// SPDX-License-Identifier: Apache-2.0
// The scales of rows and columns that balance form factors (form_factors.h), on their way.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

// In logarithms of the scales the two laws are the gradient of a convex function (Sinkhorn's
// problem with the sky and the black backs as one more row and column); rows are kept exact, so
// that what is left to bring to zero is the columns' defect as a function of the column scales.
//
// Ranks that divide the factors all make the same calls; each has the sums and the vectors of
// Newton's step of its own patches.
class Scaling {
 public:
  Scaling(FormFactors& factors, std::span<const double> area_m2);

  // From the hits as they are now, without scales.
  void start();
  // Gives the matrix more hits and starts anew. Returns how many.
  std::size_t fill();
  // sum_j |what the columns hold - A_j| / sum_j A_j.
  [[nodiscard]] double defect() const;
  // The patch whose column is furthest from its sum.
  [[nodiscard]] std::uint32_t worst() const;
  // Iterative proportional fitting: every column to its target, then every row.
  void sweep();
  // Newton's step: what the sums would be to first order, rows following, is right for all columns
  // at once. Sweeps creep where parts of a scene exchange little light; this does not. Keeps the
  // step only if it helps. Returns the passes over the matrix.
  int newton_step(int most_passes);

  // After fill(): what the patches keep for themselves, of sum_j A_j; and the one that keeps most.
  [[nodiscard]] double held() const;
  [[nodiscard]] std::uint32_t holds_most() const;
  // The shares of sky and black backs follow the scales. The last that is called.
  void finish();

 private:
  // Of this rank's k-th patch, and the patch of all that has most of something.
  [[nodiscard]] double held_m2(std::size_t k) const;
  [[nodiscard]] std::uint32_t most(const std::function<double(std::size_t k)>& value) const;
  void close_rows();
  void scale_column(std::size_t j, double factor);
  void update_sums();
  [[nodiscard]] double seen(std::size_t i) const { return f_.sky[i] + f_.black[i]; }
  // Of what is said of each own patch, counted from the first of them.
  template <class Value>
  [[nodiscard]] double sum_of(Value value) const;
  [[nodiscard]] std::vector<double> response(const std::vector<double>& step) const;
  int solve_for_step(std::vector<double>& step, int most_passes) const;

  FormFactors& f_;
  std::span<const double> area_m2_;
  base::Shares::Range own_;
  // Of own patches. f_.row_scale has the others' scales as cast.
  std::vector<double> raw_;   // scales of rows, as cast
  std::vector<double> row_;   // relative to them
  std::vector<double> sums_;  // sum_i A_i a_i F_ij + A_j (escape_j + lost_j)
  double total_m2_;
};

}  // namespace earthshine::radiosity
