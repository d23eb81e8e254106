// SPDX-License-Identifier: Apache-2.0
// Which patches are halved, and which way, by what is uneven within them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "radiosity/patches/split.h"

namespace earthshine::radiosity {

// A patch's part in a squared error, and how much of it goes away when the patch is halved along s
// or along t.
struct Unevenness {
  double error = 0.0;
  double along_s = 0.0, along_t = 0.0;
};

struct CutCandidate {
  std::uint32_t patch;  // the front side
  Cut cut;
  double error;    // of both sides
  double urgency;  // error per patch that the cut adds
};

// Those that hold an error and can be halved, the most urgent first: a cell longer than four times
// its width across, others where more of the error goes away. uneven: per patch.
[[nodiscard]] std::vector<CutCandidate> worst_first(const Patches& patches,
                                                    std::span<const Unevenness> uneven);

// The first `count` of them, graded (split.h); fewer where more than `most` patches would result.
// None at all: every entry is Cut::None.
[[nodiscard]] std::vector<Cut> cuts_within(const Patches& patches,
                                           std::span<const CutCandidate> candidates,
                                           std::size_t count, std::size_t most);

}  // namespace earthshine::radiosity
