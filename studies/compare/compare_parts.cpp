// SPDX-License-Identifier: Apache-2.0
// The parts of the comparison that draw nothing: errors, targets, settings.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "studies/compare/compare.h"

namespace earthshine::studies {
namespace {

using raytrace::Indirect;

bool far_off(double ratio) { return ratio > misleading_factor || ratio < 1.0 / misleading_factor; }

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

double off_share(const std::vector<float>& luminance, const std::vector<float>& reference,
                 const std::vector<bool>& counted) {
  std::size_t off = 0, pixels = 0;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    if (!counted[i]) continue;
    ++pixels;
    if (far_off(ratio_of(double(luminance[i]), double(reference[i])))) ++off;
  }
  return pixels > 0 ? static_cast<double>(off) / static_cast<double>(pixels) : 0.0;
}

double ratio_of(double value, double reference) {
  if (reference > 0.0) return value / reference;
  return value > 0.0 ? std::numeric_limits<double>::infinity() : 1.0;
}

bool breaks_rule(const TargetDifference& difference) {
  return far_off(difference.luminance_ratio) ||
         std::abs(difference.contrast_difference.value_or(0.0)) > misleading_contrast;
}

TargetDifference target_difference(const TargetLight& light, const TargetLight& reference) {
  TargetDifference difference;
  difference.light = light;
  difference.luminance_ratio = ratio_of(light.luminance, reference.luminance);
  if (light.contrast && reference.contrast) {
    difference.contrast_difference = *light.contrast - *reference.contrast;
  }
  difference.misleads = breaks_rule(difference);
  if (light.contrast.has_value() != reference.contrast.has_value()) {
    difference.misleads = true;  // only one surround is black
  }
  return difference;
}

radiosity::SolveOptions reference_solver(radiosity::SolveOptions options, std::uint64_t number) {
  options.patch_edge_m *= 0.5;
  options.refine.start_edge_m *= 0.5;
  options.refine.error *= 0.5;
  options.refine.max_patches *= 4;
  options.seed += number;
  return options;
}

}  // namespace earthshine::studies
