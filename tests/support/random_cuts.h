// SPDX-License-Identifier: Apache-2.0
// Patches with random subdivision trees: some cells cut once, some many times, in random order.
#pragma once

#include "base/numbers/random.h"
#include "radiosity/patches/split.h"

namespace earthshine::tests {

// graded: all cuts of a round have one direction, and no neighbour becomes more than twice as long.
inline radiosity::Patches random_cuts(radiosity::Patches patches, int rounds, double share,
                                      std::uint64_t seed, bool graded = false) {
  using radiosity::Cut;
  base::Rng rng(base::Key(seed, base::Stream::Test, 0));
  for (int round = 0; round < rounds; ++round) {
    std::vector<Cut> wanted(patches.count(), Cut::None);
    const bool round_along_s = round % 2 == 0;
    for (Cut& cut : wanted) {
      const bool along_s = graded ? round_along_s : rng.next() < 0.5;
      if (rng.next() < share) cut = along_s ? Cut::S : Cut::T;
    }
    if (graded) radiosity::grade(patches, wanted);
    patches = radiosity::split(patches, wanted).patches;
  }
  return patches;
}

// Halves every cell along s, then along t.
inline radiosity::Patches all_in_four(radiosity::Patches patches) {
  for (const radiosity::Cut cut : {radiosity::Cut::S, radiosity::Cut::T}) {
    patches = radiosity::split(patches, std::vector(patches.count(), cut)).patches;
  }
  return patches;
}

}  // namespace earthshine::tests
