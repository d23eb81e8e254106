// SPDX-License-Identifier: Apache-2.0
// Normal random numbers for synthetic errors.
#pragma once

#include <cmath>
#include <numbers>

#include "base/numbers/random.h"

namespace earthshine::tests {

class Normal {
 public:
  explicit Normal(std::uint64_t seed) : rng_(base::Key(seed, base::Stream::Test, 0)) {}
  // Of mean 0 and variance 1 (Box and Muller 1958).
  [[nodiscard]] double next() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - rng_.next()));
    return radius * std::cos(2.0 * std::numbers::pi * rng_.next());
  }

 private:
  base::Rng rng_;
};

}  // namespace earthshine::tests
