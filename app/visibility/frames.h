// SPDX-License-Identifier: Apache-2.0
// The costly work of a visibility study, done once per scene and camera and kept in the study's
// folder: the radiosity solution of all light groups, and a picture with a layer for each.
#pragma once

#include <functional>

#include "app/parts/result_cache.h"
#include "app/visibility/scene.h"
#include "studies/study.h"

namespace earthshine::app {

// What was done or found, for the report.
struct StudyCost {
  std::string stage;
  double seconds = 0.0;  // of the run that did it
  std::uint64_t rays = 0;
  bool found = false;  // in the folder, from an earlier run
};

class StudyFrames {
 public:
  StudyFrames(const StudyPart& part, const std::filesystem::path& folder, const Common& common);

  // The picture of a camera, with the layer "object"; nothing if it was interrupted.
  struct Frame {
    base::Image image;
    double relative_noise = 0.0;
    double seconds = 0.0;
    std::size_t patches = 0;  // of the solution it was drawn from
  };
  [[nodiscard]] std::optional<Frame> frame(const StudyCamera& camera,
                                           std::vector<StudyCost>& costs);

  // Everything that a camera's picture depends on.
  [[nodiscard]] Json cache_key(const StudyCamera& camera) const;
  // What is known of a picture that is there, without reading it.
  [[nodiscard]] std::optional<Frame> known(const StudyCamera& camera,
                                           std::vector<StudyCost>& costs) const;
  [[nodiscard]] bool has(const StudyCamera& camera) const { return store_.has(cache_key(camera)); }

  // Of all light groups; solved or read when it is first asked for.
  [[nodiscard]] const radiosity::Solution& solution(std::vector<StudyCost>& costs);

 private:
  [[nodiscard]] raytrace::RenderOptions options(const StudyCamera& camera) const;

  const StudyPart& part_;
  const Common& common_;
  std::filesystem::path folder_;
  ResultCache store_;
  radiosity::SolveOptions solver_;
  Json scene_cache_key_;
  std::optional<radiosity::Solution> solution_;
};

}  // namespace earthshine::app
