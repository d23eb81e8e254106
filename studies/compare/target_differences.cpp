// SPDX-License-Identifier: Apache-2.0
#include "studies/compare/target_differences.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "studies/compare/compare.h"

namespace earthshine::studies {
namespace {

double mean_square(const std::vector<std::uint32_t>& pixels, const ReferencePair& right) {
  double sum = 0.0;
  for (const std::uint32_t i : pixels) {
    const double apart = right.first.luminance[i] - right.second.luminance[i];
    sum += 0.25 * apart * apart;
  }
  const auto n = static_cast<double>(std::max<std::size_t>(1, pixels.size()));
  return sum / (n * n);
}
double mean_square(const std::vector<std::uint32_t>& pixels, const base::Image& image) {
  const base::Channel* variance = image.find("variance");
  double sum = 0.0;
  for (const std::uint32_t i : pixels) sum += double(variance->values[i]);
  const auto n = static_cast<double>(std::max<std::size_t>(1, pixels.size()));
  return sum / (n * n);
}

// Adds the noise of both pictures, for independent pixels.
void add_noise(const TargetView& view, const TargetLight& light, const TargetLight& right,
               const base::Image& image, const ReferencePair& pair, TargetDifference& difference) {
  if (!(right.luminance > 0.0)) return;
  // Squared standard errors over the squared luminance.
  const auto relative = [&](const std::vector<std::uint32_t>& pixels, double found, double wanted) {
    return std::pair{found > 0.0 ? mean_square(pixels, image) / (found * found) : 0.0,
                     wanted > 0.0 ? mean_square(pixels, pair) / (wanted * wanted) : 0.0};
  };
  const auto [on, on_right] = relative(view.measured, light.luminance, right.luminance);
  difference.ratio_error = difference.luminance_ratio * std::sqrt(on + on_right);
  if (difference.contrast_difference) {
    const auto [round, round_right] = relative(view.surround, *light.surround, *right.surround);
    difference.contrast_error =
        std::hypot((1.0 + *light.contrast) * std::sqrt(on + round),
                   (1.0 + *right.contrast) * std::sqrt(on_right + round_right));
  }
  difference.decided = decided(difference);
}

}  // namespace

bool decided(const TargetDifference& difference) {
  const auto verdict = [&](double ratios, double contrasts) {
    TargetDifference shifted = difference;
    shifted.luminance_ratio += ratios * difference.ratio_error;
    if (shifted.contrast_difference) {
      *shifted.contrast_difference += contrasts * difference.contrast_error;
    }
    return breaks_rule(shifted);
  };
  // If only one surround is black, the rule is broken for any noise.
  if (difference.misleads && !breaks_rule(difference)) return true;
  for (const double ratios : {-2.0, 2.0}) {
    for (const double contrasts : {-2.0, 2.0}) {
      if (verdict(ratios, contrasts) != difference.misleads) return false;
    }
  }
  return true;
}

std::vector<std::optional<TargetDifference>> target_differences(
    const base::Image& image, const std::vector<TargetView>& targets, const ReferencePair& pair,
    const std::vector<float>& mean) {
  std::vector<std::optional<TargetDifference>> result;
  const std::vector<float> luminance = base::luminance_of(image);
  for (const TargetView& view : targets) {
    const auto light = measure_light(view, luminance);
    if (!light) {
      result.emplace_back();
      continue;
    }
    const TargetLight wanted = *measure_light(view, mean);
    TargetDifference difference = target_difference(*light, wanted);
    add_noise(view, *light, wanted, image, pair, difference);
    result.emplace_back(difference);
  }
  return result;
}

std::vector<std::uint8_t> difference_picture(const base::Image& image, const base::Image& reference,
                                             const ObjectMap& map) {
  const std::vector<float> value = base::luminance_of(image);
  const std::vector<float> right = base::luminance_of(reference);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * value.size());
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double ratio = ratio_of(double(value[i]), double(right[i]));
    const auto* const band =
        std::find_if(difference_bands.begin(), std::prev(difference_bands.end()),
                     [&](const DifferenceBand& entry) { return ratio > entry.above; });
    const Colour& colour = map.object[i] == no_object ? difference_sky : band->colour;
    rgb.insert(rgb.end(), colour.begin(), colour.end());
  }
  return rgb;
}

}  // namespace earthshine::studies
