// SPDX-License-Identifier: Apache-2.0
#include "studies/accuracy/ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "scenes/effects/quality.h"

namespace earthshine::studies {
namespace {

using raytrace::Indirect;

// Settings for a wanted error, as factors on it: from twenty down to a little less than one.
constexpr double error_steps[] = {20.0, 10.0, 5.0, 3.0, 2.0, 1.4, 1.0, 0.7};
constexpr double edge_steps[] = {8.0, 4.0, 2.0, 1.0, 0.5};  // of the edge for an error of 0.02
constexpr int form_factor_steps[] = {16, 64, 256, 1024, 4096};
constexpr int gather_steps[] = {8, 16, 32, 64, 128};  // 8 is the minimum
constexpr int camera_steps[] = {4, 16, 64, 256};

// Rounds: 0.05 and not 0.050000000000000003.
double tidy(double value) { return std::stod(fmt::format("{:.3g}", value)); }

class Ladder {
 public:
  explicit Ladder(const scenes::Scene& scene) {
    kept_.denoise = scene.quality.denoise;
    kept_.solver_tolerance = scene.quality.solver_tolerance;
    usual_edge_m_ = scenes::resolve_quality(scene, {}).patch_edge_m;
  }

  AccuracyStep& add(const char* method, const char* series, Indirect indirect, double setting,
                    double work) {
    AccuracyStep step;
    step.method = method;
    step.series = series;
    step.setting = setting;
    step.indirect = indirect;
    step.quality = kept_;
    step.work = work;
    series_[series + std::string(method)].push_back(steps_.size());
    steps_.push_back(std::move(step));
    return steps_.back();
  }

  [[nodiscard]] double usual_edge_m() const { return usual_edge_m_; }

  // The n-th step of every series before the (n+1)-th of any.
  [[nodiscard]] std::vector<AccuracyStep> in_order() const {
    std::vector<std::pair<std::size_t, std::size_t>> order;
    for (const auto& [name, members] : series_) {
      for (std::size_t level = 0; level < members.size(); ++level) {
        order.emplace_back(level, members[level]);
      }
    }
    std::sort(order.begin(), order.end());
    std::vector<AccuracyStep> steps;
    for (const auto& [level, index] : order) steps.push_back(steps_[index]);
    return steps;
  }

 private:
  scenes::Quality kept_;
  double usual_edge_m_ = 0.0;
  std::vector<AccuracyStep> steps_;
  std::map<std::string, std::vector<std::size_t>> series_;
};

void add_radiosity(Ladder& ladder, const scenes::Effects& effects, const LadderOptions& options) {
  constexpr const char* method = "radiosity";
  constexpr auto how = Indirect::Radiosity;
  double before = 0.0;
  for (const double times : error_steps) {
    const double error = tidy(std::min(1.0, times * options.finest));
    if (error == before) continue;
    before = error;
    // The parts that do not depend on the error cost about as much as an error of 0.03.
    ladder.add(method, series::error, how, error, 1e3 + 1.0 / (error * error)).quality.error =
        error;
  }
  if (effects.solution) {
    for (const double times : edge_steps) {
      const double edge_m = tidy(times * ladder.usual_edge_m());
      // The number of patches is proportional to 1 / edge^2, but each facet has at least one.
      ladder.add(method, series::patches, how, edge_m, 1.0 + 0.5 / (times * times))
          .quality.patch_edge_m = edge_m;
    }
    for (const int rays : form_factor_steps) {
      // A solve with few rays costs as much as its other parts.
      ladder.add(method, series::form_factor_rays, how, rays, rays + 500.0)
          .quality.form_factor_rays = rays;
    }
  }
  if (effects.solution || effects.earth_by_gather) {
    for (const int rays : gather_steps) {
      ladder.add(method, series::gather_rays, how, rays, rays + 50.0).quality.gather_rays = rays;
    }
  }
  for (const int samples : camera_steps) {
    ladder.add(method, series::camera_samples, how, samples, samples + 10.0)
        .quality.camera_samples = samples;
  }
}

}  // namespace

std::string AccuracyStep::name() const {
  if (method == "direct") return method;
  return fmt::format("{} {}={:g}", method, series, setting);
}

std::vector<std::string> AccuracyStep::options() const {
  std::vector<std::string> words;
  const auto set = [&words](const char* key, const auto& value) {
    if (value) words.insert(words.end(), {"--set", fmt::format("quality.{}={}", key, *value)});
  };
  if (indirect == Indirect::Paths) words = {"--indirect", "paths"};
  if (indirect == Indirect::None) words = {"--indirect", "none"};
  if (indirect == Indirect::Distributed) {
    words = {"--indirect", "distributed", "--distributed-lights", std::to_string(lights)};
  }
  if (quality.error) words.insert(words.end(), {"--error", fmt::format("{}", *quality.error)});
  set(series::patches, quality.patch_edge_m);
  set(series::form_factor_rays, quality.form_factor_rays);
  set(series::gather_rays, quality.gather_rays);
  set(series::camera_samples, quality.camera_samples);
  return words;
}

std::vector<AccuracyStep> accuracy_ladder(const scenes::Scene& scene,
                                          const scenes::Effects& effects,
                                          const LadderOptions& options) {
  Ladder ladder(scene);
  add_radiosity(ladder, effects, options);
  ladder.add("direct", series::error, Indirect::None, 1.0, 1.0);
  bool wide = effects.earth;
  for (std::size_t kind = 0; kind < scenes::lamp_kinds; ++kind) {
    wide =
        wide || (effects.lamp_kind[kind] && scenes::is_wide(static_cast<scenes::LampKind>(kind)));
  }
  if (wide) {
    for (const int n : options.lights) {
      ladder.add("distributed", series::lights, Indirect::Distributed, n, n + 10.0).lights = n;
    }
  }
  for (const int n : options.samples) {
    AccuracyStep& step = ladder.add("paths", series::samples, Indirect::Paths, n, n);
    step.quality.gather_rays = n;
  }
  return ladder.in_order();
}

std::vector<std::string> replaced_keys(const scenes::Quality& quality) {
  std::vector<std::string> keys;
  const auto add_if = [&keys](const char* key, bool set) {
    if (set) keys.emplace_back(key);
  };
  add_if("error", quality.error.has_value());
  add_if("patch_edge", quality.patch_edge_m.has_value());
  add_if("max_patches", quality.max_patches.has_value());
  add_if("refine", quality.refine.has_value());
  add_if("form_factor_rays", quality.form_factor_rays.has_value());
  add_if("gather_rays", quality.gather_rays.has_value());
  add_if("camera_samples", quality.camera_samples.has_value());
  return keys;
}

double expected_seconds(const AccuracyStep& step, const std::vector<Taken>& taken) {
  double seconds = 0.0, least = taken.empty() ? 0.0 : taken.front().cpu_seconds;
  for (const Taken& earlier : taken) {
    least = std::min(least, earlier.cpu_seconds);
    const bool same = earlier.step.series == step.series && earlier.step.method == step.method;
    if (same) seconds = earlier.cpu_seconds * step.work / earlier.step.work;
  }
  return seconds > 0.0 ? seconds : least;
}

}  // namespace earthshine::studies
