// SPDX-License-Identifier: Apache-2.0
// Finer patches from coarser ones: cells are cut in four (slivers along their length, patches.h).
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/patches.h"

namespace earthshine::radiosity {

struct Split {
  Patches patches;
  std::vector<std::uint32_t> parent;  // per new patch: the old one that holds it
};

// Cuts every patch with a nonzero entry in `wanted` once; the other side of a sheet is cut with it.
// Children take their parent's place in the order of patches. A cell of 2^-20 of its facet's length
// stays whole: hits come in single precision and could not tell its halves apart.
[[nodiscard]] Split split(const Patches& patches, const std::vector<std::uint8_t>& wanted);

// Marks what else must be cut so that no cell touches one of its facet that has been cut twice more
// often than itself.
void grade(const Patches& patches, std::vector<std::uint8_t>& wanted);

// Patches that cutting `patch` adds, the other side of a sheet included; 0: it stays whole.
[[nodiscard]] std::uint32_t added_by_split(const Patches& patches, std::uint32_t patch);

}  // namespace earthshine::radiosity
