// SPDX-License-Identifier: Apache-2.0
// The first N points of the four-dimensional Sobol sequence as a set, Owen-scrambled per key, eight
// at a time: the fast form of SobolOwen4 where all N points are used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "base/numbers/random.h"

namespace earthshine::base {

// Order: along a Morton curve in the first two dimensions. Owen scrambling maps elementary boxes to
// elementary boxes, so runs of 2^k points stay neighbours after it: packets of coherent rays.
class SobolSet4 {
 public:
  static constexpr std::uint32_t width = 8;

  // count: a power of two.
  explicit SobolSet4(std::uint32_t count);
  [[nodiscard]] std::uint32_t count() const { return count_; }

  // One random scrambling of each dimension.
  struct Scramble {
    std::uint32_t seed[4];
    std::uint32_t run[4];  // bits by which the points of a later run differ, lowest first
    explicit Scramble(Key key);
  };
  // From now on the points of the sequence from run * count() on, in place of its first ones: runs
  // 0 to m - 1, m a power of two, are together the set of m * count() points. Sobol numbers are
  // linear in the index's bits, so that a run differs from the first by one XOR per dimension.
  void go_to_run(std::uint32_t run, Scramble& scramble) const;

  struct alignas(32) Points {
    float x[4][width];  // [dimension][point], in (0, 1)
  };
  // Points first .. first + width - 1, first a multiple of width; what is past count() comes again.
  void points(std::uint32_t first, const Scramble& scramble, Points& out) const;

 private:
  std::uint32_t count_;
  std::vector<std::uint32_t> bits_[4];  // the coordinates' bits, lowest first
};

// The R2 lattice (Roberts 2018): any number of points, even over the unit square, in step with no
// pattern.

inline constexpr double r2_u = 0.7548776662466927, r2_v = 0.5698402909980532;

[[nodiscard]] inline glm::dvec2 even_point(std::size_t k) {
  return glm::fract(0.5 + static_cast<double>(k + 1) * glm::dvec2(r2_u, r2_v));
}

}  // namespace earthshine::base
