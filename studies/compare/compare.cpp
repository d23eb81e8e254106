// SPDX-License-Identifier: Apache-2.0
#include "studies/compare/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/parallel.h"
#include "raytrace/light/distributed_area.h"
#include "scenes/light/lamp_light.h"
#include "studies/compare/target_differences.h"

namespace earthshine::studies {
namespace {

using raytrace::Indirect;

bool shines(const scenes::Scene& scene, std::uint32_t object) {
  const scenes::Object& o = scene.objects[object];
  for (std::uint32_t t = o.first_triangle; t < o.first_triangle + o.triangle_count; ++t) {
    if (scene.materials[scene.triangles[t].material].emits()) return true;
  }
  return false;
}

bool has_wide_sources(const scenes::World& study) {
  const scenes::Scene& scene = study.scene;
  return study.effects.earth ||
         std::any_of(scene.lamps.begin(), scene.lamps.end(),
                     [](const scenes::Lamp& lamp) { return scenes::is_wide(lamp.kind); }) ||
         std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const scenes::Material& material) { return material.emits(); });
}

class Comparing {
 public:
  Comparing(const scenes::World& study, const scenes::Camera& camera, const CompareOptions& options,
            const raytrace::StageListener& listen)
      : study_(study), camera_(camera), options_(options), listen_(listen) {}

  Comparison run() {
    (void)raytrace::earth_area(study_.scene,
                               options_.distributed_over);  // checks the area before the work
    const auto methods = compare_methods(options_.distributed_lights, options_.distributed_over);
    comparison_.wide_sources = has_wide_sources(study_);
    take_references(methods.front());
    for (std::size_t k = 1; k < methods.size(); ++k) {
      at_the_settings(methods[k], methods.size() - k);
    }
    return std::move(comparison_);
  }

 private:
  [[nodiscard]] raytrace::Progress begin_stage(const std::string& stage) const {
    return listen_ ? listen_(stage) : raytrace::Progress{};
  }

  // share_of_rest: of the time that is left, for this picture.
  [[nodiscard]] raytrace::Frame draw(const radiosity::Solution& solution,
                                     raytrace::RenderOptions render, const std::string& stage,
                                     double share_of_rest, const std::string& method) {
    if (options_.time_limit_s > 0.0) {
      const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - start_;
      const double left = options_.time_limit_s - gone.count();
      render.time_limit_s = std::max(1e-3, share_of_rest * left);
    }
    raytrace::Frame frame = raytrace::render(study_, solution, camera_, render, begin_stage(stage));
    const bool ended = frame.report.finished_share < 1.0 || frame.report.growth > 1.0;
    std::vector<std::string>& stopped = comparison_.stopped;
    if (options_.time_limit_s > 0.0 && ended && (stopped.empty() || stopped.back() != method)) {
      stopped.push_back(method);
    }
    return frame;
  }
  [[nodiscard]] radiosity::Solution solve(const radiosity::SolveOptions& solver,
                                          const std::string& stage) const {
    (void)begin_stage(stage);
    return radiosity::solve(study_, solver);
  }

  void take_references(const Method& method) {
    MethodResult result;
    result.method = method;
    for (const std::uint64_t k : {1U, 2U}) {
      const std::string stage = fmt::format("{} {}", reference_name, k);
      const double begin = base::cpu_seconds();
      const radiosity::Solution solution =
          solve(reference_solver(options_.solver, k), stage + ", solution");
      comparison_.reference_patches = solution.report.patches;
      for (const auto& [name, seconds] : solution.report.seconds) result.solve_seconds += seconds;
      const double solved = base::cpu_seconds();
      result.solve_cpu_seconds += solved - begin;
      // A quarter of the time for each reference.
      raytrace::Frame frame = draw(solution, compare_picture(options_, method, k), stage,
                                   k == 1 ? 0.25 : 1.0 / 3.0, method.name);
      result.render_cpu_seconds += base::cpu_seconds() - solved;
      result.render_seconds += frame.report.seconds;
      const std::vector<float> luminance = base::luminance_of(frame.image);
      (k == 1 ? pair_.first : pair_.second).luminance.assign(luminance.begin(), luminance.end());
      (k == 1 ? reflected_.first : reflected_.second) = reflected_light(frame);
      if (k == 1) {
        result.frame = std::move(frame);
        continue;
      }
      result.frame.report.rays += frame.report.rays;
      result.frame.report.relative_noise =
          0.5 * std::hypot(result.frame.report.relative_noise, frame.report.relative_noise);
      for (const char* colour : {"R", "G", "B"}) average(colour, frame.image, result.frame.image);
    }
    base::Image& image = result.frame.image;
    comparison_.map = object_map(image);
    comparison_.targets = find_targets(study_.scene, camera_, comparison_.map);
    for (const TargetView& view : comparison_.targets) {
      comparison_.target_shines.push_back(shines(study_.scene, view.object));
    }
    mean_ = base::luminance_of(image);
    counted_ = counted_pixels(reflected_);
    for (std::size_t p = 0; p < counted_.size(); ++p) {
      mean_reflected_.push_back(static_cast<float>(
          (reflected_.first.luminance[p] + reflected_.second.luminance[p]) / 2.0));
    }
    comparison_.reference_noise = noise_of_mean(reflected_, counted_);
    result.error.pixels =
        static_cast<std::size_t>(std::count(counted_.begin(), counted_.end(), true));
    for (const TargetView& view : comparison_.targets) {
      const auto light = measure_light(view, mean_);
      result.targets.push_back(light ? std::optional(target_difference(*light, *light))
                                     : std::nullopt);
    }
    comparison_.methods.push_back(std::move(result));
  }

  static void average(const char* colour, const base::Image& other, base::Image& image) {
    const std::vector<float>& more = other.find(colour)->values;
    for (base::Channel& channel : image.channels) {
      if (channel.name != colour) continue;
      for (std::size_t i = 0; i < more.size(); ++i) {
        channel.values[i] = 0.5F * (channel.values[i] + more[i]);
      }
    }
  }

  void at_the_settings(const Method& method, std::size_t to_come) {
    MethodResult result;
    result.method = method;
    radiosity::Solution solution;
    const double begin = base::cpu_seconds();
    if (method.indirect == Indirect::Radiosity) {
      solution = solve(options_.solver, "radiosity solution");
      comparison_.solution = solution.report;
      for (const auto& [stage, seconds] : solution.report.seconds) result.solve_seconds += seconds;
      result.solve_cpu_seconds = base::cpu_seconds() - begin;
    }
    const double solved = base::cpu_seconds();
    result.frame = draw(solution, compare_picture(options_, method), method.name,
                        1.0 / static_cast<double>(to_come), method.name);
    result.render_cpu_seconds = base::cpu_seconds() - solved;
    result.render_seconds = result.frame.report.seconds;
    result.error = picture_error(result.frame.error.luminance, reflected_, counted_);
    result.off_share = off_share(result.frame.error.luminance, mean_reflected_, counted_);
    result.targets = target_differences(result.frame.image, comparison_.targets, pair_, mean_);
    comparison_.methods.push_back(std::move(result));
  }

  const scenes::World& study_;
  const scenes::Camera& camera_;
  const CompareOptions& options_;
  const raytrace::StageListener& listen_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  ReferencePair pair_, reflected_;  // of all light; without that straight from the sources
  std::vector<float> mean_, mean_reflected_;  // luminance of the pairs' means
  std::vector<bool> counted_;                 // pixels of `reflected_`
  Comparison comparison_;
};

}  // namespace

raytrace::RenderOptions compare_picture(const CompareOptions& options, const Method& method,
                                        std::uint64_t reference) {
  raytrace::RenderOptions render;
  render.columns = options.columns;
  render.rows = options.rows;
  render.gather_rays = options.gather_rays;
  render.camera_samples = options.camera_samples;
  render.indirect = method.indirect;
  render.error = options.error;
  if (method.distributed_lights > 0) render.distributed_lights = method.distributed_lights;
  render.distributed_over = method.distributed_over;
  render.seed = options.seed + reference;
  render.aovs = {"variance"};
  if (reference == 0) return render;
  if (reference == 1) render.aovs = {"object"};
  render.error *= 0.5;
  render.gather_rays *= options.reference_factor;
  render.camera_samples *= options.reference_factor;
  render.denoise = options.error > 0.0;
  return render;
}

Comparison compare(const scenes::World& study, const scenes::Camera& camera,
                   const CompareOptions& options, const raytrace::StageListener& listen) {
  return Comparing(study, camera, options, listen).run();
}

}  // namespace earthshine::studies
