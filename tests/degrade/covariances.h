// SPDX-License-Identifier: Apache-2.0
// Covariances and maps as full matrices.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "degrade/moments/noise_moments.h"

namespace earthshine::test {

using degrade::AxisMap;
using degrade::Covariance;
using degrade::Plane;

inline std::size_t at(int x, int y, int columns) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(x);
}

// Cov(n(x, y), n(u, v)) from the stored half; 0 if the offset was dropped.
inline double entry(const Covariance& c, int x, int y, int u, int v) {
  if (v < y || (v == y && u < x)) return entry(c, u, v, x, y);
  const auto found = std::find(c.offsets.begin(), c.offsets.end(), degrade::Offset{u - x, v - y});
  if (found == c.offsets.end()) return 0.0;
  return static_cast<double>(
      c.planes[static_cast<std::size_t>(found - c.offsets.begin())][at(x, y, c.columns)]);
}

// Weights w(i, j) of a map as a full matrix.
inline std::vector<double> matrix(const AxisMap& map) {
  std::vector<double> m(static_cast<std::size_t>(map.out() * map.in));
  for (int i = 0; i < map.out(); ++i) {
    for (std::size_t k = map.start[static_cast<std::size_t>(i)];
         k < map.start[static_cast<std::size_t>(i) + 1]; ++k) {
      m[at(static_cast<int>(map.source[k]), i, map.in)] += map.weight[k];
    }
  }
  return m;
}

inline AxisMap composed(const AxisMap& first, const AxisMap& second) {
  const std::vector<double> a = matrix(first), b = matrix(second);
  AxisMap map;
  map.in = first.in;
  for (int i = 0; i < second.out(); ++i) {
    for (int j = 0; j < first.in; ++j) {
      double sum = 0.0;
      for (int k = 0; k < second.in; ++k) sum += b[at(k, i, second.in)] * a[at(j, k, first.in)];
      if (sum == 0.0) continue;
      map.source.push_back(static_cast<std::size_t>(j));
      map.weight.push_back(sum);
    }
    map.start.push_back(map.source.size());
  }
  return map;
}

// An asymmetric filter with negative weights.
inline AxisMap lopsided(int size) {
  AxisMap map;
  map.in = size;
  for (int i = 0; i < size; ++i) degrade::add_output(map, i - 1, {-0.3, 1.1, 0.4, -0.2});
  return map;
}

inline Plane ramp(int columns, int rows) {
  Plane variance;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      variance.push_back(0.01F + 0.003F * static_cast<float>(x * x) +
                         0.02F * static_cast<float>(y));
    }
  }
  return variance;
}

}  // namespace earthshine::test
