// SPDX-License-Identifier: Apache-2.0
// Compares radiosity, the distributed-light approximation and direct light in one camera's view.
//
// All are measured against an independent reference, the mean of two pictures. Each picture has a
// separate radiosity solution (patches of half the edge, other random numbers). It is drawn to half
// the wanted error or, without one, with `reference_factor` times the samples and without
// denoising. The error is computed as in all studies (picture_error.h). The variances of the pair
// are unknown, because no picture states the noise of its solution.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "raytrace/render.h"
#include "studies/picture_error.h"
#include "studies/targets/target_light.h"

namespace earthshine::studies {

struct CompareOptions {
  int columns = 512;
  int rows = 512;
  int gather_rays = 32, camera_samples = 16;  // per pixel
  // Wanted error of each picture, as in RenderOptions::error; half of it for the references. 0:
  // fixed numbers of samples.
  double error = 0.0;
  int reference_factor = 4;  // samples of each reference over those of the other pictures
  std::vector<int> distributed_lights = {4, 16, 64, 256};
  std::string
      distributed_over;  // an [[area]], which also gets the Earth's lights; empty: only its disc
  radiosity::SolveOptions solver;
  std::uint64_t seed = 1;
  // Of the whole comparison; 0: none. Pictures end when their share of it is used up, half of the
  // time for the two references; solves are not cut short.
  double time_limit_s = 0.0;
};

// An approximation is misleading for a target if its luminance is wrong by more than this factor,
// up or down, or its contrast by more than this difference.
inline constexpr double misleading_factor = 1.5;
inline constexpr double misleading_contrast = 0.1;

struct TargetDifference {
  TargetLight light;
  double luminance_ratio = 1.0;               // to the reference; infinite if that is black
  std::optional<double> contrast_difference;  // empty if either has no contrast
  bool misleads = false;
  // Noise of both pictures, one standard deviation each; 0 if not computed.
  double ratio_error = 0.0, contrast_error = 0.0;
  bool decided = true;  // twice the noise would not change `misleads`
};

inline constexpr const char* reference_name = "reference";

struct Method {
  std::string name;  // reference_name, "radiosity", "distributed-16", "area-16", "direct"
  raytrace::Indirect indirect = raytrace::Indirect::Radiosity;
  int distributed_lights = 0;         // 0: not that method
  std::string distributed_over = {};  // the [[area]] of "area-16"
};

// The methods of compare(), in its order: the reference, radiosity, distributed by rising N,
// distributed over the area if there is one, direct. Throws base::Error (Input) if
// `distributed_lights` is empty or has a value below `fewest_lights`: the renderer samples a single
// light as the whole source.
inline constexpr int fewest_lights = 2;
[[nodiscard]] std::vector<Method> compare_methods(std::vector<int> distributed_lights,
                                                  const std::string& distributed_over = {});

struct MethodResult {
  Method method;
  raytrace::Frame frame;       // with the layer "object" in the reference
  double solve_seconds = 0.0;  // of the radiosity solution; 0 for methods without
  double render_seconds = 0.0;
  double solve_cpu_seconds = 0.0, render_cpu_seconds = 0.0;
  PictureError error;      // of reflected_light, over the counted_pixels of the references
  double off_share = 0.0;  // share of these pixels with an error above misleading_factor
  std::vector<std::optional<TargetDifference>>
      targets;  // as Comparison::targets; empty: not in view
  [[nodiscard]] double cpu_seconds() const { return solve_cpu_seconds + render_cpu_seconds; }
};

struct Comparison {
  std::vector<MethodResult> methods;  // in the order of compare_methods
  std::vector<TargetView> targets;    // in the scene's order
  std::vector<bool> target_shines;    // whether it is a source
  ObjectMap map;
  radiosity::SolveReport solution;  // at the scene's settings
  std::size_t reference_patches = 0;
  double reference_noise = 0.0;      // noise_of_mean() of the reference
  std::vector<std::string> stopped;  // methods whose pictures reached the time limit
  bool wide_sources = true;          // a source that distributed lights approximate
  [[nodiscard]] const MethodResult& reference() const { return methods.front(); }
};

// One picture of it: the settings of method `method`; reference: 0, or 1 or 2 of a reference.
[[nodiscard]] raytrace::RenderOptions compare_picture(const CompareOptions& options,
                                                      const Method& method,
                                                      std::uint64_t reference = 0);

// Without a time limit the values depend on options and seed only, not on the number of threads
// (except for seconds). Throws as compare_methods and raytrace::earth_area do.
[[nodiscard]] Comparison compare(const scenes::World& scene, const scenes::Camera& camera,
                                 const CompareOptions& options,
                                 const raytrace::StageListener& listen = {});

// Share of the counted pixels with an error above misleading_factor, up or down.
[[nodiscard]] double off_share(const std::vector<float>& luminance,
                               const std::vector<float>& reference,
                               const std::vector<bool>& counted);

[[nodiscard]] TargetDifference target_difference(const TargetLight& light,
                                                 const TargetLight& reference);

// Infinite if only the reference is black, 1 if both are.
[[nodiscard]] double ratio_of(double value, double reference);

// Whether luminance or contrast differ by more than the rule allows.
[[nodiscard]] bool breaks_rule(const TargetDifference& difference);

// Methods, by number, whose error is less than the reference's noise.
[[nodiscard]] std::vector<std::size_t> errors_below_the_references_noise(
    const Comparison& comparison);

// For the first or second reference: half the edge and four times the patches.
[[nodiscard]] radiosity::SolveOptions reference_solver(radiosity::SolveOptions options,
                                                       std::uint64_t number);

// The study's verdict for one target. Undecided: noise of the pictures could change it.
enum class ApproximationVerdict { NotInView, Misled, NotMisled, Undecided };
struct TargetVerdict {
  ApproximationVerdict verdict = ApproximationVerdict::NotInView;
  std::string sentence;
};
// For the best approximation, with the most lights, over the Earth's disc, where its light comes
// from. One sentence per target.
[[nodiscard]] std::vector<TargetVerdict> judge_approximation(const Comparison& comparison);

}  // namespace earthshine::studies
