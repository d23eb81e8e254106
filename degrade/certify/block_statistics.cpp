// SPDX-License-Identifier: Apache-2.0
#include "degrade/certify/block_statistics.h"

#include <cmath>

namespace earthshine::degrade {

double four_errors(const Estimate& estimate) {
  // t = z + (z^3 + z) / (4 n) + (5 z^5 + 16 z^3 + 3 z) / (96 n^2)
  //     + (3 z^7 + 19 z^5 + 17 z^3 - 15 z) / (384 n^3) at z = 4.
  const double n = estimate.freedom;
  return (4.0 + 17.0 / n + 64.125 / (n * n) + 181.34 / (n * n * n)) * estimate.error;
}

std::vector<Block> cut_blocks(int columns, int rows, int margin, int edge) {
  std::vector<Block> blocks;
  for (int y = margin; y + edge <= rows - margin; y += edge) {
    for (int x = margin; x + edge <= columns - margin; x += edge) {
      blocks.push_back({x, y, x + edge, y + edge});
    }
  }
  return blocks;
}

Estimate mean_of(const std::vector<double>& blocks) {
  return ratio_of(blocks, std::vector<double>(blocks.size(), 1.0));
}

Estimate ratio_of(const std::vector<double>& numerators, const std::vector<double>& denominators) {
  double over = 0.0, under = 0.0;
  for (std::size_t i = 0; i < numerators.size(); ++i) {
    over += numerators[i];
    under += denominators[i];
  }
  const double count = static_cast<double>(numerators.size());
  const double value = over / under;
  double squares = 0.0;
  for (std::size_t i = 0; i < numerators.size(); ++i) {
    const double rest = numerators[i] - value * denominators[i];
    squares += rest * rest;
  }
  return {value, std::sqrt(squares / (count * (count - 1.0))) / std::abs(under / count),
          count - 1.0};
}

double plane_mean(const Plane& plane, int columns, const std::vector<Block>& blocks) {
  double sum = 0.0;
  for (const Block& block : blocks) {
    sum += block_mean(block, columns, [&](std::size_t i) { return static_cast<double>(plane[i]); });
  }
  return sum / static_cast<double>(blocks.size());
}

Estimate correlation(const Picture& first, const Picture& second, const std::vector<Block>& blocks,
                     int dx, int dy) {
  std::vector<double> products, squares;
  const std::ptrdiff_t shift = static_cast<std::ptrdiff_t>(dy) * first.columns + dx;
  for (std::size_t plane = 0; plane < first.planes.size(); ++plane) {
    const Plane &a = first.planes[plane], &b = second.planes[plane];
    const double mean_a = plane_mean(a, first.columns, blocks);
    const double mean_b = plane_mean(b, first.columns, blocks);
    for (const Block& block : blocks) {
      products.push_back(block_mean(block, first.columns, [&](std::size_t i) {
        const auto j = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + shift);
        return (static_cast<double>(a[i]) - mean_a) * (static_cast<double>(b[j]) - mean_b);
      }));
      squares.push_back(block_mean(block, first.columns, [&](std::size_t i) {
        const double da = static_cast<double>(a[i]) - mean_a;
        const double db = static_cast<double>(b[i]) - mean_b;
        return 0.5 * (da * da + db * db);
      }));
    }
  }
  return ratio_of(products, squares);
}

}  // namespace earthshine::degrade
