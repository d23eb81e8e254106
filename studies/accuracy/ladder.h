// SPDX-License-Identifier: Apache-2.0
// The settings of `study accuracy`: for each method, cheap and coarse ones first.
#pragma once

#include <string>
#include <vector>

#include "raytrace/render.h"
#include "scenes/effects/effects.h"
#include "scenes/scene.h"

namespace earthshine::studies {

// The varied quantity of a series. All other settings are the defaults for the scene.
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
  double setting = 0.0;  // of the varied quantity
  raytrace::Indirect indirect = raytrace::Indirect::Radiosity;
  scenes::Quality quality;  // replaces the scene's keys
  int lights = 0;           // of Indirect::Distributed
  double work = 1.0;        // expected cost, relative to other steps of the series

  [[nodiscard]] std::string name() const;  // "radiosity error=0.05"
  // Whether `render` would adapt the settings until the stated error is reached.
  [[nodiscard]] bool steered() const {
    return quality.error && indirect == raytrace::Indirect::Radiosity;
  }
  // The `earthshine render` options that draw it.
  [[nodiscard]] std::vector<std::string> options() const;
};

struct LadderOptions {
  double finest = 0.01;  // the least wanted error; the ladder goes a little below it
  std::vector<int> lights = {4, 16, 64, 256, 1024};
  std::vector<int> samples = {4, 16, 64, 256};
};

// In running order: the first of every series, the second, and so on. `effects`: of the scene with
// all light. Omits series without effect: patches and form factors without a solution, gather rays
// without gathering, distributed lights without a wide source. Keeps the scene's denoise and
// solver_tolerance.
[[nodiscard]] std::vector<AccuracyStep> accuracy_ladder(const scenes::Scene& scene,
                                                        const scenes::Effects& effects,
                                                        const LadderOptions& options);

// The keys of the scene's [quality] that the ladder replaces.
[[nodiscard]] std::vector<std::string> replaced_keys(const scenes::Quality& quality);

// Predicts the CPU seconds of `step` from the finished ones of its series: the last one's seconds
// times the ratio of the work. If there are none, the least of all finished steps, since a series
// begins with its cheapest step. 0 without any.
struct Taken {
  AccuracyStep step;
  double cpu_seconds = 0.0;
};
[[nodiscard]] double expected_seconds(const AccuracyStep& step, const std::vector<Taken>& taken);

}  // namespace earthshine::studies
