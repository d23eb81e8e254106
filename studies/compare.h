// SPDX-License-Identifier: Apache-2.0
// Radiosity against the distributed-light approximation and against direct light alone, in one
// camera's view.
//
// All are measured against a reference: the same radiosity solution, gathered with
// `reference_factor` times the rays and other random numbers. Its independence makes the difference
// of the plain radiosity picture the noise floor: what another method differs by less than that
// says nothing. What both share, patch size and form-factor noise, is not in the differences.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "raytrace/render.h"
#include "studies/study.h"
#include "studies/visibility.h"

namespace earthshine::studies {

struct CompareOptions {
  int columns = 512;
  int rows = 512;
  int gather_rays = 256;  // per pixel; without gathering the camera samples that go with them
  int reference_factor = 4;
  std::vector<int> distributed_lights = {4, 16, 64, 256};
  std::string
      distributed_over;  // an [[area]]: the Earth's lights over it too; empty: its disc only
  radiosity::SolveOptions solver;
  std::uint64_t seed = 1;
};

// Of luminance, over the pixels whose centre shows an object: the sky is the same in all pictures.
struct PictureDifference {
  std::size_t pixels = 0;
  double relative_rmse = 0.0;  // sqrt(mean (L - L_ref)^2) / mean L_ref; 0 where all is black
  double bias = 0.0;           // mean (L - L_ref) / mean L_ref
  double off_share = 0.0;      // pixels off by more than misleading_factor
};

// An approximation would have misled about a target when its luminance is off by more than this
// factor, up or down, or its contrast by more than this much.
inline constexpr double misleading_factor = 1.5;
inline constexpr double misleading_contrast = 0.1;

struct TargetDifference {
  TargetLight light;
  double luminance_ratio = 1.0;               // to the reference; infinite where that is black
  std::optional<double> contrast_difference;  // none where either has no contrast
  bool misleads = false;
};

inline constexpr const char* reference_name = "reference";

struct Method {
  std::string name;  // reference_name, "radiosity", "distributed-16", "area-16", "direct"
  raytrace::Indirect indirect = raytrace::Indirect::Radiosity;
  int distributed_lights = 0;         // 0: not that method
  std::string distributed_over = {};  // the [[area]] of "area-16"
};

// What compare() will run, in its order: the reference, radiosity, distributed by rising N, the
// same over the area if there is one, direct. Throws base::Error (Input) if `distributed_lights` is
// empty or holds less than `fewest_lights`: a single light is not distributed, and the renderer
// takes it for the whole source.
inline constexpr int fewest_lights = 2;
[[nodiscard]] std::vector<Method> compare_methods(std::vector<int> distributed_lights,
                                                  const std::string& distributed_over = {});

struct MethodResult {
  Method method;
  raytrace::Frame frame;       // the reference's with the layer "object"
  double solve_seconds = 0.0;  // of the radiosity solution; 0 for methods without
  double render_seconds = 0.0;
  PictureDifference difference;
  std::vector<std::optional<TargetDifference>>
      targets;  // as Comparison::targets; none: not in view
};

struct Comparison {
  std::vector<MethodResult> methods;  // as compare_methods lists them
  std::vector<TargetView> targets;    // in the scene's order
  radiosity::SolveReport solution;
  [[nodiscard]] const MethodResult& reference() const { return methods.front(); }
};

// Seconds apart, the same values for the same options and seed on any number of threads. Throws as
// compare_methods and raytrace::earth_area do.
[[nodiscard]] Comparison compare(const StudyScene& scene, const scenes::Camera& camera,
                                 const CompareOptions& options, const StageListener& listen = {});

// map: which pixels show an object.
[[nodiscard]] PictureDifference picture_difference(const base::Image& image,
                                                   const base::Image& reference,
                                                   const ObjectMap& map);
[[nodiscard]] TargetDifference target_difference(const TargetLight& light,
                                                 const TargetLight& reference);

// What the study says of one target. Undecided: the plain radiosity picture itself breaks the rule,
// so that noise on few pixels could be the reason.
enum class Verdict { NotInView, Misled, NotMisled, Undecided };
struct TargetVerdict {
  Verdict verdict = Verdict::NotInView;
  std::string sentence;
};
// The approximation at its best, with the most lights; over the Earth's disc, which is where its
// light comes from. One sentence for each target.
[[nodiscard]] std::vector<TargetVerdict> judge_approximation(const Comparison& comparison);

}  // namespace earthshine::studies
