// SPDX-License-Identifier: Apache-2.0
// Rounds within a pass of a solve to a wanted error: divide patches with uneven light and sample
// the new ones.
#pragma once

#include <functional>
#include <string>

#include "raytrace/solve_control/wanted_error.h"
#include "raytrace/surfaces/surface_light.h"
#include "raytrace/surfaces/surface_refiner.h"

namespace earthshine::raytrace {

class SurfaceRounds {
 public:
  // The arguments must outlive it. most: number of patches.
  SurfaceRounds(const scenes::World& scene, const Wanted& wanted, std::uint64_t seed,
                LightOnSurfaces& light, std::size_t most, const StageListener& progress);

  // Mean of the radiosity, for error_weight().
  void set_mean(double mean) { mean_ = mean; }
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }
  [[nodiscard]] const radiosity::PatchAlbedos& reflectances() const {
    return sampler_.reflectances();
  }

  // Samples all patches by shadow rays if the first solve is black: its few points may have missed
  // a spot of sunlight. Sets the mean.
  void find_light();
  // An independent set of samples. name: of the stage.
  [[nodiscard]] SurfaceSamples sample(std::span<const std::uint32_t> which,
                                      std::span<const SampleBudget> budget, const std::string& name,
                                      SamplesOf of);
  // Divides patches by shadow rays and cosine rays, until the samples of the new patches indicate
  // that `enough` of the mean square remains. points: over all surfaces. parent: updated for each
  // patch. Returns whether a patch was divided.
  bool cut_gathered(SurfaceRefiner& choice, double enough, double points,
                    std::vector<std::uint32_t>& parent);
  // Divides patches by shadow rays only: at edges of shadows and near lamps, with twice as many
  // points in the next call; none after a call without divisions. also: a refiner to update.
  bool cut_shadows(double enough, std::vector<std::uint32_t>& parent,
                   SurfaceRefiner* also = nullptr);

 private:
  // Arguments of SurfaceRefiner::worst(), the share of the time limit after which no patch is
  // divided, the sample budgets of new patches, and the name of the stage.
  struct How {
    double enough, share;
    std::size_t limit;
    double until;
    std::function<std::vector<SampleBudget>(std::span<const std::uint32_t>)> budget;
    std::string name;
  };

  // If ranks divide the form factors, the root rank decides, and all ranks sample.
  [[nodiscard]] bool is_root() const { return light_.shares().is_root(); }
  // Elapsed share of the time limit; 0 without a limit.
  [[nodiscard]] double time_gone() const;
  [[nodiscard]] std::vector<radiosity::Cut> worst(const SurfaceRefiner& choice, const How& how);
  // Samples some patches and adds the samples to `choice` and to the light.
  void update(SurfaceRefiner& choice, std::span<const std::uint32_t> which, const How& how);
  // Arguments for shadow rays only, until `enough` remains.
  [[nodiscard]] How for_shadows(double enough) const;
  bool cut(SurfaceRefiner& choice, const How& how, std::vector<std::uint32_t>& parent,
           SurfaceRefiner* also);

  const Wanted& wanted_;
  SurfaceSampler sampler_;
  LightOnSurfaces& light_;
  std::size_t first_, most_;  // patches
  const StageListener& progress_;
  double mean_ = 0.0;
  std::uint32_t pass_ = 0;
  std::uint64_t rays_ = 0;
  double shadow_points_;
};

}  // namespace earthshine::raytrace
