// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/refiner.h"

#include <algorithm>
#include <span>

namespace earthshine::radiosity {
namespace {

constexpr double thinnest = 4.0;          // a cell longer than this times its width is halved
constexpr double kept_by_halves = 0.5;    // of the error: a shadow's edge crosses one half
constexpr double undirected_share = 0.1;  // of the error, added to the longer side

struct CutCandidate {
  std::uint32_t patch;  // the front side
  Cut cut;
  double error;    // of both sides
  double urgency;  // error per added patch
};

std::uint32_t other_side(const Patches& patches, std::uint32_t patch) {
  const Facet& facet = patches.facets[patches.facet[patch]];
  if (facet.first_back == no_patch) return no_patch;
  return patches.is_back[patch] != 0 ? patch - facet.first_back + facet.first_front
                                     : patch - facet.first_front + facet.first_back;
}

// Direction of the division: the one that removes more error, unless the cells would be long and
// thin. If the samples show no direction (a spot, a thin shadow), divides the longer side.
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

// Patches with an error that can be halved, the most urgent first.
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

// Divides the first `count` candidates, graded; fewer if more than `most` patches would result.
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

}  // namespace

double Refiner::total() const {
  double sum = 0.0;
  for (const Unevenness& u : uneven_) sum += u.error;
  return sum;
}

std::vector<Cut> Refiner::worst(const Patches& patches, const Budget& budget) const {
  const double all = total();
  if (all <= budget.enough || patches.count() >= budget.most_patches) return {};
  const std::vector<CutCandidate> candidates = worst_first(patches, uneven_);
  std::size_t count = 0;
  for (double sum = 0.0; count < candidates.size() && sum < budget.share * all &&
                         all - (1.0 - kept_by_halves) * sum > budget.enough;
       ++count) {
    sum += candidates[count].error;
  }
  std::vector<Cut> wanted = cuts_within(patches, candidates, count, budget.most_patches);
  const bool any =
      std::any_of(wanted.begin(), wanted.end(), [](Cut cut) { return cut != Cut::None; });
  return any ? wanted : std::vector<Cut>();
}

std::vector<std::uint32_t> Refiner::follow(const Patches& patches,
                                           const std::vector<std::uint32_t>& parent) {
  std::vector<Unevenness> inherited(parent.size());
  std::vector<std::uint32_t> fresh;
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    const Unevenness& before = uneven_[parent[i]];
    inherited[i] = before;
    if (patches.area_m2[i] >= patch_m2_[parent[i]]) continue;
    fresh.push_back(i);
    inherited[i] = {kept_by_halves * before.error * patches.area_m2[i] / patch_m2_[parent[i]], 0.0,
                    0.0};
  }
  uneven_ = std::move(inherited);
  patch_m2_ = patches.area_m2;
  return fresh;
}

}  // namespace earthshine::radiosity
