// SPDX-License-Identifier: Apache-2.0
// Rows of form factors that one pose of a scene leaves for the next one. The rays of a patch are
// keyed by its number: where no ray meets what moved, the row is the same, and is not cast again.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/bodies/moved_parts.h"

namespace earthshine::radiosity {

// Results of one row besides its hits.
struct Row {
  std::uint32_t entries = 0;
  double black = 0.0, sky = 0.0;  // in rays
  double landed = 0.0;            // in rays, that end on patches
  std::uint64_t rays = 0;
  std::uint32_t sent = 0;  // rays cast
  std::uint32_t open = 0;  // rays cast from open points: these count
};

struct KeptRow {
  Row row;
  std::vector<std::uint32_t> column;
  std::vector<float> hits;
  std::vector<std::uint32_t> backs;   // objects whose backs were hit
  std::vector<std::uint64_t> missed;  // bit k: ray k reached the sky
  bool is_plain = false;              // no ray continued from a mirror or glass
};

struct KeptRows {
  std::vector<KeptRow> rows;          // per patch; empty: of no pose yet
  const MovedParts* moved = nullptr;  // since then; null: nothing may be kept
};

}  // namespace earthshine::radiosity
