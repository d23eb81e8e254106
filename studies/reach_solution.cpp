// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "studies/measured_noise.h"
#include "studies/wanted_error.h"

namespace earthshine::studies {
namespace {

constexpr int most_solves = 5;
constexpr double no_better = 0.95;  // of the error before: more of the same will not help
// The first solve is coarser than the laws of scenes/quality.h ask for: they err on the safe side.
constexpr double first_patches = 1.5;  // times the wanted error
constexpr int first_rays_divisor = 4, fewest_first_rays = 64;
// Of the wanted error: estimates have errors themselves, and another solve costs as much again.
constexpr double aim = 0.9, surface_aim = 0.75;
constexpr double trial_pixels = 9216.0;
constexpr double usual_rays_per_pixel = 100.0;
constexpr double share_of_time = 0.5;  // for the solution

class SolutionSearch {
 public:
  SolutionSearch(const StudyScene& scene, const Wanted& wanted, std::uint64_t seed,
                 const std::vector<WatchedPicture>& pictures, const SolveListener& listen)
      : scene_(scene),
        wanted_(wanted),
        seed_(seed),
        pictures_(pictures),
        listen_(listen),
        given_(scene.scene.quality) {}

  SteeredSolution run() {
    solve(first_options());
    find_trials();
    while (true) {
      const SettingsChoice choice = choose_settings(state(), rules());
      if (is_enough() || choice.keeps) {
        if (!is_enough() && !choice.reached) result_.limit = why_not();
        break;
      }
      if (solves_ == most_solves) {
        result_.limit = Limit::Steps;
        break;
      }
      if (out_of_time(choice)) {
        result_.limit = Limit::Time;
        break;
      }
      radiosity::SolveOptions options = result_.solver;
      options.form_factor_rays = choice.rays;
      if (choice.patches > state().patches) {
        options.refine.error = choice.refine_error;
        options.refine.max_patches =
            std::max(options.refine.max_patches, static_cast<std::size_t>(2.0 * choice.patches));
      }
      const double patches = state().patches, before = worst().total().estimate;
      solve(options);
      if (!is_enough() && worst().total().estimate > no_better * before) {
        result_.limit = Limit::Steps;
        break;
      }
      // Nothing left to cut that is not noise.
      cut_out_ = choice.patches > 1.1 * patches && state().patches < 1.05 * patches;
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool may_cut() const {
    return !cut_out_ && result_.solver.refine.on && !given_.max_patches && !given_.patch_edge_m;
  }
  [[nodiscard]] bool may_cast() const { return !given_.form_factor_rays; }

  radiosity::SolveOptions first_options() {
    scenes::Quality coarse = given_;
    coarse.error = std::min(1.0, first_patches * wanted_.error);
    radiosity::SolveOptions options =
        radiosity::solve_options(scenes::resolve_quality(scene_.scene, coarse), seed_);
    if (may_cast()) {
      scenes::Quality as_wanted = given_;
      as_wanted.error = wanted_.error;
      const int rays = scenes::resolve_quality(scene_.scene, as_wanted).form_factor_rays;
      options.form_factor_rays = std::max(fewest_first_rays, rays / first_rays_divisor);
    }
    return options;
  }

  void solve(const radiosity::SolveOptions& options) {
    const double before = seconds();
    ++solves_;
    result_.solver = options;
    result_.solution =
        radiosity::solve(scene_.scene, scene_.groups, scene_.effects, scene_.query, options);
    if (listen_) listen_(result_.solution.report);
    if (pictures_.empty()) {
      result_.surface = surface_error(scene_, result_.solution, options);
    } else {
      result_.opinion = second_opinion(scene_, result_.solution, options, pictures_);
    }
    solve_seconds_ = seconds() - before;
    Step step;
    step.stage = "solve";
    step.patches = result_.solution.patches.count();
    step.form_factor_rays = options.form_factor_rays;
    step.asked = wanted_.error;
    step.estimate = worst().total().estimate;
    result_.steps.push_back(step);
  }

  // Surfaces have nothing else to spend on.
  [[nodiscard]] bool is_enough() const {
    return pictures_.empty() && worst().total().estimate <= wanted_.error;
  }

  // Of all pictures.
  [[nodiscard]] SolutionError worst() const {
    if (pictures_.empty()) return result_.surface.parts;
    SolutionError worst;
    for (const WatchedErrors& picture : result_.opinion.pictures) {
      if (picture.whole.total().estimate >= worst.total().estimate) worst = picture.whole;
    }
    return worst;
  }

  [[nodiscard]] SolveState state() const {
    const SolutionError parts = worst();
    SolveState state;
    const auto& report = result_.solution.report;
    state.refine_error =
        report.rounds.empty() ? result_.solver.refine.error : report.rounds.back().error;
    state.patches = static_cast<double>(std::max<std::size_t>(1, report.patches));
    state.rays = result_.solver.form_factor_rays;
    state.patch_error = parts.patches.estimate;
    state.ray_error = parts.form_factors.estimate;
    state.other_error = std::hypot(parts.lamps.estimate, parts.solver.estimate);
    return state;
  }

  [[nodiscard]] ChoiceRules rules() const {
    ChoiceRules rules;
    rules.wanted = (pictures_.empty() ? surface_aim : aim) * wanted_.error;
    rules.may_cut = may_cut();
    rules.may_cast = may_cast();
    const auto& report = result_.solution.report;
    rules.rays_per_patch_cut = static_cast<double>(report.refinement_rays) /
                               static_cast<double>(std::max<std::size_t>(1, report.patches));
    rules.picture_rays = trial_rays_;
    rules.picture_noise = trial_noise_;
    rules.fits = wanted_.fits;
    return rules;
  }

  // Small pictures, to know what noise costs. A picture that is hardly larger tells as much itself.
  void find_trials() {
    for (const WatchedPicture& picture : pictures_) {
      const NoiseSetting setting{wanted_.error, wanted_.error};
      WatchedPicture trial{picture.camera, with_noise(picture.options, scene_.scene, setting)};
      trial.options.crop = {};
      const double pixels = double(trial.options.columns) * trial.options.rows;
      const double scale = std::sqrt(std::min(1.0, trial_pixels / pixels));
      result_.trials.push_back({setting, {}});
      if (4.0 * trial_pixels > pixels) {
        trial_rays_ += pixels * usual_rays_per_pixel;
        trial_noise_ = std::max(trial_noise_, wanted_.error);
        continue;
      }
      trial.options.columns = std::max(1, static_cast<int>(scale * trial.options.columns));
      trial.options.rows = std::max(1, static_cast<int>(scale * trial.options.rows));
      const raytrace::Frame frame =
          raytrace::render(scene_.scene, scene_.groups, scene_.effects, scene_.query,
                           result_.solution, *trial.camera, trial.options);
      const SurfacePixels seen(scene_, *trial.camera, trial.options);
      const MeasuredNoise noise = measure_noise(scene_, result_.solution, trial, frame, seen);
      // Edges take a share of the pixels that goes with the inverse of the picture's size.
      Doubt samples = noise.lamps + noise.camera;
      samples.estimate *= std::sqrt(scale);
      result_.trials.back().found = noise_found(frame.report, noise.gather, samples);
      const double found = std::hypot(noise.gather.estimate, samples.estimate);
      trial_rays_ += static_cast<double>(frame.report.rays.total()) / (scale * scale);
      trial_noise_ = std::max(trial_noise_, found);
      Step step;
      step.stage = "trial picture";
      step.gather_rays = frame.report.gather_rays;
      step.asked = wanted_.error;
      step.estimate = found;
      result_.steps.push_back(step);
    }
  }

  [[nodiscard]] Limit why_not() const {
    if (!may_cut() && !may_cast()) return Limit::Settings;
    ChoiceRules free = rules();
    free.fits = {};
    if (wanted_.fits && !choose_settings(state(), free).keeps) return Limit::Memory;
    return Limit::Settings;
  }

  [[nodiscard]] double seconds() const { return wanted_.now ? wanted_.now() : 0.0; }
  [[nodiscard]] bool out_of_time(const SettingsChoice& choice) const {
    if (wanted_.seconds <= 0.0) return false;
    const SolveState now = state();
    const double more = choice.patches * choice.rays / (now.patches * now.rays);
    const double share = pictures_.empty() ? 1.0 : share_of_time;
    return seconds() + more * solve_seconds_ > share * wanted_.seconds;
  }

  const StudyScene& scene_;
  const Wanted& wanted_;
  std::uint64_t seed_;
  const std::vector<WatchedPicture>& pictures_;
  const SolveListener& listen_;
  const scenes::Quality& given_;
  SteeredSolution result_;
  double trial_rays_ = 0.0, trial_noise_ = 0.0, solve_seconds_ = 0.0;
  int solves_ = 0;
  bool cut_out_ = false;
};

}  // namespace

SteeredSolution reach_solution(const StudyScene& scene, const Wanted& wanted, std::uint64_t seed,
                               const std::vector<WatchedPicture>& pictures,
                               const SolveListener& listen) {
  return SolutionSearch(scene, wanted, seed, pictures, listen).run();
}

}  // namespace earthshine::studies
