// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/open_share.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/numbers/random.h"
#include "base/parallel.h"
#include "radiosity/patches/patch_offset.h"

namespace earthshine::radiosity {
namespace {

constexpr std::uint32_t replicates = 16;
constexpr std::uint32_t all_points = 1U << 22, most_patch_points = 1U << 20,
                        fewest_points = 1U << 12;

void measure(const ClosedBodies& bodies, const scenes::RayQuery& query, const Patches& patches,
             std::uint32_t patch, std::uint32_t points, std::uint64_t seed, PatchCover& cover) {
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t r = 0; r < replicates; ++r) {
    const base::SobolOwen4 sobol(base::Key(seed, base::Stream::ExactOpening, patch).with(r));
    std::uint32_t open = 0;
    for (std::uint32_t k = 0; k < points / replicates; ++k) {
      const auto p = sobol.point(k);
      const Vec3 at = lifted(patches.at(patch, double(p[0]), double(p[1])), query);
      open += bodies.cover(at - bodies.centre(), cover.near) ? 0 : 1;
    }
    const double share = double(open) / (points / replicates);
    sum += share;
    squares += share * share;
  }
  cover.open = sum / replicates;
  const double variance = std::max(0.0, squares / replicates - cover.open * cover.open);
  cover.std_error = std::sqrt(variance / (replicates - 1));
}

}  // namespace

std::vector<PatchCover> measure_cover(const ClosedBodies& bodies, const scenes::RayQuery& query,
                                      const Patches& patches, std::span<const std::uint32_t> maybe,
                                      std::uint64_t seed) {
  std::vector<PatchCover> covers(patches.count());
  std::vector<std::uint32_t> asked;
  for (const std::uint32_t patch : maybe) {
    covers[patch].near = bodies.near(patches, patch, 2.0 * patch_offset_m(patches, query, patch));
    if (!covers[patch].near.empty()) asked.push_back(patch);
  }
  const std::uint32_t share =
      all_points / static_cast<std::uint32_t>(std::max<std::size_t>(1, asked.size()));
  const std::uint32_t points = std::bit_floor(std::clamp(share, fewest_points, most_patch_points));
  base::parallel_chunks(asked.size(), 1, [&](std::size_t k, std::size_t) {
    measure(bodies, query, patches, asked[k], points, seed, covers[asked[k]]);
  });
  return covers;
}

}  // namespace earthshine::radiosity
