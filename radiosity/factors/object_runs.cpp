// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/object_runs.h"

#include <algorithm>
#include <bit>

namespace earthshine::radiosity {
namespace {

// Of an object of so many patches, for it to be known by `wanted` of them.
std::uint32_t runs_of(std::size_t patches, std::size_t wanted, int rays_per_patch) {
  if (patches == 0) return 1;
  const std::size_t needed = std::bit_ceil((wanted + patches - 1) / patches);
  const std::uint32_t most =
      std::bit_floor(std::max(1U, most_rays_of_a_row / static_cast<std::uint32_t>(rays_per_patch)));
  return std::min(static_cast<std::uint32_t>(needed), most);
}

}  // namespace

std::vector<std::uint32_t> object_runs(const scenes::Scene& scene, const Patches& patches,
                                       int rays_per_patch) {
  std::vector<std::size_t> of_object(scene.objects.size(), 0);
  for (std::uint32_t i = 0; i < patches.count(); ++i) ++of_object[patches.object(i)];
  const std::size_t most_extra = std::max(patches.count() / most_extra_share, most_extra_runs);
  std::vector<std::uint32_t> runs(of_object.size(), 1);
  for (std::size_t wanted = patches_known_by; wanted > 1; wanted /= 2) {
    std::size_t extra = 0;
    for (std::size_t o = 0; o < runs.size(); ++o) {
      runs[o] = runs_of(of_object[o], wanted, rays_per_patch);
      extra += of_object[o] * (runs[o] - 1);
    }
    if (extra <= most_extra) return runs;
  }
  std::fill(runs.begin(), runs.end(), 1U);
  return runs;
}

}  // namespace earthshine::radiosity
