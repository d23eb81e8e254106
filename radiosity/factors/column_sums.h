// SPDX-License-Identifier: Apache-2.0
// Sums down the columns of the form factors.
#pragma once

#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

// Per column j: sum_i weight(i) F_ij. Rows are split in a fixed number of bands with sums of their
// own, added in order: the same bits on any number of threads.
template <class Weight>
[[nodiscard]] std::vector<double> weighted_column_sums(const FormFactors& f, Weight weight) {
  constexpr std::size_t bands = 16;
  const std::size_t count = f.count();
  std::vector<double> partial(bands * count, 0.0);
  base::parallel_chunks(bands, 1, [&](std::size_t band, std::size_t) {
    double* sums = &partial[band * count];
    for (std::size_t i = band * count / bands; i < (band + 1) * count / bands; ++i) {
      const double w = weight(i) * f.row_scale[i];
      if (w == 0.0) continue;
      for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
        sums[f.column[e]] += w * double(f.hits[e]);
      }
    }
  });
  std::vector<double> total(count);
  base::parallel_chunks(count, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      double sum = 0.0;
      for (std::size_t band = 0; band < bands; ++band) sum += partial[band * count + j];
      total[j] = f.column_scale[j] * sum;
    }
  });
  return total;
}

}  // namespace earthshine::radiosity
