// SPDX-License-Identifier: Apache-2.0
#include "raytrace/solve_control/reach_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/units.h"
#include "radiosity/fill_solution.h"
#include "radiosity/near_lamps.h"
#include "raytrace/light/uncaught_light.h"
#include "raytrace/solve_control/surface_rounds.h"
#include "raytrace/surfaces/residual_error.h"
#include "scenes/text/message_text.h"

namespace earthshine::raytrace {
namespace {

// Fractions of the wanted error: target of sampling; target of dividing patches, of which samples
// see only a part
constexpr double aim = 0.85, cut_aim = 0.25;
// Assumed at first; fraction of the stated error that a pass aims at by dividing
constexpr double first_error = 0.15, next_error = 0.2;
constexpr double noise_share = 0.4;  // share of the wanted squared error for ray noise
constexpr std::uint64_t many_rays = std::uint64_t{1} << 28;
constexpr double most_growth = 4.0;                        // of the rays from pass to pass
constexpr double cut_share = 0.6;                          // of squared error, for unevenness
constexpr std::size_t largest_cut = std::size_t{1} << 21;  // patches
constexpr int most_idle = 2;                               // passes; one may be bad by chance
constexpr double next_pass = 1.2;                          // duration, over the previous pass
constexpr double more_points_share = 0.5;                  // of a time limit: no more points
constexpr double fewest_points = 8192.0, most_points = 1 << 20;
constexpr double most_standard_error = 0.3;  // of the squared error, over the wanted squared error

constexpr int coarse_rays = 64;
constexpr double coarse_error = 0.2;  // target of the first patches

class SurfaceSearch {
 public:
  SurfaceSearch(const scenes::World& scene, const Wanted& wanted, std::uint64_t seed,
                const SolveListener& listen, const StageListener& progress)
      : scene_(scene),
        wanted_(wanted),
        given_(scene.scene.quality),
        listen_(listen),
        progress_(over_passes(progress)) {
    result_.solver = first_surface_options(scene.scene, wanted.error, seed);
    result_.surface.known = false;
    solve(seed);
  }

  SteeredSolution run() {
    if (!light_) return std::move(result_);
    rounds_->set_mean(light_->mean_on_all_ranks());
    try {
      if (rounds_->mean() <= 0.0) rounds_->find_light();
      if (rounds_->mean() > 0.0) {
        std::vector<std::uint32_t> parent(light_->patches().count());
        if (may_cut()) rounds_->cut_shadows(cut_share * enough(), parent);
        improve();
        if (may_cast() && is_exact()) return with_exact_form_factors();
      }
    } catch (const base::Stopped&) {
      stop(Limit::Stopped);
    }
    auto [solution, ledger_defect] = light_->finished();
    result_.solution = std::move(solution);
    result_.solution.report.shadow_rays += rounds_->rays();
    hold_to_ledger(ledger_defect);
    return std::move(result_);
  }

 private:
  // Reports of a pass as those of all passes, which cost about the same.
  [[nodiscard]] StageListener over_passes(const StageListener& stage) const {
    if (!stage) return {};
    return [this, &stage](const std::string& name) -> Progress {
      return [this, of_pass = stage(name)](std::size_t done, std::size_t total) {
        if (!of_pass || total == 0) return;
        const std::size_t before = parts_of_a_pass * result_.steps.size();
        of_pass(before + parts_of_a_pass * done / total, before + parts_of_a_pass * passes_to_go());
      };
    };
  }
  // A pass divides the error by about 1.5.
  [[nodiscard]] std::size_t passes_to_go() const {
    constexpr double each = 1.5;
    const double now = result_.steps.empty() ? first_error : result_.steps.back().estimate;
    const double passes = std::log(std::max(1.0, now / wanted_.error)) / std::log(each);
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(passes)));
  }
  // Light that no ray finds, such as a small spot near a lamp that is only visible in mirrors, is
  // missing from all samples alike. The ledger's defect then is a lower bound of the error.
  void hold_to_ledger(double ledger_defect) {
    const double stated = result_.surface.parts.total().estimate;
    if (result_.steps.empty() || ledger_defect <= stated) return;
    const double more = std::sqrt(base::squared(ledger_defect) - base::squared(stated));
    result_.surface.parts.form_factors =
        result_.surface.parts.form_factors + ErrorEstimate{more, more};
    result_.steps.back().estimate = ledger_defect;
    if (ledger_defect > wanted_.error && result_.limit == Limit::None) stop(Limit::Ledger);
  }

  // If ranks divide the form factors, the root rank decides, and all ranks sample.
  [[nodiscard]] bool is_root() const { return light_->shares().is_root(); }
  [[nodiscard]] bool may_cut() const { return cuts_surfaces(given_); }
  [[nodiscard]] bool may_cast() const { return !given_.form_factor_rays; }
  // Whether shadow rays alone lit all reflecting surfaces, and evenly.
  [[nodiscard]] bool is_exact() const {
    return result_.steps.size() == 1 && result_.steps.back().estimate == 0.0 &&
           light_->patches().count() == first_patches_;
  }
  // The light on black surfaces still has the accuracy of the form factors: repeats the solve with
  // the number of rays for the wanted error.
  SteeredSolution with_exact_form_factors() {
    if (const Progress progress = stage("solve")) progress(0, 1);
    radiosity::SolveOptions solver = result_.solver;
    solver.form_factor_rays = scenes::resolve_quality(scene_.scene).form_factor_rays;
    const base::StopInForce stop(wanted_.stop);
    result_.solution = radiosity::solve(scene_, solver);
    result_.solver = solver;
    result_.steps.back().form_factor_rays = solver.form_factor_rays;
    if (listen_) listen_(result_.solution.report);
    result_.solution.report.shadow_rays += rounds_->rays();
    return std::move(result_);
  }

  void solve(std::uint64_t seed) {
    const Progress progress = stage("solve");
    if (progress) progress(0, 1);
    radiosity::Patches patches =
        radiosity::subdivide_near_lamps(scene_.scene, result_.solver.patch_edge_m);
    radiosity::FormFactors factors;
    radiosity::Solution coarse =
        radiosity::solve_keeping(scene_, result_.solver, std::move(patches), {}, factors);
    if (listen_) listen_(coarse.report);
    if (coarse.columns == 0 || coarse.patches.count() == 0) {
      result_.solution = std::move(coarse);
      return;
    }
    first_patches_ = coarse.patches.count();
    bound_ = patch_bound(wanted_, given_, first_patches_, largest_cut);
    solver_error_ = coarse.report.solver_error;
    light_.emplace(scene_, std::move(coarse), std::move(factors), result_.solver.form_factor_rays);
    rounds_.emplace(scene_, wanted_, seed, *light_, bound_.most, progress_);
  }

  void improve() {
    double before = 0.0;
    int idle = 0;  // passes in a row without division or progress
    SurfaceRefiner choice(light_->patches(), light_->light().spot_m2);
    std::vector<SampleBudget> budget = even_budget(*light_, points_wanted_);
    double pass_begun = time_gone();
    for (int pass = 0;; ++pass) {
      std::vector<std::uint32_t> all(light_->patches().count());
      std::iota(all.begin(), all.end(), 0U);
      const double begun = time_gone();
      const SurfaceSamples samples = rounds_->sample(
          all, budget, stage_text(), may_cast() ? SamplesOf::Light : SamplesOf::Residual);
      last_took_ = time_gone() - begun;
      std::vector<double> variance;
      LightNoise noise;
      if (is_root()) {
        variance = ray_variance(light_->patches(), samples, all, budget);
        noise = noise_of(*light_, variance, samples);
      }
      const ResidualError found =
          residual_error(*light_, samples, noise, rounds_->reflectances(), solver_error_);
      state(found, samples, budget);
      const double error = result_.steps.back().estimate;
      if (error <= wanted_.error && is_sure(found)) return;
      if (!may_cut() && !may_cast()) return stop(Limit::Settings);
      passes_.push_back({double(rounds_->rays()), error});
      if (wanted_.seconds <= 0.0 && rounds_->rays() > many_rays &&
          is_far_off(passes_, wanted_.error)) {
        return stop(why_no_more());
      }
      const double gone = time_gone();
      if (gone + next_pass * (gone - pass_begun) > 1.0) return stop(Limit::Time);
      pass_begun = gone;
      rounds_->set_mean(found.mean);
      if (is_root()) choice.see(light_->patches(), samples, all, noise.all());
      if (may_cast()) light_->correct(samples, all, budget);
      if (found.standard_error > most_standard_error * base::squared(wanted_.error))
        points_wanted_ *= 2.0;
      bool cuts = false;
      std::vector<std::uint32_t> parent = std::move(all);
      if (may_cut() && found.patches > 0.8 * cut_share * base::squared(aim * wanted_.error)) {
        cuts = rounds_->cut_gathered(choice, cut_share * enough(), points_wanted_, parent);
        if (rounds_->cut_shadows(cut_share * enough(), parent, &choice)) cuts = true;
      }
      idle = cuts || error <= std::max(wanted_.error, 0.97 * before) ? 0 : idle + 1;
      if (idle >= most_idle && pass > 4) return stop(why_no_more());
      before = error;
      const double target = noise_share * base::squared(aim * wanted_.error * rounds_->mean());
      if (is_root()) budget = next_budget(variance, parent, target);
      light_->shares().broadcast([&](base::Parcel& parcel) { parcel.pass(budget); });
    }
  }

  // Few points may miss an error in small places: uses more points, up to a million, as long as
  // there is time.
  [[nodiscard]] bool is_sure(const ResidualError& found) const {
    return found.square + found.standard_error <=
               (1.0 + most_standard_error) * base::squared(wanted_.error) ||
           points_wanted_ >= most_points || time_gone() > more_points_share ||
           !(may_cut() || may_cast());
  }

  // Mean square at which the next pass stops dividing patches: at least the square of a fifth of
  // the stated error, because patches that are divided for shadows cost rays of all other light,
  // too.
  [[nodiscard]] double enough() const {
    const double now = result_.steps.empty() ? first_error : result_.steps.back().estimate;
    return base::squared(std::max(cut_aim * wanted_.error, next_error * now) * rounds_->mean());
  }

  // At most four times the rays of the previous pass, or as many as the remaining time allows.
  [[nodiscard]] std::vector<SampleBudget> next_budget(const std::vector<double>& variance,
                                                      const std::vector<std::uint32_t>& parent,
                                                      double target) const {
    double most = std::max(most_growth * last_rays_, double(1 << 20));
    if (last_took_ > 0.0) most = std::min(most, last_rays_ * (1.0 - time_gone()) / last_took_);
    return budget_for(*light_, variance, parent, target, most, points_wanted_);
  }

  void state(const ResidualError& found, const SurfaceSamples& samples,
             const std::vector<SampleBudget>& budget) {
    result_.surface.parts = found.parts;
    result_.surface.unweighted = found.unweighted;
    result_.surface.known = found.mean > 0.0;
    result_.surface.rays += samples.rays;
    last_rays_ = 0.0;
    for (const SampleBudget& e : budget) last_rays_ += e.all_rays();
    result_.steps.push_back({"solve", light_->patches().count(),
                             static_cast<int>(last_rays_ / static_cast<double>(budget.size())), 0,
                             wanted_.error, found.parts.total().estimate});
  }

  // Divisions cause divisions of neighbours: the last few patches may be out of reach.
  [[nodiscard]] Limit why_no_more() const {
    return 64 * light_->patches().count() >= 63 * bound_.most ? bound_.of : Limit::Steps;
  }

  void stop(Limit limit) { result_.limit = limit; }
  // Elapsed share of the time limit; 0 without a limit.
  [[nodiscard]] double time_gone() const {
    return wanted_.seconds > 0.0 && wanted_.now ? wanted_.now() / wanted_.seconds : 0.0;
  }
  [[nodiscard]] Progress stage(const std::string& name) const {
    return progress_ ? progress_(name) : Progress();
  }
  [[nodiscard]] std::string stage_text() const {
    if (result_.steps.empty()) return fmt::format("{} patches", light_->patches().count());
    return fmt::format("{} patches, error {} of {} wanted", light_->patches().count(),
                       scenes::percent(result_.steps.back().estimate),
                       scenes::percent(wanted_.error));
  }

  const scenes::World scene_;
  const Wanted& wanted_;
  const scenes::Quality& given_;
  const SolveListener& listen_;
  const StageListener progress_;
  SteeredSolution result_;
  std::optional<LightOnSurfaces> light_;
  std::optional<SurfaceRounds> rounds_;  // exists if light_ does
  double solver_error_ = 0.0;
  std::vector<PassError> passes_;
  double points_wanted_ = fewest_points, last_rays_ = 0.0, last_took_ = 0.0;
  std::size_t first_patches_ = 0;
  PatchBound bound_;
};

}  // namespace

bool cuts_surfaces(const scenes::Quality& given) {
  return !given.patch_edge_m && given.refine.value_or(true);
}

radiosity::SolveOptions first_surface_options(const scenes::Scene& scene, double error,
                                              std::uint64_t seed) {
  scenes::Quality quality = scene.quality;
  const bool cuts = cuts_surfaces(quality);
  quality.error = cuts ? std::max(coarse_error, error) : error;
  radiosity::SolveOptions options =
      radiosity::solve_options(scenes::resolve_quality(scene, quality), seed);
  if (cuts) options.patch_edge_m = options.refine.start_edge_m;
  if (!quality.form_factor_rays) options.form_factor_rays = coarse_rays;
  options.refine.on = false;
  return options;
}

PatchBound patch_bound(const Wanted& wanted, const scenes::Quality& given, std::size_t first,
                       std::size_t largest) {
  constexpr int rays = 16;          // per patch, as coarse patches share theirs
  constexpr std::size_t near = 64;  // finds the bound to 1/64
  PatchBound bound{std::max(first, largest)};
  if (given.max_patches) {
    const std::size_t allowed = std::max(first, static_cast<std::size_t>(*given.max_patches));
    if (allowed < bound.most) bound = {allowed, Limit::Settings};
  }
  const auto fits = [&](std::size_t count) {
    return !wanted.fits || wanted.fits(static_cast<double>(count), rays);
  };
  if (fits(bound.most)) return bound;
  std::size_t enough = first;
  for (std::size_t more = bound.most; more > enough + enough / near + 1;) {
    const std::size_t middle = enough + (more - enough) / 2;
    (fits(middle) ? enough : more) = middle;
  }
  return {enough, Limit::Memory};
}

SteeredSolution reach_surfaces(const scenes::World& scene, const Wanted& wanted, std::uint64_t seed,
                               const SolveListener& listen, const StageListener& progress) {
  SurfaceSearch search(scene, wanted, seed, listen, progress);
  SteeredSolution found = search.run();
  found.surface.not_captured = not_captured(scene, {});
  return found;
}

}  // namespace earthshine::raytrace
