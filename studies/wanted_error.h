// SPDX-License-Identifier: Apache-2.0
// Pictures as exact as wanted: the program chooses patches, rays and samples, measures what is left
// (error_budget.h) and goes on until that is little enough or a limit is met.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenes/quality.h"
#include "studies/error_budget.h"
#include "studies/settings_choice.h"
#include "studies/surface_error.h"

namespace earthshine::studies {

struct Wanted {
  double error = 0.02;               // relative, of what the budget estimates
  double seconds = 0.0;              // since `now` was 0; 0: no limit
  std::function<double()> now = {};  // seconds so far
  std::function<bool(double patches, int rays)> fits = {};  // into memory; empty: anything does
};

// What stopped it before the wanted error.
enum class Limit { None, Time, Memory, Settings, Steps };
[[nodiscard]] std::string limit_name(Limit limit);

// One try: what was chosen and what came of it.
struct Step {
  std::string stage;  // "solve", "trial picture", "picture"
  std::size_t patches = 0;
  int form_factor_rays = 0;
  int gather_rays = 0;
  double asked = 0.0;     // relative error that the settings were meant for
  double estimate = 0.0;  // found
};

// A picture drawn to see what its noise costs.
struct Trial {
  NoiseSetting setting;
  NoiseFound found;  // nothing: there was none
};

struct SteeredSolution {
  radiosity::Solution solution;
  radiosity::SolveOptions solver;  // of the last solve
  SecondOpinion opinion;           // for pictures
  SurfaceError surface;            // without pictures
  std::vector<Trial> trials;       // a small one of each picture
  std::vector<Step> steps;
  Limit limit = Limit::None;
};

// Called before each solve; gives the listener for what the solve takes, which may be empty.
using SolveListener = std::function<void(const radiosity::SolveReport&)>;

// Solves until what the pictures owe to the solution leaves room for their own noise; `pictures`
// have the options for the wanted error but for gather rays and noise. Without pictures until the
// surfaces' own error is small enough. Settings that the scene names stay as they are.
[[nodiscard]] SteeredSolution reach_solution(const StudyScene& scene, const Wanted& wanted,
                                             std::uint64_t seed,
                                             const std::vector<WatchedPicture>& pictures,
                                             const SolveListener& listen = {});

struct SteeredPicture {
  raytrace::Frame frame;
  raytrace::RenderOptions options;  // of the last try
  ErrorBudget budget;
  std::vector<Step> steps;
  Limit limit = Limit::None;
};

// Draws the picture, and pictures by other random numbers to blend with it, until its budget's
// estimate is within the wanted error. A crop is drawn once,
// with the settings that the whole picture starts with, so that it has the same pixels.
[[nodiscard]] SteeredPicture reach_picture(const StudyScene& scene, const Wanted& wanted,
                                           const radiosity::Solution& solution,
                                           const WatchedErrors& errors,
                                           const WatchedPicture& picture, const Trial& trial,
                                           const raytrace::Progress& progress = {});

// The options of a picture for a noise: gather rays, how far they are shared, camera samples.
[[nodiscard]] raytrace::RenderOptions with_noise(const raytrace::RenderOptions& options,
                                                 const scenes::Scene& scene,
                                                 const NoiseSetting& setting);
[[nodiscard]] NoiseFound noise_found(const raytrace::RenderReport& report, const Doubt& gather,
                                     const Doubt& samples);

}  // namespace earthshine::studies
