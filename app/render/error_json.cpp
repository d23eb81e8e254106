// SPDX-License-Identifier: Apache-2.0
#include "app/render/error_json.h"

#include <fmt/format.h>

#include "app/console.h"
#include "scenes/text/message_text.h"

namespace earthshine::app {
namespace {

using raytrace::ErrorEstimate;

struct NamedPart {
  const char* name;
  const char* words;
  raytrace::ErrorEstimate part;
};
using Parts = std::vector<NamedPart>;

Parts parts_of(const raytrace::ErrorParts& parts) {
  return {{"gather_noise", "gather", parts.gather},
          {"interreflection", "interreflection", parts.interreflection},
          {"lobes", "lobes", parts.lobes},
          {"camera_samples", "camera samples", parts.camera_samples}};
}
Parts parts_of(const raytrace::SolutionError& parts) {
  return {{"form_factor_noise", "form factors", parts.form_factors},
          {"patch_size", "patches", parts.patches},
          {"solver_residual", "solver", parts.solver},
          {"lamp_sampling", "lamps", parts.lamps}};
}

Json json_of(const raytrace::ErrorEstimate& error) {
  return {{"estimate", error.estimate}, {"bound_95", error.bound_95}};
}

// Null if nothing is visible that could be wrong.
Json json_of(const raytrace::ErrorEstimate& error, bool known) {
  return known ? json_of(error) : Json{{"estimate", nullptr}, {"bound_95", nullptr}};
}

Json json_of(const raytrace::TargetError& target) {
  Json json = json_of(target.error, target.luminance > 0.0 || target.error.estimate > 0.0);
  json["name"] = target.name;
  json["pixels"] = target.pixels;
  json["luminance_cd_m2"] = target.pixels > 0 ? Json(target.luminance) : Json();
  return json;
}

Json json_of(const raytrace::ErrorEstimate& total, bool known, const Parts& parts,
             std::optional<double> wanted, const std::vector<std::string>& not_captured) {
  Json json = json_of(total, known);
  json["wanted"] = to_json(wanted);
  json["parts"] = Json::object();
  for (const NamedPart& part : parts) json["parts"][part.name] = json_of(part.part, known);
  json["not_captured"] = not_captured;
  return json;
}

// why_unknown: the reason, if unknown.
std::string text_of(const raytrace::ErrorEstimate& total, bool known, const char* why_unknown,
                    const Parts& parts, const std::vector<std::string>& not_captured) {
  std::string text = fmt::format("the error is unknown: {}", why_unknown);
  if (known) {
    text = fmt::format("error {}, 95 % sure below {}:", scenes::percent(total.estimate),
                       scenes::percent(total.bound_95));
    for (const NamedPart& part : parts) {
      const double percent = 100.0 * part.part.estimate;
      if (percent >= 0.005) text += fmt::format(" {} {},", part.words, scenes::two_digits(percent));
    }
    text.pop_back();
  }
  for (const std::string& missing : not_captured) text += "\n  not in it: " + missing;
  return text;
}

const char* words_of(raytrace::Limit limit) {
  switch (limit) {
    case raytrace::Limit::None:
      return "";
    case raytrace::Limit::Time:
      return "--time-limit came first";
    case raytrace::Limit::Memory:
      return "memory came first (--max-memory, or what is free)";
    case raytrace::Limit::Settings:
      return "quality.max_patches, quality.form_factor_rays with quality.patch_edge (or refine = "
             "false) is given, which wins over it, or a picture has as many quality.gather_rays as "
             "are set (--indirect paths); leave it out, or raise these";
    case raytrace::Limit::Steps:
      return "no end in sight after several tries";
    case raytrace::Limit::Stopped:
      return "it was stopped";
    case raytrace::Limit::Ledger:
      return "the ledger lacks light that no ray finds again, as on a spot beside a lamp that "
             "mirrors alone show; move such a lamp off the surface";
    case raytrace::Limit::Given:
      return "--solution is used unchanged; leave it out to solve again";
  }
  return "";
}

void add_steps(Json& json, raytrace::Limit limit, const std::vector<raytrace::Step>& steps) {
  json["limit"] = limit == raytrace::Limit::None ? Json() : Json(raytrace::limit_name(limit));
  json["steps"] = Json::array();
  for (const raytrace::Step& step : steps) {
    Json one = {{"stage", step.stage}};
    if (step.patches > 0) {
      one["patches"] = step.patches;
      one["form_factor_rays"] = step.form_factor_rays;
    }
    if (step.gather_rays > 0) one["gather_rays"] = step.gather_rays;
    one["asked"] = step.asked;
    if (step.estimate > 0.0) one["estimate"] = step.estimate;
    json["steps"].push_back(one);
  }
}

// The settings that reach the error, or why it is not reached.
std::string choice_text(raytrace::Limit limit, const std::vector<raytrace::Step>& steps,
                        std::optional<double> wanted, double seconds_to_go) {
  if (!wanted || steps.empty()) return "";
  std::string text;
  for (const raytrace::Step& step : steps) {
    text += fmt::format("\n  {}:", step.stage);
    if (step.patches > 0) {
      text += fmt::format(" {} patches, {} rays each,", step.patches, step.form_factor_rays);
    }
    if (step.gather_rays > 0) text += fmt::format(" {} gather rays a pixel,", step.gather_rays);
    if (step.estimate > 0.0) text += fmt::format(" leaves {},", scenes::percent(step.estimate));
    text.pop_back();
  }
  if (limit != raytrace::Limit::None) {
    text += fmt::format("\n  the wanted {} is not reached: {}", scenes::percent(*wanted),
                        words_of(limit));
  }
  if (seconds_to_go > 0.0) {
    text += fmt::format("; it needs about {} more", duration(seconds_to_go));
  }
  return text;
}

std::string weights_text(const raytrace::SurfaceError& error) {
  return fmt::format(
      "\n  weighted as in pictures: above four times the mean in proportion, over spots of 1/256 "
      "of "
      "the scene's diagonal; {} at points, unweighted",
      scenes::percent(error.unweighted));
}

}  // namespace

Json error_json(const Drawn& drawn, std::optional<double> wanted) {
  const raytrace::ErrorBudget& budget = drawn.errors;
  Json json =
      json_of(budget.total, budget.pixels > 0, parts_of(budget.parts), wanted, budget.not_captured);
  add_steps(json, drawn.limit, drawn.steps);
  json["seconds_to_go"] = drawn.seconds_to_go > 0.0 ? Json(drawn.seconds_to_go) : Json();
  json["targets"] = Json::array();
  for (const auto& target : budget.targets) json["targets"].push_back(json_of(target));
  return json;
}

Json error_json(const Solved& light, std::optional<double> wanted) {
  const raytrace::SurfaceError& error = light.surface;
  Json json =
      json_of(error.parts.total(), error.known, parts_of(error.parts), wanted, error.not_captured);
  json["unweighted"] = error.known ? Json(error.unweighted) : Json();
  add_steps(json, light.limit, light.steps);
  return json;
}

void add_errors(base::ExrHeader& header, const Drawn& drawn) {
  const raytrace::ErrorBudget& budget = drawn.errors;
  const auto number = [&](const std::string& name, double value) {
    header.numbers.emplace_back("earthshine:error." + name, static_cast<float>(value));
  };
  if (budget.pixels > 0) {
    const raytrace::ErrorEstimate total = budget.total;
    number("estimate", total.estimate);
    number("bound_95", total.bound_95);
    for (const NamedPart& part : parts_of(budget.parts)) number(part.name, part.part.estimate);
  }
  header.text.emplace_back("earthshine:error.not_captured",
                           fmt::format("{}", fmt::join(budget.not_captured, "; ")));
  if (drawn.limit != raytrace::Limit::None) {
    header.text.emplace_back("earthshine:error.limit", raytrace::limit_name(drawn.limit));
  }
}

std::string error_text(const Drawn& drawn, std::optional<double> wanted) {
  const raytrace::ErrorBudget& budget = drawn.errors;
  return text_of(budget.total, budget.pixels > 0, "no pixel shows reflected light alone",
                 parts_of(budget.parts), budget.not_captured) +
         (budget.pixels > 0 ? choice_text(drawn.limit, drawn.steps, wanted, drawn.seconds_to_go)
                            : "");
}

std::string error_text(const Solved& light, std::optional<double> wanted) {
  const raytrace::SurfaceError& error = light.surface;
  if (!error.known && light.limit == raytrace::Limit::Stopped) {
    return "no error is known: it was stopped before one was looked for";
  }
  return text_of(error.parts.total(), error.known, "no surface reflects light",
                 parts_of(error.parts), error.not_captured) +
         (error.known ? weights_text(error) + choice_text(light.limit, light.steps, wanted, 0.0)
                      : "");
}

double seconds_to_go(const Solved& light, std::optional<double> wanted, double seconds) {
  using raytrace::Limit;
  const bool more_helps =
      light.limit == raytrace::Limit::Time || light.limit == raytrace::Limit::Memory ||
      light.limit == raytrace::Limit::Steps || light.limit == raytrace::Limit::Stopped;
  if (!wanted || !more_helps || light.steps.empty()) return 0.0;
  const double over = light.steps.back().estimate / *wanted;
  return std::max(0.0, seconds * (over * over - 1.0));
}

void check_reached(const SceneInput& call, raytrace::Limit limit, double wanted) {
  if (!call.wants_error() || limit == raytrace::Limit::None) return;
  throw StoppedShort(fmt::format("{}: the wanted error of {} is not reached: {}", call.path,
                                 scenes::percent(wanted), words_of(limit)));
}

}  // namespace earthshine::app
