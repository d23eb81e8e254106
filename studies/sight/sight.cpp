// SPDX-License-Identifier: Apache-2.0
#include "studies/sight/sight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.h"
#include "studies/sight/target_signal.h"
#include "studies/targets/target_light.h"

namespace earthshine::studies {
namespace {

// Root mean square over the target's parts.
double difference_of(const SightTarget& target, const TargetLight& light,
                     const std::vector<float>& luminance) {
  if (target.parts.empty()) return std::abs(light.luminance - *light.surround);
  double sum = 0.0;
  for (const SightTarget::Part& part : target.parts) {
    const double d = mean_over(luminance, part.target) - mean_over(luminance, part.surround);
    sum += part.share * d * d;
  }
  return std::sqrt(sum);
}

EyeSight eye_sight(const SightTarget& target, const TargetLight& light,
                   const std::vector<float>& luminance, double mean_luminance,
                   const SightOptions& options) {
  EyeSight eye;
  eye.adaptation = mean_luminance;
  eye.acuity = acuity_cycles_per_deg(mean_luminance);
  eye.cycles = target.extent.angle_deg * eye.acuity;
  if (!light.surround) return eye;
  eye.weber = light.contrast;
  // Against a surround brighter than what it is adapted to, the eye needs what that calls for.
  const double least = options.eye.threshold_factor *
                       threshold_difference(std::max(mean_luminance, *light.surround));
  if (*light.surround > 0.0) eye.threshold = least / *light.surround;
  const double seen =
      seeing_probability(difference_of(target, light, luminance) / least, options.eye);
  const Probability johnson = johnson_probability(eye.cycles, options.cycles);
  eye.probability = Probability{std::min(johnson.detect, seen), std::min(johnson.recognise, seen),
                                std::min(johnson.identify, seen)};
  return eye;
}

Verdict verdict_of(const Sight& sight, const TargetView& view, const SightOptions& options) {
  if (view.pixels_alone == 0) return view.in_frame ? Verdict::NotSeen : Verdict::OutOfView;
  if (!(sight.visible_fraction >= options.hidden_fraction)) return Verdict::Hidden;
  if (!sight.probability) return Verdict::Doubtful;
  const Probability& p = *sight.probability;
  if (sight.black_back >= options.most_black_back) {
    return p.detect >= options.doubtful_probability ? Verdict::Doubtful : Verdict::NotSeen;
  }
  if (p.identify >= options.seen_probability) return Verdict::Identified;
  if (p.recognise >= options.seen_probability) return Verdict::Recognised;
  if (p.detect >= options.seen_probability) return Verdict::Detected;
  return p.detect >= options.doubtful_probability ? Verdict::Doubtful : Verdict::NotSeen;
}

void take(Sight& sight, const TargetSignal& cctv) {
  sight.tv_lines = cctv.lines;
  sight.signal = cctv.signal;
  sight.monitor = cctv.monitor;
  sight.johnson_cycles = cctv.cycles;
  sight.saturated = cctv.saturated;
  sight.crushed = cctv.crushed;
}

}  // namespace

std::string_view word_of(Verdict verdict) {
  constexpr std::array<std::string_view, 7> words = {
      "identified", "recognised", "detected", "doubtful", "not-seen", "out-of-view", "hidden"};
  return words[static_cast<std::size_t>(verdict)];
}

CameraSight measure_sight(const SightPlan& plan, const base::Image& radiance,
                          const std::optional<degrade::Setup>& cctv, const SightOptions& options) {
  if (radiance.width != plan.map.columns || radiance.height != plan.map.rows) {
    throw base::Error(base::Blame::Input, "sight",
                      "a picture of " + std::to_string(radiance.width) + " x " +
                          std::to_string(radiance.height) + " pixels",
                      "its object map has " + std::to_string(plan.map.columns) + " x " +
                          std::to_string(plan.map.rows));
  }
  const std::vector<float> luminance = base::luminance_of(radiance);
  CameraSight found;
  double sum = 0.0;
  for (const float value : luminance) sum += static_cast<double>(value);
  found.mean_luminance = std::max(0.0, sum / static_cast<double>(luminance.size()));
  std::vector<std::optional<TargetSignal>> signals(plan.targets.size());
  std::optional<ShownRange> shown;
  if (cctv) {
    const CctvSignal line = pass_through(radiance, *cctv);
    found.exposure = line.report.exposure;
    shown = shown_range(cctv->camera, line.report, found.mean_luminance);
    signals = target_signals(plan, line, *cctv, options);
  }
  for (std::size_t t = 0; t < plan.targets.size(); ++t) {
    const SightTarget& target = plan.targets[t];
    Sight sight;
    sight.pixels = target.seen.size();
    sight.cut_by_frame = target.view.cut_by_frame;
    if (shown) {
      sight.shown_from = shown->black;
      sight.shown_to = shown->white;
    }
    if (target.view.pixels_alone > 0) {
      sight.visible_fraction =
          static_cast<double>(sight.pixels) / static_cast<double>(target.view.pixels_alone);
    }
    if (const auto light = measure_light(target.view, luminance)) {
      sight.luminance = light->luminance;
      sight.surround = light->surround;
      sight.weber = light->contrast;
      sight.black_back =
          static_cast<double>(target.view.black_back.size()) / static_cast<double>(sight.pixels);
      sight.angle_deg = target.extent.angle_deg;
      sight.tv_lines = target.extent.pixels;
      sight.eye = eye_sight(target, *light, luminance, found.mean_luminance, options);
      sight.probability = sight.eye->probability;
      if (signals[t]) {
        take(sight, *signals[t]);
        sight.probability = signals[t]->probability;
      }
    }
    sight.verdict = verdict_of(sight, target.view, options);
    found.targets.push_back(sight);
  }
  return found;
}

}  // namespace earthshine::studies
