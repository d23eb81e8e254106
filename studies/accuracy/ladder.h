// SPDX-License-Identifier: Apache-2.0
// The settings that `study accuracy` runs through: cheap and coarse ones first, for each method.
#pragma once

#include <string>
#include <vector>

#include "raytrace/render.h"
#include "scenes/effects/effects.h"
#include "scenes/scene.h"

namespace earthshine::studies {

// What a series varies. All else is as a scene has it that says nothing of quality.
namespace series {
inline constexpr const char* error = "error";         // all together, by --error
inline constexpr const char* patches = "patch_edge";  // even patches, m
inline constexpr const char* form_factor_rays = "form_factor_rays";
inline constexpr const char* gather_rays = "gather_rays";
inline constexpr const char* camera_samples = "camera_samples";
inline constexpr const char* lights = "distributed_lights";
inline constexpr const char* samples = "samples";
}  // namespace series

struct AccuracyStep {
  std::string method;  // "radiosity", "direct", "distributed" or "paths"
  std::string series;
  double setting = 0.0;  // of what is varied
  raytrace::Indirect indirect = raytrace::Indirect::Radiosity;
  scenes::Quality quality;  // what the scene's keys are replaced by
  int lights = 0;           // of Indirect::Distributed
  double work = 1.0;        // what it is expected to cost, against others of its series

  [[nodiscard]] std::string name() const;  // "radiosity error=0.05"
  // Whether `render` would choose settings until the picture says that it is as exact.
  [[nodiscard]] bool steered() const {
    return quality.error && indirect == raytrace::Indirect::Radiosity;
  }
  // The words that make `earthshine render` draw it.
  [[nodiscard]] std::vector<std::string> options() const;
};

struct LadderOptions {
  double finest = 0.01;  // the least wanted error; the ladder goes a little below it
  std::vector<int> lights = {4, 16, 64, 256, 1024};
  std::vector<int> samples = {4, 16, 64, 256};
};

// In the order in which they are run: the first of every series, the second ... `effects`: of the
// scene with all light. Series that have nothing to vary are left out: patches and form factors
// where nothing is solved for, gather rays where there are none, distributed lights where no source
// is wide. What else the scene says of quality stays: denoise, solver_tolerance.
[[nodiscard]] std::vector<AccuracyStep> accuracy_ladder(const scenes::Scene& scene,
                                                        const scenes::Effects& effects,
                                                        const LadderOptions& options);

// The keys of the scene's [quality] that the ladder replaces.
[[nodiscard]] std::vector<std::string> replaced_keys(const scenes::Quality& quality);

// CPU seconds that `step` will take, from those of its series that were run: the last one's times
// the ratio of the work; where its series has none, the least of all: it begins with its cheapest.
// 0 where there are none at all.
struct Taken {
  AccuracyStep step;
  double cpu_seconds = 0.0;
};
[[nodiscard]] double expected_seconds(const AccuracyStep& step, const std::vector<Taken>& taken);

}  // namespace earthshine::studies
