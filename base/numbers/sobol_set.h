// SPDX-License-Identifier: Apache-2.0
// The first N points of the four-dimensional Sobol sequence as a set, Owen-scrambled per key, eight
// at a time. Faster than SobolOwen4 if all N points are used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "base/numbers/random.h"

namespace earthshine::base {

// Points are sorted along a Morton curve in the first two dimensions. Owen scrambling maps
// elementary boxes to elementary boxes, so that runs of 2^k points stay neighbours: coherent ray
// packets.
class SobolSet4 {
 public:
  static constexpr std::uint32_t width = 8;

  // count: a power of two.
  explicit SobolSet4(std::uint32_t count);
  [[nodiscard]] std::uint32_t count() const { return count_; }

  // One random scrambling of each dimension.
  struct Scramble {
    std::uint32_t seed[4];
    std::uint32_t run[4];  // XOR masks of a later run, lowest bit first
    explicit Scramble(Key key);
  };
  // Selects the points of the sequence from run * count() on instead of the first ones. Runs
  // 0 to m - 1, m a power of two, form the set of m * count() points. Sobol numbers are linear in
  // the bits of the index, so that a run differs from the first one by one XOR per dimension.
  void go_to_run(std::uint32_t run, Scramble& scramble) const;

  struct alignas(32) Points {
    float x[4][width];  // [dimension][point], in (0, 1)
  };
  // Points first .. first + width - 1, first a multiple of width. Points beyond count() repeat the
  // set.
  void points(std::uint32_t first, const Scramble& scramble, Points& out) const;

 private:
  std::uint32_t count_;
  std::vector<std::uint32_t> bits_[4];  // bits of the coordinates, lowest first
};

// The R2 sequence (Roberts 2018): any number of points, uniform over the unit square, without a
// visible pattern.

inline constexpr double r2_u = 0.7548776662466927, r2_v = 0.5698402909980532;

[[nodiscard]] inline glm::dvec2 even_point(std::size_t k) {
  return glm::fract(0.5 + static_cast<double>(k + 1) * glm::dvec2(r2_u, r2_v));
}

}  // namespace earthshine::base
