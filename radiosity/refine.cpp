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
constexpr double share_per_round = 0.5;   // of the squared error, held by the patches that are cut
constexpr double thinnest = 4.0;          // a cell longer than this times its width is halved
constexpr double undirected_share = 0.1;  // of the error, counted toward the longer side
constexpr double growth_between_solves = 2.0;
constexpr int fewest_rays = 64;

std::uint32_t other_side(const Patches& patches, std::uint32_t patch) {
  const Facet& facet = patches.facets[patches.facet[patch]];
  if (facet.first_back == no_patch) return no_patch;
  return patches.is_back[patch] != 0 ? patch - facet.first_back + facet.first_front
                                     : patch - facet.first_front + facet.first_back;
}

struct Choice {
  std::uint32_t patch;  // the front side
  Cut cut;
  double error;    // of both sides
  double urgency;  // error per patch that the cut adds
};

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

std::vector<Choice> worst_first(const Patches& patches, const std::vector<Unevenness>& uneven) {
  std::vector<Choice> choices;
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
    choices.push_back({i, cut, sum.error, sum.error / (back != no_patch ? 2.0 : 1.0)});
  }
  std::sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) {
    return a.urgency != b.urgency ? a.urgency > b.urgency : a.patch < b.patch;
  });
  return choices;
}

std::vector<Cut> marked(const Patches& patches, const std::vector<Choice>& choices,
                        std::size_t count) {
  std::vector<Cut> wanted(patches.count(), Cut::None);
  for (std::size_t k = 0; k < count; ++k) wanted[choices[k].patch] = choices[k].cut;
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

// The patches to cut in this round: the worst that hold a share of the squared error, fewer where
// the budget ends before.
std::vector<Cut> choose(const Patches& patches, const std::vector<Unevenness>& uneven, double total,
                        std::size_t max_patches) {
  const std::vector<Choice> choices = worst_first(patches, uneven);
  std::size_t count = 0;
  for (double sum = 0.0; count < choices.size() && sum < share_per_round * total; ++count) {
    sum += choices[count].error;
  }
  const auto fits = [&](std::size_t k) {
    return count_after(patches, marked(patches, choices, k)) <= max_patches;
  };
  if (!fits(count)) {
    std::size_t few = 0;
    while (count - few > 1) {
      const std::size_t middle = few + (count - few) / 2;
      (fits(middle) ? few : count) = middle;
    }
    count = few;
  }
  return marked(patches, choices, count);
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
  std::vector<Unevenness> uneven;      // of every patch
  std::vector<std::uint32_t> unknown;  // patches whose share is not known yet
  for (int round = 0;; ++round) {
    Patches& patches = refined.patches;
    if (static_cast<double>(patches.count()) >=
        growth_between_solves * static_cast<double>(solution.patches.count())) {
      solution = solve(scene, groups, effects, query, coarse, patches);
      refined.rays += solution.report.form_factor_rays + solution.report.shadow_rays;
      light = relative_light(solution);
      uneven.assign(patches.count(), {});
      unknown.resize(patches.count());
      std::iota(unknown.begin(), unknown.end(), 0U);
    }
    const std::vector<Unevenness> found = variation.find(patches, unknown, light);
    for (std::size_t k = 0; k < unknown.size(); ++k) uneven[unknown[k]] = found[k];
    double total = 0.0;
    for (const Unevenness& u : uneven) total += u.error;
    refined.rounds.push_back({patches.count(), std::sqrt(total)});
    if (round == most_rounds || total <= options.refine.error * options.refine.error) break;
    const std::vector<Cut> wanted = choose(patches, uneven, total, options.refine.max_patches);
    Split cut = split(patches, wanted);
    if (cut.patches.count() == patches.count()) break;
    std::vector<Unevenness> inherited(cut.patches.count());
    unknown.clear();
    for (std::uint32_t i = 0; i < cut.patches.count(); ++i) {
      inherited[i] = uneven[cut.parent[i]];
      if (cut.patches.area_m2[i] < patches.area_m2[cut.parent[i]]) unknown.push_back(i);
    }
    uneven = std::move(inherited);
    patches = std::move(cut.patches);
  }
  refined.rays += variation.rays();
  return refined;
}

}  // namespace earthshine::radiosity
