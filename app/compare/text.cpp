// SPDX-License-Identifier: Apache-2.0
// The comparison as text.
#include <fmt/format.h>

#include <algorithm>

#include "app/compare/tables.h"
#include "app/console.h"

namespace earthshine::app {
namespace {

std::string fixed_table(const studies::Comparison& comparison) {
  std::string text = fmt::format("{:<18} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "method",
                                 "solve s", "render s", "rays", "RMSE", "bias", "off");
  for (const studies::MethodResult& result : comparison.methods) {
    const studies::PictureDifference& difference = result.difference;
    text += fmt::format("{:<18} {:>9.1f} {:>9.1f} {:>9} {:>7.1f} % {:>+7.1f} % {:>7.1f} %\n",
                        result.method.name, result.solve_seconds, result.render_seconds,
                        short_count(static_cast<double>(result.frame.report.rays.total())),
                        100.0 * difference.relative_rmse, 100.0 * difference.bias,
                        100.0 * difference.off_share);
  }
  const studies::PictureDifference& noise = comparison.reference_noise;
  return text +
         fmt::format(
             "{:<18} {:>39} {:>7.2f} %  of the reference itself\n"
             "RMSE and bias: of the luminance, over the reference's mean; off: by a factor {}\n",
             "noise-floor", "", 100.0 * noise.relative_rmse, studies::misleading_factor);
}

// Errors smaller than what the reference itself is uncertain by are found, as the mean over all
// pixels is far surer than one of them, but only to their standard error.
std::string noise_text(const studies::Comparison& comparison) {
  std::vector<std::string> judged;
  for (const std::size_t k : studies::errors_below_the_references_noise(comparison)) {
    const studies::MethodResult& result = comparison.methods[k];
    judged.push_back(fmt::format("{} ({:.2g} +- {:.1g} %)", result.method.name,
                                 100.0 * result.difference.relative_rmse,
                                 100.0 * result.difference.standard_error));
  }
  return fmt::format(
      "The references are noisier, {:.2g} %, than the errors that they judge of: {}. A smaller "
      "--error, or more rays, make them surer.",
      100.0 * comparison.reference_noise.relative_rmse, fmt::join(judged, ", "));
}

std::string lights_text(const studies::Comparison& comparison, bool over_area) {
  const int most = std::prev(std::find_if(comparison.methods.begin() + 2, comparison.methods.end(),
                                          [](const studies::MethodResult& result) {
                                            return result.method.distributed_lights == 0 ||
                                                   !result.method.distributed_over.empty();
                                          }))
                       ->method.distributed_lights;
  const auto from = levels_out_at(comparison, over_area);
  const char* const where = over_area ? " over the area" : "";
  if (from) {
    return fmt::format("From {} lights{} on, more change the error by less than a twentieth.",
                       *from, where);
  }
  return fmt::format("At {} lights{} the error has not levelled out yet.", most, where);
}

}  // namespace

std::vector<std::string> findings(const studies::Comparison& comparison) {
  std::vector<std::string> lines;
  if (!comparison.wide_sources) {
    lines.emplace_back(
        "No Earth, area lamp or emitting surface is there to distribute: the approximation is the "
        "direct light alone.");
  } else {
    lines.push_back(lights_text(comparison, false));
    const studies::Method& last = std::prev(comparison.methods.end(), 2)->method;
    if (!last.distributed_over.empty()) lines.push_back(lights_text(comparison, true));
  }
  if (!studies::errors_below_the_references_noise(comparison).empty()) {
    lines.push_back(noise_text(comparison));
  }
  lines.push_back(fmt::format(
      "Misled: a target's luminance is off by more than a factor {}, or its contrast by more "
      "than {}.",
      studies::misleading_factor, studies::misleading_contrast));
  const std::vector<studies::TargetVerdict> verdicts = studies::judge_approximation(comparison);
  if (verdicts.empty()) lines.emplace_back("The scene marks no object as a target.");
  for (const studies::TargetVerdict& verdict : verdicts) lines.push_back(verdict.sentence);
  return lines;
}

std::string summary(const studies::Comparison& comparison) {
  return fmt::format("{}\n{}\n", fixed_table(comparison), fmt::join(findings(comparison), "\n"));
}

}  // namespace earthshine::app
