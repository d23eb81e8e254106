// SPDX-License-Identifier: Apache-2.0
#include "studies/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "raytrace/distributed_area.h"

namespace earthshine::studies {
namespace {

using raytrace::Indirect;

// Infinite where only the reference is black, 1 where both are.
double ratio(double value, double reference) {
  if (reference > 0.0) return value / reference;
  return value > 0.0 ? std::numeric_limits<double>::infinity() : 1.0;
}

bool far_off(double luminance_ratio) {
  return luminance_ratio > misleading_factor || luminance_ratio < 1.0 / misleading_factor;
}

raytrace::RenderOptions render_options(const CompareOptions& options, const Method& method,
                                       bool is_reference) {
  raytrace::RenderOptions render;
  render.columns = options.columns;
  render.rows = options.rows;
  render.gather_rays = options.gather_rays;
  render.indirect = method.indirect;
  if (method.distributed_lights > 0) render.distributed_lights = method.distributed_lights;
  render.distributed_over = method.distributed_over;
  render.seed = options.seed;
  if (is_reference) {
    render.gather_rays *= options.reference_factor;
    render.seed = options.seed + 1;
    render.aovs = {"object"};
  }
  return render;
}

}  // namespace

std::vector<Method> compare_methods(std::vector<int> lights, const std::string& area) {
  if (lights.empty() || *std::min_element(lights.begin(), lights.end()) < fewest_lights) {
    throw base::Error(base::Blame::Input, "study compare", "lights are missing",
                      fmt::format("at least one number of lights, each {} or more", fewest_lights));
  }
  std::sort(lights.begin(), lights.end());
  lights.erase(std::unique(lights.begin(), lights.end()), lights.end());
  std::vector<Method> methods = {{reference_name, Indirect::Radiosity, 0},
                                 {"radiosity", Indirect::Radiosity, 0}};
  for (const int n : lights) {
    methods.push_back({"distributed-" + std::to_string(n), Indirect::Distributed, n});
  }
  for (const int n : lights) {
    if (area.empty()) break;
    methods.push_back({"area-" + std::to_string(n), Indirect::Distributed, n, area});
  }
  methods.push_back({"direct", Indirect::None, 0});
  return methods;
}

PictureDifference picture_difference(const base::Image& image, const base::Image& reference,
                                     const ObjectMap& map) {
  const std::vector<float> value = base::luminance_of(image);
  const std::vector<float> right = base::luminance_of(reference);
  PictureDifference result;
  double squares = 0.0, sum = 0.0, right_sum = 0.0;
  std::size_t off = 0;
  for (std::size_t i = 0; i < map.object.size(); ++i) {
    if (map.object[i] == no_object) continue;
    ++result.pixels;
    const double difference = double(value[i]) - double(right[i]);
    squares += difference * difference;
    sum += difference;
    right_sum += double(right[i]);
    if (far_off(ratio(double(value[i]), double(right[i])))) ++off;
  }
  if (result.pixels == 0) return result;
  const auto n = static_cast<double>(result.pixels);
  result.off_share = static_cast<double>(off) / n;
  if (right_sum <= 0.0) return result;
  result.relative_rmse = std::sqrt(squares / n) / (right_sum / n);
  result.bias = sum / right_sum;
  return result;
}

TargetDifference target_difference(const TargetLight& light, const TargetLight& reference) {
  TargetDifference difference;
  difference.light = light;
  difference.luminance_ratio = ratio(light.luminance, reference.luminance);
  difference.misleads = far_off(difference.luminance_ratio);
  if (light.contrast && reference.contrast) {
    difference.contrast_difference = *light.contrast - *reference.contrast;
    if (std::abs(*difference.contrast_difference) > misleading_contrast) difference.misleads = true;
  } else if (light.contrast.has_value() != reference.contrast.has_value()) {
    difference.misleads = true;  // one surround is black, the other is not
  }
  return difference;
}

Comparison compare(const StudyScene& study, const scenes::Camera& camera,
                   const CompareOptions& options, const StageListener& listen) {
  const auto begin_stage = [&](const std::string& stage) {
    return listen ? listen(stage) : raytrace::Progress{};
  };
  Comparison comparison;
  (void)raytrace::earth_area(study.scene, options.distributed_over);  // a wrong one before the work
  (void)begin_stage("radiosity solution");
  const radiosity::Solution solution =
      radiosity::solve(study.scene, study.groups, study.effects, study.query, options.solver);
  comparison.solution = solution.report;
  double solve_seconds = 0.0;
  for (const auto& [stage, seconds] : solution.report.seconds) solve_seconds += seconds;

  for (const Method& method :
       compare_methods(options.distributed_lights, options.distributed_over)) {
    MethodResult result;
    result.method = method;
    const raytrace::RenderOptions render =
        render_options(options, method, comparison.methods.empty());
    result.frame = raytrace::render(study.scene, study.groups, study.effects, study.query, solution,
                                    camera, render, begin_stage(method.name));
    result.render_seconds = result.frame.report.seconds;
    if (method.indirect == Indirect::Radiosity) result.solve_seconds = solve_seconds;
    comparison.methods.push_back(std::move(result));
  }

  const base::Image& reference = comparison.reference().frame.image;
  const ObjectMap map = object_map(reference);
  comparison.targets = find_targets(study.scene, camera, map);
  const std::vector<float> right = base::luminance_of(reference);
  for (MethodResult& result : comparison.methods) {
    result.difference = picture_difference(result.frame.image, reference, map);
    const std::vector<float> luminance = base::luminance_of(result.frame.image);
    for (const TargetView& view : comparison.targets) {
      const auto light = measure_light(view, luminance);
      result.targets.push_back(
          light ? std::optional(target_difference(*light, *measure_light(view, right)))
                : std::nullopt);
    }
  }
  return comparison;
}

namespace {

std::string contrast_text(const TargetLight& light) {
  if (!light.contrast) return "undefined";
  const double rounded = std::round(100.0 * *light.contrast) / 100.0;
  return fmt::format("{:+.2f}", rounded == 0.0 ? 0.0 : rounded);  // never "-0.00"
}

// "3.1 instead of 5.2 cd/m2 (x 0.60), contrast -0.20 instead of +0.10"
std::string figures(const TargetDifference& found, const TargetLight& right) {
  return fmt::format("{:.3g} instead of {:.3g} cd/m2 (x {:.2f}), contrast {} instead of {}",
                     found.light.luminance, right.luminance, found.luminance_ratio,
                     contrast_text(found.light), contrast_text(right));
}

// The last of those over the disc: compare_methods lists them from 2 on by rising N.
std::size_t most_lights(const std::vector<MethodResult>& methods) {
  std::size_t k = 2;
  while (methods[k + 1].method.indirect == Indirect::Distributed &&
         methods[k + 1].method.distributed_over.empty()) {
    ++k;
  }
  return k;
}

TargetVerdict judge(const Comparison& comparison, std::size_t target) {
  const std::string& name = comparison.targets[target].name;
  const auto& right = comparison.reference().targets[target];
  if (!right) {
    const bool hidden = comparison.targets[target].pixels_alone > 0;
    return {Verdict::NotInView, name + (hidden ? ": hidden by other objects." : ": not in view.")};
  }
  const std::vector<MethodResult>& methods = comparison.methods;
  const std::size_t most = most_lights(methods);
  const MethodResult& best = methods[most];
  const TargetDifference& found = *best.targets[target];
  const std::string numbers = figures(found, right->light);
  const int n = best.method.distributed_lights;
  if (methods[1].targets[target]->misleads) {
    return {Verdict::Undecided,
            fmt::format("{}: too noisy to tell on {} pixels, even the radiosity picture differs "
                        "from its reference; {} distributed lights give {}.",
                        name, comparison.targets[target].pixels, n, numbers)};
  }
  if (found.misleads) {
    return {Verdict::Misled,
            fmt::format("{}: {} distributed lights would have misled, {}.", name, n, numbers)};
  }
  // The fewest lights from which on none misleads.
  int enough = n;
  for (std::size_t k = most; k >= 2 && !methods[k].targets[target]->misleads; --k) {
    enough = methods[k].method.distributed_lights;
  }
  const std::string from = enough == n ? "" : fmt::format(", nor would {}", enough);
  return {Verdict::NotMisled, fmt::format("{}: {} distributed lights would not have misled{}, {}.",
                                          name, n, from, numbers)};
}

}  // namespace

std::vector<TargetVerdict> judge_approximation(const Comparison& comparison) {
  std::vector<TargetVerdict> verdicts;
  for (std::size_t target = 0; target < comparison.targets.size(); ++target) {
    verdicts.push_back(judge(comparison, target));
  }
  return verdicts;
}

}  // namespace earthshine::studies
