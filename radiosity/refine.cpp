// SPDX-License-Identifier: Apache-2.0
#include "radiosity/refine.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "radiosity/split.h"
#include "radiosity/variation.h"

namespace earthshine::radiosity {
namespace {

constexpr int most_rounds = 24;
constexpr double share_per_round = 0.5;  // of the squared error, held by the patches that are cut
constexpr double growth_between_solves = 2.0;
constexpr int fewest_rays = 64;

std::uint32_t other_side(const Patches& patches, std::uint32_t patch) {
  const Facet& facet = patches.facets[patches.facet[patch]];
  if (facet.first_back == no_patch) return no_patch;
  return patches.is_back[patch] != 0 ? patch - facet.first_back + facet.first_front
                                     : patch - facet.first_front + facet.first_back;
}

// Cells (front sides) by error per patch that a cut adds, worst first.
std::vector<std::uint32_t> worst_first(const Patches& patches, const std::vector<float>& shares,
                                       std::vector<double>& error) {
  std::vector<std::uint32_t> order;
  error.assign(patches.count(), 0.0);
  std::vector<double> urgency(patches.count(), 0.0);
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    if (patches.is_back[i] != 0) continue;
    const std::uint32_t back = other_side(patches, i);
    error[i] = double(shares[i]) + (back != no_patch ? double(shares[back]) : 0.0);
    const std::uint32_t added = added_by_split(patches, i);
    if (error[i] <= 0.0 || added == 0) continue;
    urgency[i] = error[i] / added;
    order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return urgency[a] != urgency[b] ? urgency[a] > urgency[b] : a < b;
  });
  return order;
}

std::vector<std::uint8_t> marked(const Patches& patches, const std::vector<std::uint32_t>& order,
                                 std::size_t count) {
  std::vector<std::uint8_t> wanted(patches.count(), 0);
  for (std::size_t k = 0; k < count; ++k) wanted[order[k]] = 1;
  grade(patches, wanted);
  return wanted;
}

std::size_t count_after(const Patches& patches, const std::vector<std::uint8_t>& wanted) {
  std::size_t count = patches.count();
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    if (wanted[i] != 0) count += added_by_split(patches, i);
  }
  return count;
}

// The patches to cut in this round: the worst that hold a share of the squared error, fewer where
// the budget ends before.
std::vector<std::uint8_t> choose(const Patches& patches, const std::vector<float>& shares,
                                 double total, std::size_t max_patches) {
  std::vector<double> error;
  const std::vector<std::uint32_t> order = worst_first(patches, shares, error);
  std::size_t count = 0;
  for (double sum = 0.0; count < order.size() && sum < share_per_round * total; ++count) {
    sum += error[order[count]];
  }
  std::vector<std::uint8_t> wanted = marked(patches, order, count);
  std::size_t fits = 0, too_many = count + 1;
  if (count_after(patches, wanted) <= max_patches) return wanted;
  while (too_many - fits > 1) {
    const std::size_t middle = fits + (too_many - fits) / 2;
    (count_after(patches, marked(patches, order, middle)) <= max_patches ? fits : too_many) =
        middle;
  }
  return marked(patches, order, fits);
}

}  // namespace

Refined refine(const scenes::Scene& scene, const scenes::LightGroups& groups,
               const scenes::Effects& effects, const scenes::RayQuery& query,
               const SolveOptions& options) {
  Refined refined;
  refined.patches = subdivide(scene, options.patch_edge_m);
  if (options.refine.max_patches == 0 || !is_lit(effects) || refined.patches.count() == 0) {
    return refined;
  }
  SolveOptions coarse = options;
  coarse.form_factor_rays = std::max(fewest_rays, options.form_factor_rays / 8);
  coarse.tolerance = std::max(options.tolerance, 1e-4);
  Variation variation(scene, groups, effects, query, options.seed);
  Solution solution;
  RelativeLight light;
  std::vector<float> shares;           // of every patch
  std::vector<std::uint32_t> unknown;  // patches whose share is not known yet
  for (int round = 0;; ++round) {
    Patches& patches = refined.patches;
    if (static_cast<double>(patches.count()) >=
        growth_between_solves * static_cast<double>(solution.patches.count())) {
      solution = solve(scene, groups, effects, query, coarse, patches);
      refined.rays += solution.report.form_factor_rays + solution.report.shadow_rays;
      light = relative_light(solution);
      shares.assign(patches.count(), 0.0F);
      unknown.resize(patches.count());
      std::iota(unknown.begin(), unknown.end(), 0U);
    }
    const std::vector<float> found = variation.error_shares(patches, unknown, light);
    for (std::size_t k = 0; k < unknown.size(); ++k) shares[unknown[k]] = found[k];
    double total = 0.0;
    for (const float share : shares) total += double(share);
    refined.rounds.push_back({patches.count(), std::sqrt(total)});
    if (round == most_rounds || total <= options.refine.error * options.refine.error) break;
    const std::vector<std::uint8_t> wanted =
        choose(patches, shares, total, options.refine.max_patches);
    Split cut = split(patches, wanted);
    if (cut.patches.count() == patches.count()) break;
    std::vector<float> inherited(cut.patches.count());
    unknown.clear();
    for (std::uint32_t i = 0; i < cut.patches.count(); ++i) {
      inherited[i] = shares[cut.parent[i]];
      if (cut.patches.cell[i].level != patches.cell[cut.parent[i]].level) unknown.push_back(i);
    }
    shares = std::move(inherited);
    patches = std::move(cut.patches);
  }
  refined.rays += variation.rays();
  return refined;
}

}  // namespace earthshine::radiosity
