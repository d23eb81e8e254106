// SPDX-License-Identifier: Apache-2.0
#include "radiosity/refine.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "radiosity/near_lamps.h"
#include "radiosity/patches/split.h"
#include "radiosity/variation.h"

namespace earthshine::radiosity {
namespace {

constexpr double share_per_round = 0.5;   // of the squared error, held by the patches that are cut
constexpr double thinnest = 4.0;          // a cell longer than this times its width is halved
constexpr double undirected_share = 0.1;  // of the error, counted toward the longer side
constexpr std::size_t growth_between_solves = 4;
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

// What the rounds of one refinement share.
class Refinement {
 public:
  Refinement(const scenes::World& world, const SolveOptions& options)
      : world_(world),
        options_(options),
        max_patches_(most_refined_patches(world.scene, options)),
        variation_(world, {0.25 * options.patch_edge_m,
                           8 * std::clamp(options.form_factor_rays / 256, 1, 4), options.seed}) {
    cheap_ = options;
    cheap_.form_factor_rays = std::max(fewest_rays, options.form_factor_rays / 8);
    cheap_.tolerance = std::max(options.tolerance, 1e-4);
  }

  Refined run() {
    start();
    double error = find_errors();
    for (int round = 0;; ++round) {
      refined_.rounds.push_back({refined_.patches.count(), error});
      if (round == most_refine_rounds || error <= options_.refine.error) break;
      if (!cut_worst(max_patches_)) break;
      error = find_errors();
    }
    refined_.rays += variation_.rays();
    return std::move(refined_);
  }

 private:
  // The estimated error of the patches as they are.
  double find_errors() {
    look_at_unknown();
    total_ = 0.0;
    for (const Unevenness& u : uneven_) total_ += u.error;
    return std::sqrt(total_);
  }

  // False when nothing was left to cut.
  bool cut_worst(std::size_t max_patches) {
    if (!cut(choose(refined_.patches, uneven_, total_, max_patches))) return false;
    // Worth its rays only while most of the cuts are still to come.
    const std::size_t count = refined_.patches.count();
    if (count >= growth_between_solves * solution_.patches.count() && 2 * count <= max_patches) {
      solve_for(refined_.patches);
    }
    return true;
  }

  void solve_for(const Patches& patches) {
    SolveVariant variant;
    variant.know_objects = false;  // where to cut is no matter of means
    solution_ = solve(world_, cheap_, patches, variant);
    refined_.rays += solution_.report.form_factor_rays + solution_.report.shadow_rays;
    light_ = relative_light(solution_);
    uneven_.assign(patches.count(), {});
    unknown_.resize(patches.count());
    std::iota(unknown_.begin(), unknown_.end(), 0U);
  }

  // The coarse cut, finer where it must be: while a light group falls on none of its sample points,
  // as the Sun may in a room with a small window.
  void start() {
    double edge_m = options_.refine.start_edge_m;
    refined_.patches = subdivide_near_lamps(world_.scene, edge_m);
    solve_for(refined_.patches);
    while (edge_m > options_.patch_edge_m && any_dark()) {
      edge_m = std::max(0.5 * edge_m, options_.patch_edge_m);
      Patches finer = subdivide_near_lamps(world_.scene, edge_m);
      if (finer.count() > max_patches_) return;
      refined_.patches = std::move(finer);
      solve_for(refined_.patches);
    }
  }
  [[nodiscard]] bool any_dark() const {
    for (std::size_t g = 0; g < light_.groups; ++g) {
      if (g != world_.groups.ambient && light_.scale[g] <= 0.0) return true;
    }
    return false;
  }

  void look_at_unknown() {
    const std::vector<Unevenness> found = variation_.find(refined_.patches, unknown_, light_);
    for (std::size_t k = 0; k < unknown_.size(); ++k) uneven_[unknown_[k]] = found[k];
  }

  // False when nothing was left to cut.
  bool cut(const std::vector<Cut>& wanted) {
    const Patches& before = refined_.patches;
    Split made = split(before, wanted);
    if (made.patches.count() == before.count()) return false;
    std::vector<Unevenness> inherited(made.patches.count());
    unknown_.clear();
    for (std::uint32_t i = 0; i < made.patches.count(); ++i) {
      inherited[i] = uneven_[made.parent[i]];
      if (made.patches.area_m2[i] < before.area_m2[made.parent[i]]) unknown_.push_back(i);
    }
    uneven_ = std::move(inherited);
    refined_.patches = std::move(made.patches);
    return true;
  }

  const scenes::World& world_;
  const SolveOptions& options_;
  SolveOptions cheap_;
  std::size_t max_patches_;
  Variation variation_;
  Solution solution_;  // on the patches of an earlier round
  RelativeLight light_;
  std::vector<Unevenness> uneven_;      // per patch
  std::vector<std::uint32_t> unknown_;  // patches not looked at yet
  double total_ = 0.0;                  // squared error
  Refined refined_;
};

}  // namespace

std::size_t most_refined_patches(const scenes::Scene& scene, const SolveOptions& options) {
  const RefineOptions& refine = options.refine;
  if (refine.max_patches == 0 && options.patch_edge_m <= refine.start_edge_m) {
    return count_patches(scene, options.patch_edge_m);  // no fewer than the coarse cut has
  }
  const std::size_t budget =
      refine.max_patches > 0 ? refine.max_patches : count_patches(scene, options.patch_edge_m);
  return std::max(budget, count_patches(scene, refine.start_edge_m));
}

Refined refine(const scenes::World& world, const SolveOptions& options) {
  if (options.refine.on && is_lit(world.effects) && !world.scene.triangles.empty()) {
    return Refinement(world, options).run();
  }
  Refined even;
  even.patches = subdivide_near_lamps(world.scene, options.patch_edge_m);
  return even;
}

}  // namespace earthshine::radiosity
