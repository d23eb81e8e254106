// SPDX-License-Identifier: Apache-2.0
// The comparison as tables.
#include "app/compare/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/console.h"
#include "scenes/text/message_text.h"

namespace earthshine::app {
namespace {

Json or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json method_row(const studies::Method& method) {
  const int lights = method.distributed_lights;
  const std::string& over = method.distributed_over;
  return {{"method", method.name},
          {"lights", lights > 0 ? Json(lights) : Json()},
          {"area", over.empty() ? Json() : Json(over)}};
}

void add_target(const std::optional<studies::TargetDifference>& target, Json& row) {
  row["luminance_cd_m2"] = target ? Json(target->light.luminance) : Json();
  row["surround_cd_m2"] = target ? to_json(target->light.surround) : Json();
  row["contrast"] = target ? to_json(target->light.contrast) : Json();
  row["luminance_ratio"] = target ? or_null(target->luminance_ratio) : Json();
  row["contrast_difference"] = target ? to_json(target->contrast_difference) : Json();
  row["misleads"] = target ? Json(target->misleads) : Json();
  row["ratio_standard_error"] = target ? or_null(target->ratio_error) : Json();
  row["contrast_standard_error"] = target ? or_null(target->contrast_error) : Json();
  row["decided"] = target ? Json(target->decided) : Json();
}

// The comparison as text.

std::string fixed_table(const studies::Comparison& comparison) {
  std::string text = fmt::format("{:<18} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "method",
                                 "solve s", "render s", "rays", "RMSE", "bias", "off");
  for (const studies::MethodResult& result : comparison.methods) {
    text += fmt::format("{:<18} {:>9.1f} {:>9.1f} {:>9} {:>7.1f} % {:>+7.1f} % {:>7.1f} %\n",
                        result.method.name, result.solve_seconds, result.render_seconds,
                        short_count(static_cast<double>(result.frame.report.rays.total())),
                        100.0 * result.error.error, 100.0 * result.error.bias,
                        100.0 * result.off_share);
  }
  return text +
         fmt::format(
             "{:<18} {:>39} {:>7.2f} %  of the reference itself\n"
             "RMSE and bias: of the luminance, over the reference's mean; off: by a factor {}\n",
             "noise-floor", "", 100.0 * comparison.reference_noise, studies::misleading_factor);
}

// Errors below the uncertainty of the reference are detectable, since the mean over all pixels is
// much more accurate than one pixel, but only to their standard error.
std::string noise_text(const studies::Comparison& comparison) {
  std::vector<std::string> judged;
  for (const std::size_t k : studies::errors_below_the_references_noise(comparison)) {
    const studies::MethodResult& result = comparison.methods[k];
    judged.push_back(fmt::format("{} ({} +- {})", result.method.name,
                                 scenes::two_digits(100.0 * result.error.error),
                                 scenes::percent(result.error.standard_error)));
  }
  return fmt::format(
      "The references are noisier, {}, than the errors that they judge of: {}. A smaller "
      "--error, or more rays, make them surer.",
      scenes::percent(comparison.reference_noise), fmt::join(judged, ", "));
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

Json method_rows(const studies::Comparison& comparison) {
  Json rows = Json::array();
  for (const studies::MethodResult& result : comparison.methods) {
    const raytrace::RenderReport& report = result.frame.report;
    Json row = method_row(result.method);
    row["solve_seconds"] = result.solve_seconds;
    row["render_seconds"] = result.render_seconds;
    row["rays"] = report.rays.total();
    row["relative_rmse"] = result.error.error;
    row["bias"] = result.error.bias;
    row["off_share"] = result.off_share;
    row["relative_noise"] = report.relative_noise;
    row["standard_error"] = result.error.standard_error;
    row["solve_cpu_seconds"] = result.solve_cpu_seconds;
    row["render_cpu_seconds"] = result.render_cpu_seconds;
    rows.push_back(std::move(row));
  }
  // Uncertainty of the reference.
  Json noise = rows.front();
  for (auto& [key, value] : noise.items()) value = nullptr;
  noise["method"] = "noise-floor";
  noise["relative_rmse"] = comparison.reference_noise;
  rows.push_back(std::move(noise));
  return rows;
}

Json target_rows(const studies::Comparison& comparison) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < comparison.targets.size(); ++k) {
    const studies::TargetView& view = comparison.targets[k];
    for (const studies::MethodResult& result : comparison.methods) {
      Json row = {{"target", view.name}, {"method", result.method.name}, {"pixels", view.pixels}};
      add_target(result.targets[k], row);
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

Json lights_rows(const studies::Comparison& comparison) {
  Json rows = Json::array();
  for (const studies::MethodResult& result : comparison.methods) {
    if (result.method.distributed_lights == 0) continue;
    Json row = {{"lights", result.method.distributed_lights},
                {"area", method_row(result.method)["area"]},
                {"cpu_seconds", result.cpu_seconds()},
                {"relative_rmse", result.error.error},
                {"standard_error", result.error.standard_error},
                {"bias", result.error.bias}};
    rows.push_back(std::move(row));
  }
  return rows;
}

std::optional<int> levels_out_at(const studies::Comparison& comparison, bool over_area) {
  constexpr double alike = 0.05;
  std::vector<std::pair<int, double>> errors;
  for (const studies::MethodResult& result : comparison.methods) {
    const bool area = !result.method.distributed_over.empty();
    if (result.method.distributed_lights == 0 || area != over_area) continue;
    errors.emplace_back(result.method.distributed_lights, result.error.error);
  }
  if (errors.size() < 2) return std::nullopt;
  const double last = errors.back().second;
  std::optional<int> from;
  for (auto entry = std::next(errors.rbegin()); entry != errors.rend(); ++entry) {
    if (std::abs(entry->second - last) > alike * last) break;
    from = entry->first;
  }
  return from;
}

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
