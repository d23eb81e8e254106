// SPDX-License-Identifier: Apache-2.0
// B = S + rho F B for many right-hand sides at once.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

struct LinearSolve {
  std::vector<double> x, fx;  // and F x: rows x columns, row-major
  int iterations = 0;
  double residual = 0.0;  // worst ||S - (1 - rho F) x|| / ||S|| over the columns
  // What is still missing from x, in its own units: worst over the columns of max |last correction|
  // x (its own relative residual) / max |x|.
  double error = 0.0;
};

// source: rows x columns, row-major; reflectance: rows x as many as repeat over the columns, three
// colours for instance. BiCGSTAB on all columns as one system, each
// scaled to a source of norm 1; the operator is matrix-free. Then corrections d with
// (1 - rho F) d = residual are solved for and added until `error`, the part of x that a further one
// would change, is at most `tolerance`: where light is reflected a million times a small residual
// is no small error. Columns without source stay 0. Throws base::Error (Work) when `error` stays
// above max(tolerance, 1e-6). Of ranks that divide the factors each has its own rows of all this
// and of the vectors of the iteration, nine of the size of x; only what is multiplied is with all.
[[nodiscard]] LinearSolve solve_linear(const FormFactors& factors, std::vector<double> source,
                                       std::span<const double> reflectance, std::size_t columns,
                                       double tolerance);

}  // namespace earthshine::radiosity
