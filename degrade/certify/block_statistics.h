// SPDX-License-Identifier: Apache-2.0
// Means with standard errors for pictures with correlated resels. The picture is divided into
// blocks larger than its grain; the scatter of the blocks gives the error.
#pragma once

#include <limits>
#include <vector>

#include "degrade/stage/picture.h"

namespace earthshine::degrade {

struct Estimate {
  double value = 0.0;
  double error = 0.0;                                        // one standard error
  double freedom = std::numeric_limits<double>::infinity();  // degrees of freedom of the error
};

// Four standard errors. With few degrees of freedom, Student's t of the same probability
// (Cornish-Fisher expansion).
[[nodiscard]] double four_errors(const Estimate& estimate);

// [x0, x1) x [y0, y1)
struct Block {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// Complete blocks of edge x edge inside a border of `margin`, where filters include mirrored
// resels.
[[nodiscard]] std::vector<Block> cut_blocks(int columns, int rows, int margin, int edge);

// Mean of f(index of the resel) over a block.
template <class F>
[[nodiscard]] double block_mean(const Block& block, int columns, F f) {
  double sum = 0.0;
  for (int y = block.y0; y < block.y1; ++y) {
    for (int x = block.x0; x < block.x1; ++x) {
      sum += f(static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(x));
    }
  }
  return sum / (static_cast<double>(block.x1 - block.x0) * (block.y1 - block.y0));
}

// Mean over equal blocks, error = scatter / sqrt(number).
[[nodiscard]] Estimate mean_of(const std::vector<double>& blocks);
// Sum of numerators over sum of denominators; error by the delta method.
[[nodiscard]] Estimate ratio_of(const std::vector<double>& numerators,
                                const std::vector<double>& denominators);

// Mean over all blocks.
[[nodiscard]] double plane_mean(const Plane& plane, int columns, const std::vector<Block>& blocks);

// Correlation of two planes, the second shifted by (dx, dy), pooled over the planes of both
// pictures. Shifts must stay within the blocks' margin.
[[nodiscard]] Estimate correlation(const Picture& first, const Picture& second,
                                   const std::vector<Block>& blocks, int dx = 0, int dy = 0);

}  // namespace earthshine::degrade
