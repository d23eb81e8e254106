// SPDX-License-Identifier: Apache-2.0
// Patches with random trees: some cells cut once, some many times, in no order.
#pragma once

#include "base/random.h"
#include "radiosity/split.h"

namespace earthshine::tests {

inline radiosity::Patches random_cuts(radiosity::Patches patches, int rounds, double share,
                                      std::uint64_t seed, bool graded = false) {
  base::Rng rng(base::Key(seed, base::Stream::Test, 0));
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::uint8_t> wanted(patches.count());
    for (std::uint8_t& w : wanted) w = rng.next() < share ? 1 : 0;
    if (graded) radiosity::grade(patches, wanted);
    patches = radiosity::split(patches, wanted).patches;
  }
  return patches;
}

}  // namespace earthshine::tests
