// SPDX-License-Identifier: Apache-2.0
// B = S + rho F B for many right-hand sides at once.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

struct LinearSolve {
  std::vector<double> x, fx;  // and F x: count x columns, row-major
  int iterations = 0;
  double residual = 0.0;  // worst ||S - (1 - rho F) x|| / ||S|| over the columns
  // What is still missing from x, in its own units: worst over the columns of max |last correction|
  // x (its own relative residual) / max |x|.
  double error = 0.0;
};

// source and reflectance: count x columns, row-major. BiCGSTAB on all columns as one system, each
// scaled to a source of norm 1; the operator is matrix-free. Then corrections d with
// (1 - rho F) d = residual are solved for and added until `error`, the part of x that a further one
// would change, is at most `tolerance`: where light is reflected a million times a small residual
// is no small error. Columns without source stay 0. Throws base::Error (Work) when `error` stays
// above max(tolerance, 1e-6). Of ranks that divide the factors the first alone has all of this, and
// the vectors of the iteration, thirteen of the size of x; the others, who need no source and
// reflectance, multiply with their rows for it.
[[nodiscard]] LinearSolve solve_linear(const FormFactors& factors, std::vector<double> source,
                                       std::span<const double> reflectance, std::size_t columns,
                                       double tolerance);

}  // namespace earthshine::radiosity
