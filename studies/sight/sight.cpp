// SPDX-License-Identifier: Apache-2.0
#include "studies/sight/sight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

constexpr double two_sided_95 = 1.96;

ContrastBounds bounds_of(const SightTarget& target, double difference, double deviation) {
  if (deviation <= 0.0) return {};
  if (difference <= 0.0) return {0.0, std::numeric_limits<double>::infinity()};
  const double ratio = deviation / difference, parts = static_cast<double>(target.parts.size());
  const double down = std::sqrt(two_sided_95 * two_sided_95 + parts);
  return {std::max(0.0, 1.0 - down * ratio), 1.0 + two_sided_95 * ratio};
}

// At both ends of the bounds.
struct Chances {
  std::optional<Probability> low, high;
};

EyeSight eye_sight(const SightTarget& target, const TargetLight& light, double difference,
                   double mean_luminance, const SightOptions& options, const ContrastBounds& bounds,
                   Chances& chances) {
  EyeSight eye;
  eye.adaptation = mean_luminance;
  eye.acuity = acuity_cycles_per_deg(mean_luminance);
  eye.cycles = target.extent.angle_deg * eye.acuity;
  if (!light.surround) return eye;
  eye.weber = light.contrast;
  // For a surround above the adaptation luminance, the threshold is that of the surround.
  const double least = options.eye.threshold_factor *
                       threshold_difference(std::max(mean_luminance, *light.surround));
  if (*light.surround > 0.0) eye.threshold = least / *light.surround;
  const Probability johnson = johnson_probability(eye.cycles, options.cycles);
  const auto chance_at = [&](double factor) {
    const double seen = difference > 0.0
                            ? seeing_probability(factor * difference / least, options.eye)
                            : seeing_probability(std::isinf(factor) ? 1e9 : 0.0, options.eye);
    return Probability{std::min(johnson.detect, seen), std::min(johnson.recognise, seen),
                       std::min(johnson.identify, seen)};
  };
  eye.probability = chance_at(1.0);
  chances = {chance_at(bounds.low), chance_at(bounds.high)};
  return eye;
}

Verdict verdict_of(const Sight& sight, const std::optional<Probability>& probability,
                   const TargetView& view, const SightOptions& options) {
  if (view.pixels_alone == 0) return view.in_frame ? Verdict::NotSeen : Verdict::OutOfView;
  if (!(sight.visible_fraction >= options.hidden_fraction)) return Verdict::Hidden;
  if (!probability) return Verdict::Doubtful;
  const Probability& p = *probability;
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
                          const std::optional<degrade::Setup>& cctv, const SightOptions& options,
                          std::span<const double> deviation) {
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
  std::vector<double> difference(plan.targets.size(), 0.0);
  std::vector<ContrastBounds> bounds(plan.targets.size());
  for (std::size_t t = 0; t < bounds.size(); ++t) {
    const auto light = measure_light(plan.targets[t].view, luminance);
    if (!light || !light->surround) continue;
    difference[t] = difference_of(plan.targets[t], *light, luminance);
    if (!deviation.empty()) bounds[t] = bounds_of(plan.targets[t], difference[t], deviation[t]);
  }
  std::optional<ShownRange> shown;
  if (cctv) {
    const CctvSignal line = pass_through(radiance, *cctv);
    found.exposure = line.report.exposure;
    shown = shown_range(cctv->camera, line.report, found.mean_luminance);
    signals = target_signals(plan, line, *cctv, options, bounds);
  }
  for (std::size_t t = 0; t < plan.targets.size(); ++t) {
    const SightTarget& target = plan.targets[t];
    Sight sight;
    Chances chances;
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
      sight.eye = eye_sight(target, *light, difference[t], found.mean_luminance, options, bounds[t],
                            chances);
      sight.probability = sight.eye->probability;
      if (signals[t]) {
        take(sight, *signals[t]);
        sight.probability = signals[t]->probability;
        chances = {signals[t]->probability_low, signals[t]->probability_high};
      }
    }
    sight.verdict = verdict_of(sight, sight.probability, target.view, options);
    sight.verdict_low = verdict_of(sight, chances.low, target.view, options);
    sight.verdict_high = verdict_of(sight, chances.high, target.view, options);
    found.targets.push_back(sight);
  }
  return found;
}

}  // namespace earthshine::studies
