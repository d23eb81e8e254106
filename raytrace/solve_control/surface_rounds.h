// SPDX-License-Identifier: Apache-2.0
// Rounds of a solve to an error: cuts the patches where light is uneven within them and samples the
// new ones.
#pragma once

#include <functional>
#include <string>

#include "raytrace/solve_control/wanted_error.h"
#include "raytrace/surfaces/surface_light.h"
#include "raytrace/surfaces/surface_refiner.h"

namespace earthshine::raytrace {

class SurfaceRounds {
 public:
  // All must outlive it. most: patches.
  SurfaceRounds(const scenes::World& scene, const Wanted& wanted, std::uint64_t seed,
                LightOnSurfaces& light, std::size_t most, const StageListener& progress);

  // Of the radiosity, that error_weight() goes by.
  void set_mean(double mean) { mean_ = mean; }
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }
  [[nodiscard]] const radiosity::PatchAlbedos& reflectances() const {
    return sampler_.reflectances();
  }

  // By shadow rays all over, where the first solve has found none: a spot of sunlight that its few
  // points missed. Sets the mean.
  void find_light();
  // A set of samples of its own. name: of the stage.
  [[nodiscard]] SurfaceSamples sample(std::span<const std::uint32_t> which,
                                      std::span<const SampleBudget> budget, const std::string& name,
                                      SamplesOf of);
  // By shadow rays and cosine rays, until `enough` of the mean square is left, as far as the pieces
  // tell. points: over all surfaces. parent: of each patch, kept up. Whether anything was cut.
  bool cut_gathered(SurfaceRefiner& choice, double enough, double points,
                    std::vector<std::uint32_t>& parent);
  // By shadow rays alone: the edges of shadows and the surroundings of lamps, by twice as many
  // points the next time; nothing once there was nothing left to cut. also: follows the cuts.
  bool cut_shadows(double enough, std::vector<std::uint32_t>& parent,
                   SurfaceRefiner* also = nullptr);

 private:
  // SurfaceRefiner::worst()'s arguments, the share of the time limit after which nothing is cut, how the
  // pieces are sampled, and as which stage.
  struct How {
    double enough, share;
    std::size_t limit;
    double until;
    std::function<std::vector<SampleBudget>(std::span<const std::uint32_t>)> budget;
    std::string name;
  };

  // Of ranks that divide the form factors the first decides, and the others sample with it.
  [[nodiscard]] bool joins() const { return light_.shares().joins(); }
  // The share of the time limit; 0 without one.
  [[nodiscard]] double time_gone() const;
  [[nodiscard]] std::vector<radiosity::Cut> worst(const SurfaceRefiner& choice, const How& how);
  // What is sampled on some patches, seen and put into the light.
  void update(SurfaceRefiner& choice, std::span<const std::uint32_t> which, const How& how);
  // By shadow rays alone, until `enough` is left.
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
