// SPDX-License-Identifier: Apache-2.0
// The comparison's verdict on each target in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/compare/compare.h"

namespace earthshine::studies {
namespace {

std::string contrast_text(const TargetLight& light) {
  if (!light.contrast) return light.surround ? "undefined (black round it)" : "undefined";
  const double rounded = std::round(100.0 * *light.contrast) / 100.0;
  return fmt::format("{:+.2f}", rounded == 0.0 ? 0.0 : rounded);  // never "-0.00"
}

// Three digits, without an exponent up to a million.
std::string luminance_text(double value) {
  const bool is_large = value >= 1000.0 && value < 1e6;
  return is_large ? fmt::format("{:.0f}", 10.0 * std::round(0.1 * value))
                  : fmt::format("{:.3g}", value);
}

// "3.1 instead of 5.2 cd/m2 (x 0.60), contrast -0.20 instead of +0.10"
std::string figures(const TargetDifference& found, const TargetLight& right) {
  if (right.luminance <= 0.0 && found.light.luminance <= 0.0) {
    return fmt::format("black in both, contrast {} instead of {}", contrast_text(found.light),
                       contrast_text(right));
  }
  const std::string ratio = right.luminance <= 0.0 ? "light where there is none"
                            : found.light.luminance <= 0.0
                                ? "x 0, black"
                                : fmt::format("x {:.2f}", found.luminance_ratio);
  return fmt::format("{} instead of {} cd/m2 ({}), contrast {} instead of {}",
                     luminance_text(found.light.luminance), luminance_text(right.luminance), ratio,
                     contrast_text(found.light), contrast_text(right));
}

// The last method over the disc: compare_methods lists these from 2 on by rising N.
std::size_t most_lights(const std::vector<MethodResult>& methods) {
  std::size_t k = 2;
  while (methods[k + 1].method.indirect == raytrace::Indirect::Distributed &&
         methods[k + 1].method.distributed_over.empty()) {
    ++k;
  }
  return k;
}

// The least number of lights from which on no method breaks the rule.
int enough_lights(const std::vector<MethodResult>& methods, std::size_t most, std::size_t target) {
  int enough = methods[most].method.distributed_lights;
  for (std::size_t k = most; k >= 2 && !methods[k].targets[target]->misleads; --k) {
    enough = methods[k].method.distributed_lights;
  }
  return enough;
}

TargetVerdict judge(const Comparison& comparison, std::size_t target) {
  std::string name = comparison.targets[target].name;
  const auto& right = comparison.reference().targets[target];
  if (!right) {
    const bool hidden = comparison.targets[target].pixels_alone > 0;
    return {ApproximationVerdict::NotInView,
            name + (hidden ? ": hidden by other objects." : ": not in view.")};
  }
  if (comparison.target_shines[target]) name += " (itself a source)";
  const std::vector<MethodResult>& methods = comparison.methods;
  const std::size_t most = most_lights(methods);
  const TargetDifference& found = *methods[most].targets[target];
  const std::string numbers = figures(found, right->light);
  const int n = methods[most].method.distributed_lights;
  if (!found.decided) {
    return {ApproximationVerdict::Undecided,
            fmt::format("{}: too noisy to tell on {} pixels whether {} distributed lights would "
                        "have misled: {}; one standard deviation is {:.2g} of the ratio, {:.2g} of "
                        "the contrast.",
                        name, comparison.targets[target].measured.size(), n, numbers,
                        found.ratio_error, found.contrast_error)};
  }
  const bool black = std::all_of(methods.begin(), methods.end(), [&](const MethodResult& result) {
    return !result.targets[target] || result.targets[target]->light.luminance <= 0.0;
  });
  if (black && right->light.luminance <= 0.0) {
    return {ApproximationVerdict::NotMisled,
            name + ": black by every method; there is nothing to tell."};
  }
  const std::string besides = methods[1].targets[target]->misleads
                                  ? fmt::format("; radiosity at these settings would have too, {}",
                                                figures(*methods[1].targets[target], right->light))
                                  : "";
  if (found.misleads) {
    return {ApproximationVerdict::Misled,
            fmt::format("{}: {} distributed lights would have misled, {}{}.", name, n, numbers,
                        besides)};
  }
  const int enough = enough_lights(methods, most, target);
  const std::string from = enough == n ? "" : fmt::format(", nor would {}", enough);
  return {ApproximationVerdict::NotMisled,
          fmt::format("{}: {} distributed lights would not have misled{}, {}{}.", name, n, from,
                      numbers, besides)};
}

}  // namespace

std::vector<std::size_t> errors_below_the_references_noise(const Comparison& comparison) {
  std::vector<std::size_t> below;
  for (std::size_t k = 1; k < comparison.methods.size(); ++k) {
    const double error = comparison.methods[k].error.error;
    if (error < comparison.reference_noise) below.push_back(k);
  }
  return below;
}

std::vector<TargetVerdict> judge_approximation(const Comparison& comparison) {
  std::vector<TargetVerdict> verdicts;
  for (std::size_t target = 0; target < comparison.targets.size(); ++target) {
    verdicts.push_back(judge(comparison, target));
  }
  return verdicts;
}

}  // namespace earthshine::studies
