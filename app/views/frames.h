// SPDX-License-Identifier: Apache-2.0
// The costly work of a visibility study, done once per scene and camera and kept in the study's
// folder: the radiosity solution of all light groups, and a picture with a layer for each.
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

// Of a study's solution. Its pictures add what the solution lacks and are noisier than per cents,
// so that a solver_tolerance of 1e-4 is enough where the scene has none of its own: of some 100
// light groups at once each product of the solver takes its time.
[[nodiscard]] radiosity::SolveOptions study_solver(const scenes::Scene& scene,
                                                   const Common& common);

[[nodiscard]] std::vector<double> luminances(const studies::GroupWeights& weights);

class StudyFrames {
 public:
  // how: in parts, all of them read one solution.
  StudyFrames(const StudyPart& part, const std::filesystem::path& folder, const Common& common,
              const PartCall& how);

  // That conditions' pictures are to have.
  [[nodiscard]] static double wanted_error(const scenes::Scene& scene);

  // The picture of a camera, with the layer "object"; nothing if it was interrupted.
  struct Frame {
    base::Image image;
    double seconds = 0.0;
    double relative_noise = 0.0;
    std::uint64_t rays = 0;
    std::vector<std::string> limits = {};  // that the solution it was drawn from reached
    std::size_t patches = 0;               // of that solution
    raytrace::LayerErrors errors = {};     // complete where the image is
    raytrace::RegionNoise regions = {};    // of each target and its surround
    // Of the weighted sum that a condition is.
    [[nodiscard]] studies::ConditionNoise noise_of(const studies::GroupWeights& weights) const;
    // Standard error of each target's difference from its surround in that sum, cd/m^2.
    [[nodiscard]] std::vector<double> deviations(const studies::GroupWeights& weights) const;
  };
  [[nodiscard]] std::optional<Frame> frame(const StudyCamera& camera,
                                           std::vector<StudyCost>& costs);

  // Everything that a camera's picture depends on.
  [[nodiscard]] Json cache_key(const StudyCamera& camera) const;
  // What is known of a picture that is there, without reading it.
  [[nodiscard]] std::optional<Frame> known(const StudyCamera& camera,
                                           std::vector<StudyCost>& costs) const;
  // Whether a picture is there, whole.
  [[nodiscard]] bool has(const StudyCamera& camera) const;
  // Of all that is kept of the study.
  [[nodiscard]] const ResultCache& store() const { return store_; }

  // Digests of the scene, the solver's settings and the program.
  [[nodiscard]] const Json& scene_key() const { return scene_cache_key_; }

  // Of all light groups; solved or read when it is first asked for.
  [[nodiscard]] const radiosity::Solution& solution(std::vector<StudyCost>& costs);
  // Where no more of its cameras come: its memory is free for those of other scenes.
  void forget_solution() { solution_.reset(); }

 private:
  [[nodiscard]] StudyCost cost_of(const StudyCamera& camera, const Frame& frame, bool found) const;
  // The frame that is kept; nothing where there is none, whole.
  [[nodiscard]] std::optional<Frame> find(const Json& cache_key, std::string& said) const;
  // Keeps it and takes it as it will be read.
  void keep(const Json& cache_key, base::Image image, Frame& frame) const;
  [[nodiscard]] raytrace::RenderOptions options(const StudyCamera& camera) const;
  // Layers times pixels of its picture.
  [[nodiscard]] std::size_t values_of(const StudyCamera& camera) const;
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> regions_at(const StudyCamera& camera) const;

  [[nodiscard]] radiosity::Solution solve(StageTimes& times) const;
  // The file's, or a new one in place of one that cannot be read.
  [[nodiscard]] radiosity::Solution read_or_solve(const std::filesystem::path& file,
                                                  const radiosity::SolutionOrigin& origin,
                                                  StudyCost& cost, StageTimes& times) const;

  const StudyPart& part_;
  const Common& common_;
  const PartCall& how_;
  std::filesystem::path folder_;
  ResultCache store_;
  radiosity::SolveOptions solver_;
  Json scene_cache_key_;
  std::optional<radiosity::Solution> solution_;
};

}  // namespace earthshine::app
