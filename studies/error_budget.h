// SPDX-License-Identifier: Apache-2.0
// The error of a picture, part by part: measured on the picture itself, not taken from laws.
//
// An error is the root mean square difference of luminance to the picture that more rays, samples
// and patches would lead to, over the pixels that show a surface and no source itself, relative to
// their mean luminance; pixels brighter than four times that count in proportion (error_weight).
// What no setting would bring is no part of it; it is named instead.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "studies/solution_error.h"

namespace earthshine::studies {

struct ErrorParts {
  Doubt form_factor_noise;
  Doubt patch_size;
  Doubt solver_residual;
  Doubt gather_noise;    // rays over the hemisphere, and what sharing them blurs
  Doubt lamp_sampling;   // where on a source shadow rays end, which lamps, lobes
  Doubt camera_samples;  // edges, the lens
  [[nodiscard]] Doubt total() const;
};

struct TargetError {
  std::string name;
  std::size_t pixels = 0;  // seen
  double luminance = 0.0;  // their mean, cd/m^2
  Doubt error;             // as of the whole picture, over the target's pixels and their mean
};

struct ErrorBudget {
  ErrorParts parts;
  std::size_t pixels = 0;  // that the errors are over; 0: no surface is seen or all are black
  std::vector<TargetError> targets;
  std::vector<std::string> not_captured;
  std::uint64_t rays = 0;  // cast to find all that out
  double seconds = 0.0;
};

// A picture's part of the second looks at a solution.
struct WatchedPicture {
  const scenes::Camera* camera = nullptr;
  raytrace::RenderOptions options;
};

// What pictures owe to the solution, before they are drawn.
struct WatchedErrors {
  SolutionError whole;
  std::map<std::uint32_t, SolutionError> targets;  // by object
};
struct SecondOpinion {
  std::vector<WatchedErrors> pictures;
  radiosity::SecondLooks looks;
  std::uint64_t rays = 0;
  double seconds = 0.0;
};
// Solves the scene again (radiosity/second_looks.h) and looks at some thousand pixels of each
// picture. Without light, surfaces or a solution all is zero.
[[nodiscard]] SecondOpinion second_opinion(const StudyScene& scene,
                                           const radiosity::Solution& solution,
                                           const radiosity::SolveOptions& solver,
                                           const std::vector<WatchedPicture>& pictures);

// The noise is measured too, where render() drew the picture: some hundred pixels, more of them
// where the picture says that it is noisy, are found twice more by independent rays without
// sharing. (L - O1)(L - O2) is on average the squared error of L.
[[nodiscard]] ErrorBudget error_budget(const StudyScene& scene, const WatchedErrors& solution,
                                       const radiosity::Solution& read,
                                       const WatchedPicture& picture, const raytrace::Frame& frame);

// Light that no setting brings into a picture drawn so.
[[nodiscard]] std::vector<std::string> not_captured(const StudyScene& scene,
                                                    const raytrace::RenderOptions& options);

}  // namespace earthshine::studies
