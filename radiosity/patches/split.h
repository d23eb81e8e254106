// SPDX-License-Identifier: Apache-2.0
// Refines patches: halves cells along s or along t.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/patches/parted_cell.h"
#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

enum class Cut : std::uint8_t { None, S, T };  // S: two halves adjacent along s

struct Split {
  Patches patches;
  std::vector<std::uint32_t> parent;  // per new patch: the old patch that contains it
};

// Halves every patch as requested, once. Both sides of a sheet are divided equally: by the front's
// request, or else by the back's. Halves replace their parent in the order of patches. A cell of
// 2^-20 of its facet's length is not divided: single-precision hits could not distinguish its
// halves.
[[nodiscard]] Split split(const Patches& patches, const std::vector<Cut>& wanted);

// Divides whole cells along the walls on them, now and at every later split.
[[nodiscard]] Patches part_along(Patches patches, Traces traces);

// Marks further cells so that no cell is more than twice as long, along s or along t, as a
// neighbour on its facet. Features missed by the samples of a large cell are thus found from its
// neighbours.
void grade(const Patches& patches, std::vector<Cut>& wanted);

[[nodiscard]] bool can_cut(const Patches& patches, std::uint32_t patch, Cut cut);

// Lengths of a cell along s and along t, m: of a trapezoid the longest, of a part its cell's. For
// several triangles of a cluster, which are halved along s only, the length of their box and 0.
struct CellSize {
  double s_m, t_m;
};
[[nodiscard]] CellSize cell_size(const Patches& patches, std::uint32_t patch);

// Unique number of a patch, independent of its index.
[[nodiscard]] std::uint64_t identity(const Patches& patches, std::uint32_t patch);

}  // namespace earthshine::radiosity
