// SPDX-License-Identifier: Apache-2.0
// The expensive work of a visibility study, done once per scene and camera and stored in the
// study's folder: the radiosity solution of all light groups, and a picture with a layer for each
// group.
#pragma once

#include "app/parts/part.h"
#include "app/parts/result_cache.h"
#include "app/study/results.h"
#include "app/views/scene.h"
#include "base/image.h"
#include "radiosity/store/solution_file.h"
#include "raytrace/render.h"
#include "studies/orbit/condition_noise.h"
#include "studies/sight/sight.h"

namespace earthshine::app {

// Solver settings of a study. Pictures add the residual, with noise above a per cent, so that a
// solver_tolerance of 1e-4 is sufficient unless the scene sets one: with some 100 light groups each
// product of the solver is expensive.
[[nodiscard]] radiosity::SolveOptions study_solver(const scenes::Scene& scene,
                                                   const Common& common);

[[nodiscard]] std::vector<double> luminances(const studies::GroupWeights& weights);

class StudyFrames {
 public:
  // Light that the poses of a scene leave for each other.
  struct Poses {
    std::optional<radiosity::Patches> patches;  // of the first pose
    radiosity::KeptPose kept;
  };
  // how: parts share one solution. poses: outlives it; null: nothing is left for other poses.
  StudyFrames(const StudyPart& part, const std::filesystem::path& folder, const Common& common,
              const PartCall& how, Poses* poses = nullptr);

  // Wanted error of the conditions' pictures.
  [[nodiscard]] static double wanted_error(const scenes::Scene& scene);

  // A camera's picture with the layer "object"; no value if interrupted.
  struct Frame {
    base::Image image;
    double seconds = 0.0;
    double relative_noise = 0.0;
    std::uint64_t rays = 0;
    std::vector<std::string> limits = {};  // limitations of its solution
    std::size_t patches = 0;               // number in its solution
    raytrace::LayerErrors errors = {};     // complete if the image is
    raytrace::RegionNoise regions = {};    // of each target and its surround
    // Noise of the weighted sum of a condition.
    [[nodiscard]] studies::ConditionNoise noise_of(const studies::GroupWeights& weights) const;
    // Standard error of each target's difference from its surround in this sum, cd/m^2.
    [[nodiscard]] std::vector<double> deviations(const studies::GroupWeights& weights) const;
  };
  [[nodiscard]] std::optional<Frame> frame(const StudyCamera& camera,
                                           std::vector<StudyCost>& costs);

  // All input of a camera's picture.
  [[nodiscard]] Json cache_key(const StudyCamera& camera) const;
  // Data of a stored picture, without reading it.
  [[nodiscard]] std::optional<Frame> known(const StudyCamera& camera,
                                           std::vector<StudyCost>& costs) const;
  // Whether a complete picture is stored.
  [[nodiscard]] bool has(const StudyCamera& camera) const;
  // All stored results of the study.
  [[nodiscard]] const ResultCache& store() const { return store_; }

  // Digests of the scene, the solver's settings and the program.
  [[nodiscard]] const Json& scene_key() const { return scene_cache_key_; }

  // Solution of all light groups; solved or read at the first request.
  [[nodiscard]] const radiosity::Solution& solution(std::vector<StudyCost>& costs);
  // Call when no more cameras of the scene follow: frees memory for other scenes.
  void forget_solution() { solution_.reset(); }

 private:
  [[nodiscard]] StudyCost cost_of(const StudyCamera& camera, const Frame& frame, bool found) const;
  // The stored frame; no value unless complete.
  [[nodiscard]] std::optional<Frame> find(const Json& cache_key, std::string& said) const;
  // Stores the frame and returns it as it will be read.
  void keep(const Json& cache_key, base::Image image, Frame& frame) const;
  [[nodiscard]] raytrace::RenderOptions options(const StudyCamera& camera) const;
  // Layers times pixels of the camera's picture.
  [[nodiscard]] std::size_t values_of(const StudyCamera& camera) const;
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> regions_at(const StudyCamera& camera) const;

  [[nodiscard]] radiosity::Solution solve(StageTimes& times) const;
  // Of the first pose of the scene.
  [[nodiscard]] radiosity::Patches first_patches() const;
  // Reads the file's solution, or solves if it cannot be read.
  [[nodiscard]] radiosity::Solution read_or_solve(const std::filesystem::path& file,
                                                  const radiosity::SolutionOrigin& origin,
                                                  StudyCost& cost, StageTimes& times) const;

  const StudyPart& part_;
  const Common& common_;
  const PartCall& how_;
  Poses* poses_;
  std::filesystem::path folder_;
  ResultCache store_;
  radiosity::SolveOptions solver_;
  Json scene_cache_key_;
  std::optional<radiosity::Solution> solution_;
};

}  // namespace earthshine::app
