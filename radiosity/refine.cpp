// SPDX-License-Identifier: Apache-2.0
#include "radiosity/refine.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "radiosity/near_lamps.h"
#include "radiosity/patches/refiner.h"
#include "radiosity/variation.h"

namespace earthshine::radiosity {
namespace {

constexpr double share_per_round = 0.5;  // of the squared error: a round divides these patches
constexpr std::size_t growth_between_solves = 4;
constexpr int fewest_rays = 64;

// Data of all rounds of one refinement.
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
  // Estimated error of the present patches.
  double find_errors() {
    const std::vector<Unevenness> found = variation_.find(refined_.patches, unknown_, light_);
    for (std::size_t k = 0; k < unknown_.size(); ++k) refiner_->of(unknown_[k]) = found[k];
    return std::sqrt(refiner_->total());
  }

  // False if nothing can be divided.
  bool cut_worst(std::size_t max_patches) {
    const std::vector<Cut> cuts =
        refiner_->worst(refined_.patches, {0.0, share_per_round, max_patches});
    if (cuts.empty()) return false;
    Split made = split(refined_.patches, cuts);
    if (made.patches.count() == refined_.patches.count()) return false;
    unknown_ = refiner_->follow(made.patches, made.parent);
    refined_.patches = std::move(made.patches);
    // Worth its rays only if most divisions are still to come.
    const std::size_t count = refined_.patches.count();
    if (count >= growth_between_solves * solution_.patches.count() && 2 * count <= max_patches) {
      solve_for(refined_.patches);
    }
    return true;
  }

  void solve_for(const Patches& patches) {
    SolveVariant variant;
    variant.know_objects = false;  // object means do not matter for refinement
    solution_ = solve(world_, cheap_, patches, variant);
    refined_.rays += solution_.report.form_factor_rays + solution_.report.shadow_rays;
    light_ = relative_light(solution_);
    refiner_.emplace(patches);
    unknown_.resize(patches.count());
    std::iota(unknown_.begin(), unknown_.end(), 0U);
  }

  // The coarse division, finer while a light group reaches none of its sample points, such as the
  // Sun in a room with a small window.
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

  const scenes::World& world_;
  const SolveOptions& options_;
  SolveOptions cheap_;
  std::size_t max_patches_;
  Variation variation_;
  Solution solution_;  // on the patches of an earlier round
  RelativeLight light_;
  std::optional<Refiner> refiner_;
  std::vector<std::uint32_t> unknown_;  // patches without an estimate
  Refined refined_;
};

}  // namespace

std::size_t most_refined_patches(const scenes::Scene& scene, const SolveOptions& options) {
  const RefineOptions& refine = options.refine;
  if (refine.max_patches == 0 && options.patch_edge_m <= refine.start_edge_m) {
    return count_patches(scene, options.patch_edge_m);  // at least as many as the coarse division
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
