// SPDX-License-Identifier: Apache-2.0
// How many rays the patches of small objects send. The mean illuminance of an object is a mean over
// all of its patches' rays: a wall of 500 patches is known by 500 times the rays of a gauge that is
// a single patch. What a solve states of an object shall not depend on that, so the patches of an
// object that has fewer than 64 send as many rays together as 64 would.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

// As many patches' rays an object has at least, while that is within the bounds below.
inline constexpr std::size_t patches_known_by = 64;
// What all of them cost is bounded: by a quarter of the scene's patches or by 2048 of them,
// whichever is more. Where many objects are small, all get less.
inline constexpr std::size_t most_extra_share = 4, most_extra_runs = 2048;
// No row is longer for it.
inline constexpr std::uint32_t most_rays_of_a_row = std::uint32_t{1} << 20;

// Per object of the scene: the runs of rays_per_patch rays that each of its patches sends, a power
// of two, 1 for objects of patches_known_by patches and more. Up to the last bound it depends on
// the cut alone, so that solves with other numbers of rays share them in the same proportion.
[[nodiscard]] std::vector<std::uint32_t> object_runs(const scenes::Scene& scene,
                                                     const Patches& patches, int rays_per_patch);

}  // namespace earthshine::radiosity
