// SPDX-License-Identifier: Apache-2.0
// What is found over all rows of the form factors, of which each rank has its own: neither threads
// nor ranks change a bit of it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

// body(begin, end, sums): of some of the own rows, counted from the first of them; it may change
// what belongs to these rows. Returned are `each` sums over all rows.
template <class Body>
std::vector<double> sums_over_rows(const FormFactors& factors, std::size_t each, Body body) {
  const std::size_t count = factors.count(), first = factors.shares.own(count).begin;
  return factors.shares.ordered_sums(count, patches_a_sum(count), each,
                                     [&](std::size_t begin, std::size_t end, double* sums) {
                                       body(begin - first, end - first, sums);
                                     });
}

// The largest of each value, which ranks have found among their own rows.
inline void keep_largest(const base::Shares& shares, std::vector<double>& values) {
  shares.hear([&](base::Parcel& parcel) { parcel.pass(values); },
              [&](base::Parcel& parcel) {
                std::vector<double> theirs;
                parcel.pass(theirs);
                for (std::size_t k = 0; k < values.size(); ++k) {
                  values[k] = std::max(values[k], theirs[k]);
                }
              });
}

inline double dot(const double* a, const double* b, std::size_t count) {
  std::array<double, 4> sums{};  // none waits for the addition before it
  std::size_t k = 0;
  for (; k + sums.size() <= count; k += sums.size()) {
    for (std::size_t s = 0; s < sums.size(); ++s) sums[s] += a[k + s] * b[k + s];
  }
  for (; k < count; ++k) sums[0] += a[k] * b[k];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

}  // namespace earthshine::radiosity
