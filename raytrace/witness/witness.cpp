// SPDX-License-Identifier: Apache-2.0
#include "raytrace/witness/witness.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "raytrace/tuning.h"
#include "raytrace/witness/images.h"
#include "raytrace/witness/source_edges.h"
#include "raytrace/witness/strips.h"

namespace earthshine::raytrace {
Witness::Witness(const ShadingScene& shared, const CameraModel& camera,
                 const WitnessOptions& options)
    : camera_(camera),
      options_(options),
      images_(camera, shared.filter.width_px()),
      slivers_(images_),
      lit_(images_) {
  WitnessScene scene(shared, camera, tuning::least_of_spot * options.error * options.luminance,
                     options.stop);
  add_images(scene, images_, lit_);
  if (!options.images_alone) {
    const std::vector<SceneEdge> edges = find_edges(shared.scene);
    add_source_strips(scene, edges, slivers_);
    std::vector<LitSpot> spots;
    add_light_strips(scene, edges, lit_, spots);
    reflected_ = LitSpots(scene, spots);
  }
  rays_ = scene.rays();
  choose();
}

double Witness::allowed() const {
  return tuning::noise_share * options_.error * options_.luminance;
}

// Samples that all miss a spot lose its light. A sample that hits it by chance makes the pixel far
// too bright, but its weight is limited to error_bright times the mean.
double Witness::risk(const SpotMap::Pixel& pixel) const {
  const double mean = options_.luminance;
  const double missed = error_weight(pixel.light, mean) * pixel.light;
  const double met =
      std::min(error_bright * mean, pixel.square / pixel.light / tuning::few_samples);
  return missed * missed + tuning::few_samples * pixel.coverage() * met * met;
}

void Witness::choose() {
  if (allowed() <= 0.0) return;
  std::vector<double> risks;
  for (int y = 0; y < camera_.rows; ++y) {
    for (int x = 0; x < camera_.columns; ++x) {
      if (lit_.at(x, y).light > 0.0) risks.push_back(risk(lit_.at(x, y)));
    }
  }
  std::ranges::sort(risks);
  double left = allowed() * allowed() * double(camera_.columns) * double(camera_.rows);
  std::size_t k = 0;
  for (; k < risks.size() && risks[k] <= left; ++k) left -= risks[k];
  least_risk_ = k < risks.size() ? risks[k] : std::numeric_limits<double>::infinity();
  chosen_ = static_cast<double>(risks.size() - k);
}

double Witness::samples_of_source(const SpotMap::Pixel& pixel) const {
  const double coverage = pixel.coverage();
  if (pixel.light <= 0.0 || coverage >= tuning::most_coverage) return 0.0;
  const double weight = error_weight(pixel.light, options_.luminance);
  if (weight * pixel.light < allowed()) return 0.0;
  const double error = tuning::source_share * options_.error;
  const double rim_px = std::min(1.0, 2.0 * std::sqrt(base::pi * coverage));
  const double for_rim =
      error > 0.0 ? std::pow(error_of_edge * std::sqrt(rim_px) / (coverage * error), 4.0 / 3.0)
                  : 0.0;
  // Sobol points are most uniform for powers of two.
  const double samples =
      std::min(tuning::most_for_one, std::max(tuning::most_hits / coverage, for_rim));
  return std::bit_ceil(static_cast<std::uint32_t>(samples));
}

double Witness::samples_of_lit(const SpotMap::Pixel& pixel) const {
  const double coverage = pixel.coverage();
  if (pixel.light <= 0.0 || coverage >= tuning::most_coverage) return 0.0;
  const double most = std::min(tuning::most_for_one, tuning::most_hits / coverage);
  if (allowed() <= 0.0) return most;
  if (risk(pixel) < least_risk_) return 0.0;
  const double share = double(camera_.columns) * camera_.rows / chosen_;  // share of the allowed
                                                                          // error
  const double deviation = error_weight(pixel.light, options_.luminance) *
                           std::sqrt(pixel.square - pixel.light * pixel.light);
  const double needed = std::pow(deviation / allowed(), 2.0) / share;
  return std::min(most, std::max(needed, tuning::fewest_hits / coverage));
}

Witness::Expected Witness::expected(int x, int y) const {
  Expected all;
  const auto add = [&](const SpotMap::Pixel& pixel, double samples) {
    if (samples <= 0.0) return;
    all.samples = std::max(all.samples, samples);
    all.luminance = std::max(all.luminance, pixel.square / pixel.light);
    all.light = all.light > 0.0 ? std::min(all.light, pixel.light) : pixel.light;
  };
  add(images_.at(x, y), samples_of_source(images_.at(x, y)));
  add(slivers_.at(x, y), samples_of_source(slivers_.at(x, y)));
  add(lit_.at(x, y), samples_of_lit(lit_.at(x, y)));
  return all;
}

std::vector<std::uint32_t> Witness::wanted(const PixelSums& sums) const {
  double all = 0.0;
  for (int y = 0; y < camera_.rows; ++y) {
    for (int x = 0; x < camera_.columns; ++x) all += expected(x, y).samples;
  }
  const double pixels = double(camera_.columns) * double(camera_.rows);
  const double bound =
      options_.most_samples > 0.0 ? options_.most_samples : std::numeric_limits<double>::infinity();
  const double most =
      std::min(bound, std::max(tuning::witness_samples, tuning::witness_per_pixel * pixels));
  const double share = std::min(1.0, most / std::max(all, 1.0));
  std::vector<std::uint32_t> wanted = sums.samples;
  if (!options_.images_alone) {
    wanted = wanted_for_source_edges(sums, samples_for_edges(options_.error), bound);
  }
  const Window& window = sums.window;
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      std::uint32_t& of_pixel = wanted[window.index(x, y)];
      of_pixel = std::max(of_pixel, static_cast<std::uint32_t>(share * expected(x, y).samples));
    }
  }
  return wanted;
}

std::vector<float> Witness::spot_luminance(const PixelSums& sums) const {
  std::vector<float> luminance(sums.samples.size(), 0.0F);
  const Window& window = sums.window;
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      luminance[window.index(x, y)] = static_cast<float>(expected(x, y).luminance);
    }
  }
  return luminance;
}

std::vector<float> Witness::unexplained(const PixelSums& sums,
                                        std::span<const float> reflected) const {
  std::vector<float> missing;
  const Window& window = sums.window;
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      const double light = expected(x, y).light;
      if (light <= 0.0) continue;
      double found = 0.0;
      for (int qy = y - 1; qy <= y + 1; ++qy) {
        for (int qx = x - 1; qx <= x + 1; ++qx) {
          if (!window.contains(qx, qy)) continue;
          const std::size_t q = window.index(qx, qy);
          found += sums.luminance[q] / std::max(1U, sums.samples[q]);
        }
      }
      if (found >= tuning::found_share * light) continue;
      missing.resize(sums.samples.size(), 0.0F);
      missing[window.index(x, y)] = static_cast<float>(light - found);
    }
  }
  add_unreflected(window, reflected, missing);
  return missing;
}

void Witness::add_unreflected(const Window& window, std::span<const float> reflected,
                              std::vector<float>& missing) const {
  std::vector<float> unreflected(reflected.size(), 0.0F);
  double square = 0.0;
  for (const LitSpots::Block& block : reflected_.blocks()) {
    if (!window.contains(block.x, block.y)) continue;
    double found = 0.0, pixels = 0.0;
    for (int y = block.y - 1; y <= block.y + 1; ++y) {
      for (int x = block.x - 1; x <= block.x + 1; ++x) {
        if (!window.contains(x, y)) continue;
        found += double(reflected[window.index(x, y)]);
        pixels += 1.0;
      }
    }
    const double light = double(block.luminance);
    found /= pixels;
    if (found >= tuning::found_share * light) continue;
    // One pixel takes the squared error of all in the block.
    const double off = (light - found) * reflected_.block_px();
    unreflected[window.index(block.x, block.y)] = static_cast<float>(off);
    square += off * off;
  }
  // Less than the wanted error may be noise of paths, which is stated.
  const double limit = options_.error * options_.luminance;
  if (square <= limit * limit * double(reflected.size())) return;
  missing.resize(reflected.size(), 0.0F);
  for (std::size_t p = 0; p < missing.size(); ++p) {
    missing[p] = std::max(missing[p], unreflected[p]);
  }
}

}  // namespace earthshine::raytrace
