// SPDX-License-Identifier: Apache-2.0
// The scales of rows and columns that balance form factors (form_factors.h), on their way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

// In logarithms of the scales the two laws are the gradient of a convex function (Sinkhorn's
// problem with the sky and the black backs as one more row and column); rows are kept exact, so
// that what is left to bring to zero is the columns' defect as a function of the column scales.
//
// Of ranks that divide the factors all make one and finish(); between, the first alone does all
// that follows, until end(), and the others serve() it with their rows. It alone has the columns'
// sums and the vectors of Newton's step.
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

  void end();
  void serve();

  // After end() and fill(): what the patches keep for themselves, of sum_j A_j.
  [[nodiscard]] double held() const;
  // The shares of sky and black backs follow the scales.
  void finish();

 private:
  enum class Task { CloseRows, Fill, Respond, End };

  // What the first rank says.
  Task say(Task task) const;
  void close_rows();
  void close_own_rows();
  std::size_t fill_own_rows();
  void scale_column(std::size_t j, double factor);
  void update_sums();
  [[nodiscard]] double seen(std::size_t i) const { return f_.sky[i] + f_.black[i]; }
  [[nodiscard]] std::vector<double> response(const std::vector<double>& step) const;
  [[nodiscard]] std::vector<double> own_response(std::vector<double>& weighted) const;
  int solve_for_step(std::vector<double>& step, int most_passes) const;

  FormFactors& f_;
  std::span<const double> area_m2_;
  base::Shares::Range own_;
  std::vector<double> raw_;   // of own rows, the scales as cast; f_.row_scale has the others' so
  std::vector<double> row_;   // relative to them; of others' rows from end() on
  std::vector<double> sums_;  // sum_i A_i a_i F_ij + A_j (escape_j + lost_j); the first rank's
  double total_m2_;
};

}  // namespace earthshine::radiosity
