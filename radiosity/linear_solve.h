// SPDX-License-Identifier: Apache-2.0
// B = S + rho F B for many right-hand sides at once. The only user of Eigen in this layer.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "radiosity/form_factors.h"

namespace earthshine::radiosity {

struct LinearSolve {
  std::vector<double> x;  // count x columns, row-major
  int iterations = 0;
  double residual = 0.0;  // worst ||S - (1 - rho F) x|| / ||S|| over the columns
};

// source and reflectance: count x columns, row-major. BiCGSTAB (Eigen) on all columns as one
// system, each scaled to a source of norm 1; the operator is matrix-free. Columns without source
// stay 0. Throws base::Error (Work) when the residual stays above max(tolerance, 1e-6).
[[nodiscard]] LinearSolve solve_linear(const FormFactors& factors, std::span<const double> source,
                                       std::span<const double> reflectance, std::size_t columns,
                                       double tolerance);

}  // namespace earthshine::radiosity
