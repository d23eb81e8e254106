// SPDX-License-Identifier: Apache-2.0
#include "app/accuracy/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/call/memory.h"
#include "app/console.h"
#include "scenes/text/message_text.h"

namespace earthshine::app {
namespace {

std::string quoted(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string("_./=:,@%+-").find(static_cast<char>(c)) != std::string::npos;
  });
  if (plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

using scenes::percent;

Json error_json(const studies::PictureError& error) {
  return {{"error", error.error}, {"low", error.low}, {"high", error.high}, {"bias", error.bias}};
}

Json row_of(const AccuracyTask& task, const AccuracyResult& result, std::size_t k) {
  const studies::MeasuredStep& point = result.points[k];
  const studies::AccuracyStep& step = point.step;
  const studies::StepCost& cost = point.cost;
  const std::vector<std::size_t>& front = result.findings.front;
  const bool solved = cost.patches > 0;
  const auto positive = [](auto value) { return value > 0 ? Json(value) : Json(); };
  return {{"method", step.method},
          {"series", step.series},
          {"setting", step.setting},
          {"options", fmt::format("{}", fmt::join(step.options(), " "))},
          {"error", point.error.error},
          {"error_low", point.error.low},
          {"error_high", point.error.high},
          {"bias", point.error.bias},
          {"below_resolution", point.error.error <= result.resolution},
          {"setting_error", point.setting_error.error},
          {"setting_error_low", point.setting_error.low},
          {"setting_error_high", point.setting_error.high},
          {"estimate", cost.stated.estimate},
          {"bound_95", cost.stated.bound_95},
          {"estimate_cpu_seconds", cost.statement_cpu_seconds},
          {"wall_seconds", cost.wall_seconds},
          {"cpu_seconds", cost.cpu_seconds},
          {"solve_wall_seconds", solved ? Json(cost.solve_wall_seconds) : Json()},
          {"solve_cpu_seconds", solved ? Json(cost.solve_cpu_seconds) : Json()},
          {"memory_mib", cost.memory_bytes / mib},
          {"patches", positive(cost.patches)},
          {"form_factor_rays", positive(cost.form_factor_rays)},
          {"gather_rays", positive(cost.gather_rays)},
          {"camera_samples", cost.camera_samples},
          {"lights", positive(step.lights)},
          {"solve_rays", cost.solve_rays},
          {"picture_rays", cost.picture_rays},
          {"on_front", std::find(front.begin(), front.end(), k) != front.end()},
          {"command", command_of(task, step)}};
}

Json law_json(const studies::SeriesLaw& law) {
  Json points = Json::array();
  for (const studies::ErrorAt& point : law.points) {
    points.push_back({{"x", point.x}, {"error", point.error}});
  }
  Json json = {{"method", law.method}, {"series", law.series}, {"x", law.spent}};
  json["exponent"] = law.law ? Json(law.law->exponent) : Json();
  json["exponent_std_error"] = law.law ? to_json(law.law->exponent_error) : Json();
  json["factor"] = law.law ? Json(law.law->factor) : Json();
  json["floor"] = law.law ? Json(law.law->floor) : Json();
  json["points"] = points;
  return json;
}

Json answer_json(const AccuracyTask& task, const AccuracyResult& result,
                 const studies::Answer& answer) {
  const auto point_json = [&](const std::optional<std::size_t>& index) -> Json {
    if (!index || !answer.is_resolved) return nullptr;
    const studies::MeasuredStep& point = result.points[*index];
    return {{"method", point.step.method},
            {"error", point.error.error},
            {"setting_error", point.setting_error.error},
            {"cpu_seconds", point.cost.cpu_seconds},
            {"wall_seconds", point.cost.wall_seconds},
            {"memory_mib", point.cost.memory_bytes / mib},
            {"command", command_of(task, point.step)}};
  };
  Json methods = Json::object();
  for (const studies::Answer::OfMethod& method : answer.methods) {
    Json json = {{"reached", answer.is_resolved && method.point.has_value()},
                 {"setting", point_json(method.point)},
                 {"setting_apart_from_limit", point_json(method.setting)}};
    if (method.expected_seconds) json["expected_cpu_seconds"] = *method.expected_seconds;
    methods[method.method] = json;
  }
  return {{"wanted", answer.wanted},
          {"reference_fine_enough", answer.is_resolved},
          {"reached", answer.is_resolved && answer.best.has_value()},
          {"setting", point_json(answer.best)},
          {"methods", methods}};
}

std::string worth_sentence(const studies::Worth& worth) {
  if (!worth.ever) return worth.method + " is never the cheapest way.";
  const std::string first =
      fmt::format("{} is the cheapest way down to {}", worth.method, percent(worth.down_to));
  if (worth.then.empty()) return first + ", the least error that was measured.";
  return fmt::format("{}; below that {} is cheaper.", first, worth.then);
}

std::string point_text(const AccuracyTask& task, const studies::MeasuredStep& point) {
  return fmt::format("{}\n          {:.3g} CPU s, {:.0f} MiB; error {}, the setting's {}\n",
                     command_of(task, point.step), point.cost.cpu_seconds,
                     point.cost.memory_bytes / mib, percent(point.error.error),
                     percent(point.setting_error.error));
}

std::string answer_text(const AccuracyTask& task, const AccuracyResult& result,
                        const studies::Answer& answer) {
  std::string text = fmt::format("{:>6}: ", percent(answer.wanted));
  if (!answer.is_resolved) {
    return text + fmt::format("the reference resolves errors from {} on only; give it more time\n",
                              percent(result.resolution));
  }
  if (answer.best) return text + point_text(task, result.points[*answer.best]);
  text += "reached by no setting measured";
  for (const studies::Answer::OfMethod& method : answer.methods) {
    if (!method.expected_seconds) continue;
    text +=
        fmt::format("; paths would take about {} of CPU time", duration(*method.expected_seconds));
  }
  text += "\n";
  for (const studies::Answer::OfMethod& method : answer.methods) {
    // Without the systematic error of the method.
    if (!method.setting || method.method != "radiosity") continue;
    text += "        but for its limit radiosity is there: " +
            point_text(task, result.points[*method.setting]);
  }
  return text;
}

}  // namespace

std::string command_of(const AccuracyTask& task, const studies::AccuracyStep& step) {
  std::vector<std::string> words = {"earthshine",
                                    "render",
                                    task.call.scene.path,
                                    "--camera=" + task.view.camera.name,
                                    "--size",
                                    fmt::format("{}x{}", task.view.columns, task.view.rows)};
  for (const std::string& change : task.call.scene.overrides) {
    if (change.starts_with("quality.")) continue;
    words.insert(words.end(), {"--set", change});
  }
  for (const std::string& word : step.options()) words.push_back(word);
  if (task.view.seed != 1) words.insert(words.end(), {"--seed", std::to_string(task.view.seed)});
  words.insert(words.end(), {"-o", "picture.exr"});
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + quoted(word);
  return text;
}

Json accuracy_json(const AccuracyTask& task, const AccuracyResult& result) {
  Json points = Json::array(), limits = Json::array(), laws = Json::array(), worth = Json::array(),
       answers = Json::array(), front = Json::array(), not_run = Json::array();
  for (std::size_t k = 0; k < result.points.size(); ++k) points.push_back(row_of(task, result, k));
  for (const MethodLimit& limit : result.limits) {
    Json json = {{"method", limit.method}, {"why", limit.why}};
    json.update(error_json(limit.error));
    limits.push_back(json);
  }
  for (const studies::SeriesLaw& law : result.findings.laws) laws.push_back(law_json(law));
  for (const studies::Worth& w : result.findings.worth) {
    worth.push_back({{"method", w.method},
                     {"cheapest_down_to", w.ever ? Json(w.down_to) : Json()},
                     {"then", w.then.empty() ? Json() : Json(w.then)},
                     {"sentence", worth_sentence(w)}});
  }
  for (const studies::Answer& answer : result.findings.answers) {
    answers.push_back(answer_json(task, result, answer));
  }
  for (const std::size_t k : result.findings.front) front.push_back(k);
  for (const NotRun& step : result.not_run) {
    not_run.push_back({{"step", step.name}, {"why", step.why}});
  }
  const bool measured = result.nothing.empty();
  return {{"study", "accuracy"},
          {"version", EARTHSHINE_VERSION},
          {"scene", task.call.scene.path},
          {"set", task.call.scene.overrides},
          {"camera", task.view.camera.name},
          {"columns", task.view.columns},
          {"rows", task.view.rows},
          {"seed", task.view.seed},
          {"nothing_to_measure", measured ? Json() : Json(result.nothing)},
          {"pixels_compared", result.pixels},
          {"mean_luminance_cd_m2", result.mean_luminance},
          {"keys_left_out", studies::replaced_keys(task.loaded.scene.quality)},
          {"reference",
           {{"paths_per_pixel", result.reference_paths},
            {"pictures", 2},
            {"resolution", measured ? Json(result.resolution) : Json()},
            {"wanted_resolution", measured ? Json(result.wanted_resolution) : Json()},
            {"cpu_seconds", result.reference_cpu_seconds}}},
          {"warnings", task.loaded.scene.warnings},
          {"limits", limits},
          {"points", points},
          {"front", front},
          {"laws", laws},
          {"worth", worth},
          {"wanted", answers},
          {"not_run", not_run}};
}

std::string accuracy_text(const AccuracyTask& task, const AccuracyResult& result) {
  if (!result.nothing.empty()) return "Nothing was measured: " + result.nothing + ".\n";
  std::string text = fmt::format("{:<34} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9} {:>6}\n", "setting",
                                 "error", "setting's", "bound", "CPU s", "wall s", "MiB", "front");
  for (std::size_t k = 0; k < result.points.size(); ++k) {
    const studies::MeasuredStep& point = result.points[k];
    const std::vector<std::size_t>& front = result.findings.front;
    const bool first = std::find(front.begin(), front.end(), k) != front.end();
    text += fmt::format("{:<34} {:>8} {:>9} {:>9} {:>9.2f} {:>9.2f} {:>9.1f} {:>6}\n",
                        point.step.name(), percent(point.error.error),
                        percent(point.setting_error.error), percent(point.cost.stated.bound_95),
                        point.cost.cpu_seconds, point.cost.wall_seconds,
                        point.cost.memory_bytes / mib, first ? "*" : "");
  }
  text += fmt::format(
      "\nReference: two pictures of {} paths a pixel, their noise subtracted; errors below {} "
      "are not resolved.\n",
      result.reference_paths, percent(result.resolution));
  for (const MethodLimit& limit : result.limits) {
    text +=
        fmt::format("Limit of {}: {} ({}).\n", limit.method, percent(limit.error.error), limit.why);
  }
  text += "\n";
  for (const studies::SeriesLaw& law : result.findings.laws) {
    if (!law.law) {
      if (law.points.size() > 1) {
        text += fmt::format("{} {}: the points follow no power law\n", law.method, law.series);
      }
      continue;
    }
    text += fmt::format(
        "{} {}: error ~ ({})^{:.2f}{}{}\n", law.method, law.series, law.spent, -law.law->exponent,
        law.law->exponent_error ? fmt::format(" +- {:.2f}", *law.law->exponent_error) : "",
        law.law->floor > 0.0 ? ", floor " + percent(law.law->floor) : "");
  }
  text += "\n";
  for (const studies::Worth& worth : result.findings.worth) text += worth_sentence(worth) + "\n";
  text += "\nThe cheapest setting measured for a wanted error:\n";
  for (const studies::Answer& answer : result.findings.answers) {
    text += answer_text(task, result, answer);
  }
  for (const NotRun& step : result.not_run) {
    text += fmt::format("Not run: {}: {}.\n", step.name, step.why);
  }
  return text;
}

}  // namespace earthshine::app
