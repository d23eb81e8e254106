// SPDX-License-Identifier: Apache-2.0
// How much of each patch no body covers (closed_bodies.h), by points rather than by rays: what is
// known in closed form is divided by it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/bodies/closed_bodies.h"
#include "radiosity/patches/patches.h"
#include "scenes/ray_query.h"

namespace earthshine::radiosity {

// What may cover points of one patch, and how much of it that leaves.
struct PatchCover {
  std::vector<std::uint32_t> near;  // empty: nothing
  double open = 1.0;                // share of the patch
  double std_error = 0.0;           // of it, from 16 replicates
};

// Per patch; those that `maybe` does not name have nothing near. All of them together take about
// 2^22 points, each at least 2^12.
[[nodiscard]] std::vector<PatchCover> measure_cover(const ClosedBodies& bodies,
                                                    const scenes::RayQuery& query,
                                                    const Patches& patches,
                                                    std::span<const std::uint32_t> maybe,
                                                    std::uint64_t seed);

}  // namespace earthshine::radiosity
