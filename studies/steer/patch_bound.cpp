// SPDX-License-Identifier: Apache-2.0
#include "studies/steer/patch_bound.h"

#include <algorithm>

namespace earthshine::studies {

PatchBound patch_bound(const Wanted& wanted, const scenes::Quality& given, std::size_t first,
                       std::size_t largest) {
  constexpr int rays = 16;          // a patch, which coarse ones share
  constexpr std::size_t near = 64;  // of which one more or less does not count
  PatchBound bound{std::max(first, largest)};
  if (given.max_patches) {
    const std::size_t allowed = std::max(first, static_cast<std::size_t>(*given.max_patches));
    if (allowed < bound.most) bound = {allowed, Limit::Settings};
  }
  const auto fits = [&](std::size_t count) {
    return !wanted.fits || wanted.fits(static_cast<double>(count), rays);
  };
  if (fits(bound.most)) return bound;
  std::size_t enough = first;
  for (std::size_t more = bound.most; more > enough + enough / near + 1;) {
    const std::size_t middle = enough + (more - enough) / 2;
    (fits(middle) ? enough : more) = middle;
  }
  return {enough, Limit::Memory};
}

}  // namespace earthshine::studies
