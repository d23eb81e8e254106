// SPDX-License-Identifier: Apache-2.0
// The comparison as tables and as text.
#include "app/compare_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/console.h"

namespace earthshine::app {
namespace {

using studies::Ladder;
using studies::Reach;

Json or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

std::string word_of(Reach reach) {
  switch (reach) {
    case Reach::Reached:
      return "reached";
    case Reach::LevelsOut:
      return "levels-out";
    case Reach::NotWithin:
      break;
  }
  return "not-within";
}

// The columns that equal time and equal error add to a method's row; null for the references.
void add_equal(const std::optional<studies::EqualResult>& equal, Json& row) {
  const studies::Shot* at_time = equal && equal->at_time ? &*equal->at_time : nullptr;
  const Ladder* ladder = equal ? &equal->ladder : nullptr;
  const auto of_time = [&](const auto& value) {
    return at_time != nullptr ? Json(value()) : Json();
  };
  row["equal_time_step"] = of_time([&] { return ladder->points[ladder->at_time].rung; });
  row["equal_time_seconds"] = of_time([&] { return at_time->seconds; });
  row["equal_time_camera_samples"] = of_time([&] { return at_time->camera_samples; });
  row["equal_time_rmse"] = of_time([&] { return at_time->difference.relative_rmse; });
  row["equal_time_standard_error"] = of_time([&] { return at_time->difference.standard_error; });
  const bool reached = equal && ladder->reach == Reach::Reached;
  row["equal_error"] = equal ? Json(word_of(ladder->reach)) : Json();
  row["equal_error_step"] = reached ? Json(ladder->points[ladder->at_error].rung) : Json();
  row["equal_error_seconds"] = reached ? Json(equal->at_error.seconds) : Json();
  row["least_rmse"] = equal ? Json(least_error(*ladder)) : Json();
  row["most_seconds"] = equal ? Json(most_seconds(*ladder)) : Json();
}

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

double least_error(const Ladder& ladder) {
  double least = ladder.points.front().error;
  for (const studies::LadderPoint& point : ladder.points) least = std::min(least, point.error);
  return least;
}

double most_seconds(const Ladder& ladder) {
  double most = 0.0;
  for (const studies::LadderPoint& point : ladder.points) most = std::max(most, point.seconds);
  return most;
}

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
    add_equal(result.equal, row);
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

Json equal_target_rows(const studies::Comparison& comparison) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < comparison.targets.size(); ++k) {
    for (const studies::MethodResult& result : comparison.methods) {
      if (!result.equal) continue;
      const auto add = [&](const char* basis, const studies::Shot& shot) {
        Json row = {{"basis", basis},
                    {"target", comparison.targets[k].name},
                    {"method", result.method.name},
                    {"pixels", comparison.targets[k].pixels},
                    {"seconds", shot.seconds}};
        add_target(shot.targets[k], row);
        rows.push_back(std::move(row));
      };
      if (result.equal->at_time) add("equal-time", *result.equal->at_time);
      add(result.equal->ladder.reach == Reach::Reached ? "equal-error" : "least-error",
          result.equal->at_error);
    }
  }
  return rows;
}

Json curve_rows(const studies::Comparison& comparison) {
  Json rows = Json::array();
  for (const studies::MethodResult& result : comparison.methods) {
    if (!result.equal) continue;
    for (std::size_t k = 0; k < result.equal->ladder.points.size(); ++k) {
      const studies::LadderPoint& point = result.equal->ladder.points[k];
      Json row = method_row(result.method);
      row["step"] = point.rung;
      row["cpu_seconds"] = point.seconds;
      row["relative_rmse"] = point.error;
      row["standard_error"] = result.equal->differences[k].standard_error;
      row["bias"] = result.equal->differences[k].bias;
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
                {"bias", result.difference.bias},
                {"least_rmse", result.equal ? Json(least_error(result.equal->ladder)) : Json()}};
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

namespace {

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
  switch (ladder.reach) {
    case Reach::Reached: {
      const double seconds = result.equal->at_error.seconds;
      return fmt::format("{:.3g} s, x {:.2g}", seconds, seconds / comparison.equal_seconds);
    }
    case Reach::LevelsOut:
      return fmt::format("never: levels out at {}", percent(least_error(ladder)));
    case Reach::NotWithin:
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
