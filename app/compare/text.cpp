// SPDX-License-Identifier: Apache-2.0
// The comparison as text.
#include <fmt/format.h>

#include <algorithm>

#include "app/compare/tables.h"
#include "app/console.h"

namespace earthshine::app {
namespace {

using studies::Ladder;
using studies::LadderEnd;

std::string percent(double share) { return fmt::format("{:.3g} %", 100.0 * share); }

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
  return text + fmt::format("{:<18} {:>39} {:>7.2f} %  of the reference itself\n", "noise-floor",
                            "", 100.0 * noise.relative_rmse);
}

std::string at_error_text(const studies::Comparison& comparison,
                          const studies::MethodResult& result) {
  const Ladder& ladder = result.equal->ladder;
  switch (ladder.end) {
    case LadderEnd::Reached: {
      const double seconds = result.equal->at_error.seconds;
      return fmt::format("{:.3g} s, x {:.2g}", seconds, seconds / comparison.equal_seconds);
    }
    case LadderEnd::LevelsOut:
      return fmt::format("never: levels out at {}", percent(least_error(ladder)));
    case LadderEnd::NotWithin:
      break;
  }
  return fmt::format("not in {:.3g} s: {} there", most_seconds(ladder),
                     percent(least_error(ladder)));
}

std::string equal_table(const studies::Comparison& comparison) {
  std::string text = fmt::format(
      "\nEqual time: {:.3g} CPU s each, solution included. Equal error: {}, as radiosity reaches "
      "or "
      "as asked for.\n{:<18} {:>9} {:>9} {:>9} {:>9}   {}\n",
      comparison.equal_seconds, percent(comparison.equal_error), "method", "CPU s", "samples",
      "RMSE", "+-", "CPU seconds to the equal error");
  for (const studies::MethodResult& result : comparison.methods) {
    if (!result.equal) continue;
    const std::string at_error = at_error_text(comparison, result);
    if (!result.equal->at_time) {
      text += fmt::format("{:<18} {:>39}   {}\n", result.method.name, "takes longer at its least",
                          at_error);
      continue;
    }
    const studies::Shot& shot = *result.equal->at_time;
    text += fmt::format("{:<18} {:>9.3g} {:>9.1f} {:>7.2f} % {:>7.2f} %   {}\n", result.method.name,
                        shot.seconds, shot.camera_samples, 100.0 * shot.difference.relative_rmse,
                        100.0 * shot.difference.standard_error, at_error);
  }
  return text;
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
    return fmt::format("From {} lights{} on, more change the error by less than a twentieth.\n",
                       *from, where);
  }
  return fmt::format("At {} lights{} the error has not levelled out yet.\n", most, where);
}

}  // namespace

std::string summary(const studies::Comparison& comparison) {
  std::string text = fixed_table(comparison);
  if (comparison.equal_seconds > 0.0) text += equal_table(comparison);
  text += "\n";
  if (!comparison.wide_sources) {
    text +=
        "No Earth, area lamp or emitting surface is there to distribute: the approximation is the "
        "direct light alone.\n";
  } else {
    text += lights_text(comparison, false);
    const studies::Method& last = std::prev(comparison.methods.end(), 2)->method;
    if (!last.distributed_over.empty()) text += lights_text(comparison, true);
  }
  text += fmt::format(
      "Misled: a target's luminance is off by more than a factor {}, or its contrast by more "
      "than {}.\n",
      studies::misleading_factor, studies::misleading_contrast);
  const std::vector<studies::TargetVerdict> verdicts = studies::judge_approximation(comparison);
  if (verdicts.empty()) text += "The scene marks no object as a target.\n";
  for (const studies::TargetVerdict& verdict : verdicts) text += verdict.sentence + "\n";
  return text;
}

}  // namespace earthshine::app
