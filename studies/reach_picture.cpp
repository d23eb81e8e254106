// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "raytrace/blend.h"
#include "studies/wanted_error.h"

namespace earthshine::studies {
namespace {

constexpr int most_tries = 5;
constexpr double no_better = 0.95;   // of the error before: more of the same will not help
constexpr double most_change = 3.0;  // of the noise in one try: nine times the rays
// Not sharing takes eight times the rays (scenes/quality.h): no matter in a small picture, which is
// where edges are many.
constexpr double small_picture = 65536.0;
constexpr double aim = 0.95;         // of the noise that is left
constexpr double least_share = 0.3;  // of the wanted error, for noise, whatever the rest is
constexpr double least_setting = 1e-4;
constexpr double trusted = 2.0;  // how far a small trial may lead away from the laws
constexpr double most_of_last = 0.9;
// Times the noise that was asked for: more is no noise, but what sharing gather rays blurs, and
// more samples of the same kind do not take it away.
constexpr double blurred = 1.5;
constexpr int most_plain_tries = 6;

}  // namespace

std::string limit_name(Limit limit) {
  switch (limit) {
    case Limit::None:
      return "none";
    case Limit::Time:
      return "time";
    case Limit::Memory:
      return "memory";
    case Limit::Settings:
      return "settings";
    case Limit::Steps:
      return "steps";
  }
  return "";
}

raytrace::RenderOptions with_noise(const raytrace::RenderOptions& options,
                                   const scenes::Scene& scene, const NoiseSetting& setting) {
  scenes::Quality quality = scene.quality;
  const auto by_law = [&](double error) {
    quality.error = std::clamp(error, least_setting, 1.0);
    return raytrace::render_options(scenes::resolve_quality(scene, quality));
  };
  raytrace::RenderOptions with = options;
  const raytrace::RenderOptions gathers = by_law(setting.gather);
  with.gather_rays = gathers.gather_rays;
  with.shared = gathers.shared;
  with.shared.noise = by_law(setting.samples).shared.noise;
  return with;
}

namespace {

// The same without sharing.
raytrace::RenderOptions plain_with_noise(const raytrace::RenderOptions& options,
                                         const scenes::Scene& scene, double noise) {
  scenes::Quality quality = scene.quality;
  quality.share_gather = false;
  quality.error = std::clamp(noise, least_setting, 1.0);
  const raytrace::RenderOptions plain =
      raytrace::render_options(scenes::resolve_quality(scene, quality));
  raytrace::RenderOptions with = options;
  with.gather_rays = plain.gather_rays;
  with.shared = plain.shared;
  return with;
}

}  // namespace

NoiseFound noise_found(const raytrace::RenderReport& report, const Doubt& gather,
                       const Doubt& samples) {
  const auto rays = static_cast<double>(report.rays.total());
  const auto gather_rays = static_cast<double>(report.rays.gather);
  return {gather.estimate, samples.estimate, gather_rays, std::max(0.0, rays - gather_rays)};
}

namespace {

// One picture, again and again.
class PictureSearch {
 public:
  PictureSearch(const StudyScene& scene, const Wanted& wanted, const radiosity::Solution& solution,
                const WatchedErrors& errors, const WatchedPicture& picture,
                const raytrace::Progress& progress)
      : scene_(scene),
        wanted_(wanted),
        solution_(solution),
        errors_(errors),
        picture_(picture),
        progress_(progress) {}

  SteeredPicture run(const Trial& trial) {
    const double by_solution = errors_.whole.total().estimate;
    const double left = aim * std::sqrt(std::max(squared(least_share * wanted_.error),
                                                 squared(wanted_.error) - squared(by_solution)));
    NoiseSetting first = first_setting(trial, left), setting = first;
    NoiseFound first_found;
    double wish = std::numeric_limits<double>::infinity(), before = wish;
    for (int tries = 1, of_kind = 1;; ++tries, ++of_kind) {
      const double started = now();
      take_in(draw(setting, tries), of_kind == 1);
      const double noise = assess(setting);
      if (of_kind == 1) first_found = noise_of_best();
      const double found = best_.budget.parts.total().estimate;
      // A crop has the pixels of the picture that a whole one starts with.
      if (best_.frame.report.stopped || found <= wanted_.error || crops()) break;
      if (noise <= least_share * wanted_.error ||
          of_kind == (plain_ ? most_plain_tries : most_tries)) {
        return ended(Limit::Steps);
      }
      if (of_kind == 1) first_seconds_ = now() - started;
      if (may_be_plain() && noise > blurred * wish) {
        plain_ = true;
        of_kind = 0;
        first = setting = {left, left};
        wish = before = std::numeric_limits<double>::infinity();
        continue;
      }
      if (!plain_ && found > no_better * before) return ended(Limit::Steps);
      before = found;
      // What comes next is blended with what is there: 1 / left^2 = 1 / noise^2 + 1 / ask^2.
      wish = std::clamp(left, noise / most_change, most_of_last * noise);
      const double ask = 1.0 / std::sqrt(1.0 / squared(wish) - 1.0 / squared(noise));
      const double all = std::hypot(first_found.gather, first_found.samples);
      setting = plain_ ? NoiseSetting{left * ask / all, left * ask / all}
                       : next_setting(first, first_found, ask);
      const double taken = first_seconds_ * squared(all / ask);
      if (wanted_.seconds > 0.0 && now() + taken > wanted_.seconds) return ended(Limit::Time);
    }
    return ended(Limit::None);
  }

 private:
  static double squared(double x) { return x * x; }
  [[nodiscard]] double now() const { return wanted_.now ? wanted_.now() : 0.0; }
  [[nodiscard]] bool may_be_plain() const {
    const scenes::Quality& given = scene_.scene.quality;
    const double pixels = double(picture_.options.columns) * picture_.options.rows;
    return !plain_ && pixels <= small_picture && !given.share_gather && !given.gather_rays;
  }
  [[nodiscard]] bool crops() const { return picture_.options.crop.columns > 0; }

  static NoiseSetting first_setting(const Trial& trial, double left) {
    if (trial.found.gather + trial.found.samples <= 0.0) return {left, left};
    const NoiseSetting by_trial = next_setting(trial.setting, trial.found, left);
    const auto near = [&](double x) { return std::clamp(x, left / trusted, left * trusted); };
    return {near(by_trial.gather), near(by_trial.samples)};
  }

  raytrace::Frame draw(const NoiseSetting& setting, int number) {
    raytrace::RenderOptions options =
        plain_ ? plain_with_noise(picture_.options, scene_.scene, setting.gather)
               : with_noise(picture_.options, scene_.scene, setting);
    if (number > 1) options.seed = base::mix64(options.seed + static_cast<std::uint64_t>(number));
    if (wanted_.seconds > 0.0) {
      options.time_limit_s = std::max(1e-3, wanted_.seconds - now());
      options.fills_time = false;
    }
    if (number == 1 || plain_) best_.options = options;
    return raytrace::render(scene_.scene, scene_.groups, scene_.effects, scene_.query, solution_,
                            *picture_.camera, options, progress_);
  }

  // Each by the inverse of its squared noise, as both state it in the same way. One that was
  // stopped is no help.
  void take_in(raytrace::Frame next, bool alone) {
    if (steps_.empty() || (alone && !next.report.stopped)) {
      best_.frame = std::move(next);
      return;
    }
    if (next.report.stopped) return;
    const double a = squared(best_.frame.report.relative_noise);
    const double b = squared(next.report.relative_noise);
    best_.frame = raytrace::blend(std::move(best_.frame), next, a + b > 0.0 ? a / (a + b) : 0.5);
  }

  [[nodiscard]] NoiseFound noise_of_best() const {
    const ErrorParts& parts = best_.budget.parts;
    return noise_found(best_.frame.report, parts.gather_noise,
                       parts.lamp_sampling + parts.camera_samples);
  }

  // Gives the noise, relative.
  double assess(const NoiseSetting& setting) {
    best_.budget =
        error_budget(scene_, errors_, solution_, {picture_.camera, best_.options}, best_.frame);
    Step step;
    step.stage = "picture";
    step.gather_rays = best_.frame.report.gather_rays;
    step.asked = std::hypot(setting.gather, setting.samples);
    step.estimate = best_.budget.parts.total().estimate;
    steps_.push_back(step);
    const NoiseFound noise = noise_of_best();
    return std::hypot(noise.gather, noise.samples);
  }

  SteeredPicture ended(Limit limit) {
    best_.limit = limit;
    best_.steps = steps_;
    return std::move(best_);
  }

  const StudyScene& scene_;
  const Wanted& wanted_;
  const radiosity::Solution& solution_;
  const WatchedErrors& errors_;
  const WatchedPicture& picture_;
  const raytrace::Progress& progress_;
  SteeredPicture best_;
  std::vector<Step> steps_;
  double first_seconds_ = 0.0;
  bool plain_ = false;  // nothing is shared any more
};

}  // namespace

SteeredPicture reach_picture(const StudyScene& scene, const Wanted& wanted,
                             const radiosity::Solution& solution, const WatchedErrors& errors,
                             const WatchedPicture& picture, const Trial& trial,
                             const raytrace::Progress& progress) {
  return PictureSearch(scene, wanted, solution, errors, picture, progress).run(trial);
}

}  // namespace earthshine::studies
