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
    if (far_off(ratio_of(double(value[i]), double(right[i])))) ++off;
  }
  if (result.pixels == 0) return result;
  const auto n = static_cast<double>(result.pixels);
  result.off_share = static_cast<double>(off) / n;
  if (right_sum <= 0.0) return result;
  result.relative_rmse = std::sqrt(squares / n) / (right_sum / n);
  result.bias = sum / right_sum;
  return result;
}

PictureDifference picture_difference(const std::vector<float>& luminance,
                                     const std::vector<float>& first,
                                     const std::vector<float>& second, const ObjectMap& map) {
  PictureDifference result;
  double products = 0.0, variance = 0.0, sum = 0.0, right_sum = 0.0;
  std::size_t off = 0;
  for (std::size_t i = 0; i < map.object.size(); ++i) {
    if (map.object[i] == no_object) continue;
    ++result.pixels;
    const double value = luminance[i], right = 0.5 * (double(first[i]) + double(second[i]));
    const double apart = double(first[i]) - double(second[i]);
    products += (value - double(first[i])) * (value - double(second[i]));
    variance += (value - right) * (value - right) * apart * apart;
    sum += value - right;
    right_sum += right;
    if (far_off(ratio_of(value, right))) ++off;
  }
  if (result.pixels == 0) return result;
  const auto n = static_cast<double>(result.pixels);
  result.off_share = static_cast<double>(off) / n;
  if (right_sum <= 0.0) return result;
  const double mean = right_sum / n;
  const double square = std::max(0.0, products / n);
  result.relative_rmse = std::sqrt(square) / mean;
  result.bias = sum / right_sum;
  result.standard_error = (std::sqrt(square + std::sqrt(variance) / n) - std::sqrt(square)) / mean;
  return result;
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
    difference.misleads = true;  // one surround is black, the other is not
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

PictureDifference reference_noise(const std::vector<float>& first, const std::vector<float>& second,
                                  const ObjectMap& map) {
  PictureDifference noise;
  double squares = 0.0, fourth = 0.0, sum = 0.0, apart_sum = 0.0;
  for (std::size_t i = 0; i < map.object.size(); ++i) {
    if (map.object[i] == no_object) continue;
    ++noise.pixels;
    const double half = 0.5 * (double(first[i]) - double(second[i]));
    squares += half * half;
    fourth += half * half * half * half;
    apart_sum += half;
    sum += 0.5 * (double(first[i]) + double(second[i]));
  }
  if (sum <= 0.0) return noise;
  const auto n = static_cast<double>(noise.pixels);
  noise.relative_rmse = std::sqrt(squares / n) / (sum / n);
  noise.bias = apart_sum / sum;
  if (squares > 0.0) {
    noise.standard_error = 0.5 * noise.relative_rmse * std::sqrt(fourth) / squares;
  }
  return noise;
}

}  // namespace earthshine::studies
