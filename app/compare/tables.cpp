// SPDX-License-Identifier: Apache-2.0
// The comparison as tables.
#include "app/compare/tables.h"

#include <cmath>

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

}  // namespace

Json method_rows(const studies::Comparison& comparison) {
  Json rows = Json::array();
  for (const studies::MethodResult& result : comparison.methods) {
    const raytrace::RenderReport& report = result.frame.report;
    Json row = method_row(result.method);
    row["solve_seconds"] = result.solve_seconds;
    row["render_seconds"] = result.render_seconds;
    row["rays"] = report.rays.total();
    row["relative_rmse"] = result.difference.relative_rmse;
    row["bias"] = result.difference.bias;
    row["off_share"] = result.difference.off_share;
    row["relative_noise"] = report.relative_noise;
    row["standard_error"] = result.difference.standard_error;
    row["solve_cpu_seconds"] = result.solve_cpu_seconds;
    row["render_cpu_seconds"] = result.render_cpu_seconds;
    rows.push_back(std::move(row));
  }
  // What the reference itself is uncertain by.
  Json noise = rows.front();
  for (auto& [key, value] : noise.items()) value = nullptr;
  noise["method"] = "noise-floor";
  noise["relative_rmse"] = comparison.reference_noise.relative_rmse;
  noise["bias"] = comparison.reference_noise.bias;
  noise["standard_error"] = comparison.reference_noise.standard_error;
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
                {"relative_rmse", result.difference.relative_rmse},
                {"standard_error", result.difference.standard_error},
                {"bias", result.difference.bias}};
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
    errors.emplace_back(result.method.distributed_lights, result.difference.relative_rmse);
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

}  // namespace earthshine::app
