// SPDX-License-Identifier: Apache-2.0
// F x for many right-hand sides: one pass over the matrix serves up to 32 of them.
#include <algorithm>
#include <memory>

#include "base/parallel.h"
#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {
namespace {

constexpr std::size_t lanes = 4;
using Lanes [[gnu::vector_size(lanes * sizeof(double))]] = double;

constexpr std::size_t most_blocks = 8;  // of four columns, in registers

// x of all patches, multiplied by column_scale and padded to whole blocks, from column `first` on.
// x: of own rows.
std::unique_ptr<Lanes[]> packed(const FormFactors& factors, std::span<const double> x,
                                std::size_t columns, std::size_t first, std::size_t blocks) {
  const std::size_t used = std::min(columns - first, blocks * lanes);
  const base::Shares::Range own = factors.shares.own(factors.count());
  // First touch places memory near the thread.
  auto z = std::make_unique_for_overwrite<Lanes[]>(factors.count() * blocks);
  base::parallel_chunks(own.end - own.begin, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const std::size_t j = own.begin + row;
      for (std::size_t c = 0; c < blocks * lanes; ++c) {
        z[j * blocks + c / lanes][c % lanes] =
            c < used ? factors.column_scale[j] * x[row * columns + first + c] : 0.0;
      }
    }
  });
  factors.shares.all_gather(z.get(), blocks);
  return z;
}

// Number of independent sums for successive entries, so that no addition waits for the previous
// one: four sums of four columns, fewer with more blocks.
template <std::size_t Blocks>
constexpr std::size_t chains = Blocks == 1   ? 4
                               : Blocks <= 3 ? 2
                                             : 1;

// y: from row `begin` on.
template <std::size_t Blocks>
void multiply_rows(const FormFactors& factors, const Lanes* z, std::size_t begin, std::size_t end,
                   std::size_t columns, std::size_t first, double* y) {
  constexpr std::size_t parts = chains<Blocks>;
  const std::uint32_t* column = factors.column.data();
  const float* hits = factors.hits.data();
  const std::size_t used = std::min(columns - first, Blocks * lanes);
  for (std::size_t i = begin; i < end; ++i) {
    Lanes sum[parts][Blocks] = {};
    std::uint64_t e = factors.row_start[i];
    const std::uint64_t stop = factors.row_start[i + 1];
    for (; e + parts <= stop; e += parts) {
      for (std::size_t p = 0; p < parts; ++p) {
        const Lanes* in = &z[column[e + p] * Blocks];
        const double weight = double(hits[e + p]);
        for (std::size_t b = 0; b < Blocks; ++b) sum[p][b] += weight * in[b];
      }
    }
    for (; e < stop; ++e) {
      const Lanes* in = &z[column[e] * Blocks];
      for (std::size_t b = 0; b < Blocks; ++b) sum[0][b] += double(hits[e]) * in[b];
    }
    for (std::size_t p = 1; p < parts; ++p) {
      for (std::size_t b = 0; b < Blocks; ++b) sum[0][b] += sum[p][b];
    }
    for (std::size_t c = 0; c < used; ++c) {
      y[(i - begin) * columns + first + c] = factors.row_scale[i] * sum[0][c / lanes][c % lanes];
    }
  }
}

using MultiplyRows = void (*)(const FormFactors&, const Lanes*, std::size_t, std::size_t,
                              std::size_t, std::size_t, double*);
constexpr MultiplyRows multiply_blocks[most_blocks] = {
    multiply_rows<1>, multiply_rows<2>, multiply_rows<3>, multiply_rows<4>,
    multiply_rows<5>, multiply_rows<6>, multiply_rows<7>, multiply_rows<8>};

}  // namespace

void multiply(const FormFactors& factors, std::span<const double> x, std::span<double> y,
              std::size_t columns) {
  const base::Shares::Range own = factors.shares.own(factors.count());
  for (std::size_t first = 0; first < columns; first += most_blocks * lanes) {
    const std::size_t blocks = std::min((columns - first + lanes - 1) / lanes, most_blocks);
    const std::unique_ptr<Lanes[]> z = packed(factors, x, columns, first, blocks);
    base::parallel_chunks(own.end - own.begin, 256, [&](std::size_t begin, std::size_t end) {
      multiply_blocks[blocks - 1](factors, z.get(), own.begin + begin, own.begin + end, columns,
                                  first, &y[begin * columns]);
    });
  }
}

}  // namespace earthshine::radiosity
