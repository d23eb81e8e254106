// SPDX-License-Identifier: Apache-2.0
// The first N points of the four-dimensional Sobol sequence as a set, Owen-scrambled per key, eight
// at a time: the fast form of SobolOwen4 where all N points are used.
#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"

namespace earthshine::base {

// Order: along a Morton curve in the first two dimensions. Owen scrambling maps elementary boxes to
// elementary boxes, so runs of 2^k points stay neighbours after it: packets of coherent rays.
class SobolSet4 {
 public:
  static constexpr std::uint32_t width = 8;

  // count: a power of two, at least `width`.
  explicit SobolSet4(std::uint32_t count);
  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(bits_[0].size()); }

  // One random scrambling of each dimension.
  struct Scramble {
    std::uint32_t seed[4];
    explicit Scramble(Key key);
  };

  struct alignas(32) Points {
    float x[4][width];  // [dimension][point], in (0, 1)
  };
  // Points first .. first + width - 1; first is a multiple of width.
  void points(std::uint32_t first, const Scramble& scramble, Points& out) const;

 private:
  std::vector<std::uint32_t> bits_[4];  // the coordinates' bits, lowest first
};

}  // namespace earthshine::base
