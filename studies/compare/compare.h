// SPDX-License-Identifier: Apache-2.0
// Radiosity against the distributed-light approximation and against direct light alone, in one
// camera's view.
//
// All are measured against a reference that shares nothing with them: the mean of two pictures,
// each of a radiosity solution of its own (patches of half the edge, other random numbers), drawn
// to half the wanted error or, where none is wanted, without denoising and with `reference_factor`
// times the samples. The error is that of all studies (picture_error.h); the variances of the pair
// are not known, as no picture states the noise of its solution.
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
  // Of each picture, as RenderOptions::error; the references are drawn to half of it. 0: fixed
  // numbers of samples.
  double error = 0.0;
  int reference_factor = 4;  // samples of each reference over those of the other pictures
  std::vector<int> distributed_lights = {4, 16, 64, 256};
  std::string
      distributed_over;  // an [[area]]: the Earth's lights over it too; empty: its disc only
  radiosity::SolveOptions solver;
  std::uint64_t seed = 1;
  // Of the whole comparison; 0: none. Pictures end when their share of it is used up, half of the
  // time for the two references; solves are not cut short.
  double time_limit_s = 0.0;
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
  // Noise of both pictures, one standard deviation each; 0 if it was not looked at.
  double ratio_error = 0.0, contrast_error = 0.0;
  bool decided = true;  // no noise of twice that would turn `misleads` round
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
  double solve_cpu_seconds = 0.0, render_cpu_seconds = 0.0;
  PictureError error;      // of reflected_light, over the counted_pixels of the references
  double off_share = 0.0;  // of them, those off by more than misleading_factor
  std::vector<std::optional<TargetDifference>>
      targets;  // as Comparison::targets; none: not in view
  [[nodiscard]] double cpu_seconds() const { return solve_cpu_seconds + render_cpu_seconds; }
};

struct Comparison {
  std::vector<MethodResult> methods;  // as compare_methods lists them
  std::vector<TargetView> targets;    // in the scene's order
  std::vector<bool> target_shines;    // itself a source
  ObjectMap map;
  radiosity::SolveReport solution;  // at the scene's settings
  std::size_t reference_patches = 0;
  double reference_noise = 0.0;      // noise_of_mean: what the reference itself is uncertain by
  std::vector<std::string> stopped;  // methods whose pictures the time limit ended
  bool wide_sources = true;          // anything for distributed lights to stand for
  [[nodiscard]] const MethodResult& reference() const { return methods.front(); }
};

// One picture of it: the settings of method `method`; reference: 0, or 1 or 2 of a reference.
[[nodiscard]] raytrace::RenderOptions compare_picture(const CompareOptions& options,
                                                      const Method& method,
                                                      std::uint64_t reference = 0);

// Without a time limit and seconds apart, the same values for the same options and seed on any number of threads. Throws as
// compare_methods and raytrace::earth_area do.
[[nodiscard]] Comparison compare(const scenes::World& scene, const scenes::Camera& camera,
                                 const CompareOptions& options,
                                 const raytrace::StageListener& listen = {});

// The share of the counted pixels that are off by more than misleading_factor, up or down.
[[nodiscard]] double off_share(const std::vector<float>& luminance,
                               const std::vector<float>& reference,
                               const std::vector<bool>& counted);

[[nodiscard]] TargetDifference target_difference(const TargetLight& light,
                                                 const TargetLight& reference);

// Infinite where only the reference is black, 1 where both are.
[[nodiscard]] double ratio_of(double value, double reference);

// Whether luminance or contrast are off by more than the rule allows.
[[nodiscard]] bool breaks_rule(const TargetDifference& difference);

// Methods, by number, whose error is less than what the reference itself is uncertain by.
[[nodiscard]] std::vector<std::size_t> errors_below_the_references_noise(
    const Comparison& comparison);

// Of the first or second reference: half the edge and four times the patches.
[[nodiscard]] radiosity::SolveOptions reference_solver(radiosity::SolveOptions options,
                                                       std::uint64_t number);

// What the study says of one target. Undecided: the noise of the pictures could turn it round.
enum class ApproximationVerdict { NotInView, Misled, NotMisled, Undecided };
struct TargetVerdict {
  ApproximationVerdict verdict = ApproximationVerdict::NotInView;
  std::string sentence;
};
// The approximation at its best, with the most lights; over the Earth's disc, which is where its
// light comes from. One sentence for each target.
[[nodiscard]] std::vector<TargetVerdict> judge_approximation(const Comparison& comparison);

}  // namespace earthshine::studies
