// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/worst_cuts.h"

#include <algorithm>

namespace earthshine::radiosity {
namespace {

constexpr double thinnest = 4.0;          // a cell longer than this times its width is halved
constexpr double undirected_share = 0.1;  // of the error, counted toward the longer side

std::uint32_t other_side(const Patches& patches, std::uint32_t patch) {
  const Facet& facet = patches.facets[patches.facet[patch]];
  if (facet.first_back == no_patch) return no_patch;
  return patches.is_back[patch] != 0 ? patch - facet.first_back + facet.first_front
                                     : patch - facet.first_front + facet.first_back;
}

// Along which side a cell is halved: where more of the error goes away, unless that would make it
// long and thin. Where the samples show no direction (a spot, a thin shadow), the longer side.
Cut best_cut(const Patches& patches, std::uint32_t patch, const Unevenness& uneven) {
  const bool s_can = can_cut(patches, patch, Cut::S), t_can = can_cut(patches, patch, Cut::T);
  if (!s_can || !t_can) return s_can ? Cut::S : t_can ? Cut::T : Cut::None;
  const CellSize size = cell_size(patches, patch);
  if (size.s_m > thinnest * size.t_m) return Cut::S;
  if (size.t_m > thinnest * size.s_m) return Cut::T;
  const double s2 = size.s_m * size.s_m, t2 = size.t_m * size.t_m;
  const double by_shape = undirected_share * uneven.error * (s2 - t2) / (s2 + t2);
  return uneven.along_s - uneven.along_t + by_shape >= 0.0 ? Cut::S : Cut::T;
}

std::vector<Cut> marked(const Patches& patches, std::span<const CutCandidate> candidates) {
  std::vector<Cut> wanted(patches.count(), Cut::None);
  for (const CutCandidate& one : candidates) wanted[one.patch] = one.cut;
  grade(patches, wanted);
  return wanted;
}

std::size_t count_after(const Patches& patches, const std::vector<Cut>& wanted) {
  std::size_t count = patches.count();
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    if (wanted[i] != Cut::None) count += other_side(patches, i) != no_patch ? 2 : 1;
  }
  return count;
}

}  // namespace

std::vector<CutCandidate> worst_first(const Patches& patches, std::span<const Unevenness> uneven) {
  std::vector<CutCandidate> candidates;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    if (patches.is_back[i] != 0) continue;
    Unevenness sum = uneven[i];
    const std::uint32_t back = other_side(patches, i);
    if (back != no_patch) {
      sum.error += uneven[back].error;
      sum.along_s += uneven[back].along_s;
      sum.along_t += uneven[back].along_t;
    }
    if (sum.error <= 0.0) continue;
    const Cut cut = best_cut(patches, i, sum);
    if (cut == Cut::None) continue;
    candidates.push_back({i, cut, sum.error, sum.error / (back != no_patch ? 2.0 : 1.0)});
  }
  std::sort(candidates.begin(), candidates.end(), [](const CutCandidate& a, const CutCandidate& b) {
    return a.urgency != b.urgency ? a.urgency > b.urgency : a.patch < b.patch;
  });
  return candidates;
}

std::vector<Cut> cuts_within(const Patches& patches, std::span<const CutCandidate> candidates,
                             std::size_t count, std::size_t most) {
  std::vector<Cut> wanted = marked(patches, candidates.first(count));
  if (count_after(patches, wanted) <= most) return wanted;
  std::size_t few = 0;
  while (count - few > 1) {
    const std::size_t middle = few + (count - few) / 2;
    const bool fits = count_after(patches, marked(patches, candidates.first(middle))) <= most;
    (fits ? few : count) = middle;
  }
  return marked(patches, candidates.first(few));
}

}  // namespace earthshine::radiosity
