// SPDX-License-Identifier: Apache-2.0
#include "raytrace/witness/witness.h"

#include <algorithm>
#include <cmath>

#include "raytrace/witness/images.h"
#include "raytrace/witness/strips.h"

namespace earthshine::raytrace {
namespace {

// Samples that should meet a spot: between these, as the wanted error needs.
constexpr double fewest_hits = 16.0, most_hits = 64.0;
constexpr double noise_share = 0.5;     // of the wanted error, at a pixel with a spot
constexpr double least_of_spot = 0.01;   // of the light that counts in a pixel
constexpr double most_coverage = 0.999;  // fuller pixels are no spots
constexpr double most_for_one = 65536.0, least_budget = 1048576.0, budget_per_pixel = 4.0;
// Samples that find less than this share of the witness's light have not found it: the witness
// knows a spot's light to a factor of two or so.
constexpr double found_share = 0.25;

}  // namespace

Witness::Witness(const ShadingScene& shared, const CameraModel& camera,
                 const WitnessOptions& options)
    : camera_(camera), options_(options), spots_(camera, shared.filter.width_px()) {
  WitnessScene scene(shared, camera, least_of_spot * options.error * options.luminance,
                     options.stop);
  add_images(scene, spots_);
  const std::vector<SceneEdge> edges = find_edges(shared.scene);
  add_source_strips(scene, edges, spots_);
  add_light_strips(scene, edges, spots_);
  rays_ = scene.rays();
}

double Witness::samples_at(int x, int y) const {
  const SpotMap::Pixel& pixel = spots_.at(x, y);
  const double coverage = pixel.coverage(), least = options_.error * options_.luminance;
  if (pixel.light <= 0.0 || coverage >= most_coverage) return 0.0;
  if (least <= 0.0) return std::min(most_for_one, most_hits / coverage);
  const double weight = error_weight(pixel.light, options_.luminance);
  if (weight * pixel.light < noise_share * least) return 0.0;
  const double deviation = weight * std::sqrt(pixel.square - pixel.light * pixel.light);
  const double needed = std::pow(deviation / (noise_share * least), 2.0);
  return std::min(most_for_one, std::clamp(needed, fewest_hits / coverage, most_hits / coverage));
}

std::vector<std::uint32_t> Witness::wanted(const PixelSums& sums) const {
  double all = 0.0;
  for (int y = 0; y < camera_.rows; ++y) {
    for (int x = 0; x < camera_.columns; ++x) all += samples_at(x, y);
  }
  const double pixels = double(camera_.columns) * double(camera_.rows);
  const double share =
      std::min(1.0, std::max(least_budget, budget_per_pixel * pixels) / std::max(all, 1.0));
  std::vector<std::uint32_t> wanted = sums.samples;
  const Window& window = sums.window;
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      std::uint32_t& of_pixel = wanted[window.index(x, y)];
      of_pixel = std::max(of_pixel, static_cast<std::uint32_t>(share * samples_at(x, y)));
    }
  }
  return wanted;
}

std::vector<float> Witness::spot_luminance(const PixelSums& sums) const {
  std::vector<float> luminance(sums.samples.size(), 0.0F);
  const Window& window = sums.window;
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      const SpotMap::Pixel& pixel = spots_.at(x, y);
      if (samples_at(x, y) <= 0.0) continue;
      luminance[window.index(x, y)] = static_cast<float>(pixel.square / pixel.light);
    }
  }
  return luminance;
}

std::vector<float> Witness::unexplained(const PixelSums& sums) const {
  std::vector<float> missing;
  const Window& window = sums.window;
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      if (samples_at(x, y) <= 0.0) continue;
      const double expected = spots_.at(x, y).light;
      double found = 0.0;
      for (int qy = y - 1; qy <= y + 1; ++qy) {
        for (int qx = x - 1; qx <= x + 1; ++qx) {
          if (!window.contains(qx, qy)) continue;
          const std::size_t q = window.index(qx, qy);
          found += sums.luminance[q] / std::max(1U, sums.samples[q]);
        }
      }
      if (found >= found_share * expected) continue;
      missing.resize(sums.samples.size(), 0.0F);
      missing[window.index(x, y)] = static_cast<float>(expected - found);
    }
  }
  return missing;
}

}  // namespace earthshine::raytrace
