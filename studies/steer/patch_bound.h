// SPDX-License-Identifier: Apache-2.0
// How many patches a solve to an error may cut.
#pragma once

#include "studies/steer/wanted_error.h"

namespace earthshine::studies {

struct PatchBound {
  std::size_t most = 0;
  Limit of = Limit::Steps;  // what sets it: the scene's settings, memory, or nothing of these
};

// No fewer than the `first` that there are, no more than `largest`, than the scene allows and, to a
// 64th, than all ranks have memory for. Asks for the memory that is free now.
[[nodiscard]] PatchBound patch_bound(const Wanted& wanted, const scenes::Quality& given,
                                     std::size_t first, std::size_t largest);

}  // namespace earthshine::studies
