// SPDX-License-Identifier: Apache-2.0
// Sums over all rows of the form factors, distributed over ranks: bit-identical for any number of
// threads and ranks.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

// body(begin, end, sums): for a range of own rows, counted from the first one; it may modify data
// of these rows. Returns `each` sums over all rows.
template <class Body>
std::vector<double> sums_over_rows(const FormFactors& factors, std::size_t each, Body body) {
  const std::size_t count = factors.count(), first = factors.shares.own(count).begin;
  return factors.shares.ordered_sums(count, patches_a_sum(count), each,
                                     [&](std::size_t begin, std::size_t end, double* sums) {
                                       body(begin - first, end - first, sums);
                                     });
}

// Maximum of each value over the ranks.
inline void keep_largest(const base::Shares& shares, std::vector<double>& values) {
  shares.sequential_reduce([&](base::Parcel& parcel) { parcel.pass(values); },
                           [&](base::Parcel& parcel) {
                             std::vector<double> theirs;
                             parcel.pass(theirs);
                             for (std::size_t k = 0; k < values.size(); ++k) {
                               values[k] = std::max(values[k], theirs[k]);
                             }
                           });
}

inline double dot(const double* a, const double* b, std::size_t count) {
  std::array<double, 4> sums{};  // independent, to overlap additions
  std::size_t k = 0;
  for (; k + sums.size() <= count; k += sums.size()) {
    for (std::size_t s = 0; s < sums.size(); ++s) sums[s] += a[k + s] * b[k + s];
  }
  for (; k < count; ++k) sums[0] += a[k] * b[k];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

}  // namespace earthshine::radiosity
