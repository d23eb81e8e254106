// SPDX-License-Identifier: Apache-2.0
// Finer patches from coarser ones: cells are halved along s or along t.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/patches/parted_cell.h"
#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

enum class Cut : std::uint8_t { None, S, T };  // S: two halves side by side along s

struct Split {
  Patches patches;
  std::vector<std::uint32_t> parent;  // per new patch: the old one that holds it
};

// Halves every patch as `wanted` has it, once. The two sides of a sheet are cut alike: as the front
// wants, or else as the back does. Halves take their parent's place in the order of patches. A cell
// of 2^-20 of its facet's length stays whole: hits come in single precision and could not tell its
// halves apart.
[[nodiscard]] Split split(const Patches& patches, const std::vector<Cut>& wanted);

// Parts whole cells along the walls on them, now and whenever they are split.
[[nodiscard]] Patches part_along(Patches patches, Traces traces);

// Marks what else must be cut so that no cell grows more than twice as long along s, or along t, as
// a neighbour on its facet. What a few samples of a large cell missed is found from beside it.
void grade(const Patches& patches, std::vector<Cut>& wanted);

[[nodiscard]] bool can_cut(const Patches& patches, std::uint32_t patch, Cut cut);

// Lengths of a cell along s and along t, m; of a trapezoid the longest, of a part its cell's. Of
// several triangles of a cluster, which are halved along s only, that of their box and 0.
struct CellSize {
  double s_m, t_m;
};
[[nodiscard]] CellSize cell_size(const Patches& patches, std::uint32_t patch);

// Of one patch: a number of its own wherever it stands in the list of patches.
[[nodiscard]] std::uint64_t identity(const Patches& patches, std::uint32_t patch);

}  // namespace earthshine::radiosity
