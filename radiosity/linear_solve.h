// SPDX-License-Identifier: Apache-2.0
// Solves B = S + rho F B for many right-hand sides at once.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

struct LinearSolve {
  std::vector<double> x, fx;  // x and F x: rows x columns, row-major
  int iterations = 0;
  double residual = 0.0;  // maximum of ||S - (1 - rho F) x|| / ||S|| over the columns
  // Remaining relative error of x: maximum over the columns of max |last correction| x (its own
  // relative residual) / max |x|.
  double error = 0.0;
};

// source: rows x columns, row-major; reflectance: rows x period, repeated over the columns (three
// colours, for instance). BiCGSTAB on all columns as one system, each scaled to a source of norm 1;
// the operator is matrix-free. Then iterative refinement solves (1 - rho F) d = residual and adds d
// until `error` is at most `tolerance`: after a million reflections a small residual may hide a
// large error. Columns without source stay 0. Throws base::Error (Work) if `error` stays above
// max(tolerance, 1e-6). Ranks that divide the factors each have their own rows of all vectors, nine
// of the size of x in the iteration; only the multiplied vector is on all ranks.
[[nodiscard]] LinearSolve solve_linear(const FormFactors& factors, std::vector<double> source,
                                       std::span<const double> reflectance, std::size_t columns,
                                       double tolerance);

}  // namespace earthshine::radiosity
