// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/numbers/random.h"
#include "base/parallel.h"
#include "raytrace/frame/frame.h"

namespace earthshine::raytrace {
namespace {

// Sum over the places of the squared error of the sum with these weights.
double noise_of(const LayerNoise& noise, std::span<const double> weights, double mean) {
  double squares = 0.0;
  for (std::size_t k = 0; k < noise.place.size(); ++k) {
    squares += noise.squared_error(k, weights, mean);
  }
  return squares;
}

}  // namespace

void LayerNoise::add(const Row& row, std::span<const float> off_by) {
  place.push_back(static_cast<std::uint32_t>(row.place));
  cover.push_back(row.cover);
  stands_for.push_back(row.stands_for);
  off.insert(off.end(), off_by.begin(), off_by.end());
}

double LayerNoise::squared_error(std::size_t k, std::span<const double> weights,
                                 double mean) const {
  const float* of_row = &off[k * weights.size()];
  const float* light = &luminance[k * weights.size()];
  double error = 0.0, sum = 0.0;
  for (std::size_t layer = 0; layer < weights.size(); ++layer) {
    error += weights[layer] * double(of_row[layer]);
    sum += weights[layer] * double(light[layer]);
  }
  const double counted = error_weight(sum, mean) * error;
  return double(stands_for[k]) * counted * counted;
}

bool LayerNoise::selects(Row& row, std::size_t one_in) {
  if (row.stands_for > 1.0F || one_in <= 1) return true;
  row.stands_for = static_cast<float>(one_in);
  return base::mix64(row.place) % one_in == 0;
}

void LayerErrors::see(const base::Image& picture, std::span<const std::string> groups) {
  for (LayerNoise& part : noise) part.luminance.assign(part.off.size(), 0.0F);
  for (std::size_t layer = 0; layer < groups.size(); ++layer) {
    const std::string name = "light_" + groups[layer];
    const base::Channel *red = picture.find(name + ".R"), *green = picture.find(name + ".G"),
                        *blue = picture.find(name + ".B");
    for (LayerNoise& part : noise) {
      for (std::size_t k = 0; k < part.place.size(); ++k) {
        const std::size_t pixel = part.place[k];
        const Rgb light(red->values[pixel], green->values[pixel], blue->values[pixel]);
        part.luminance[k * groups.size() + layer] = static_cast<float>(base::luminance(light));
      }
    }
  }
}

void LayerErrors::scale_to(std::span<const double> squared, double reference_luminance) {
  const std::vector<double> ones(luminance.size(), 1.0);
  double mean = 0.0;
  for (const double of_layer : luminance) mean += of_layer;
  per_noise.assign(noise.size(), 0.0);
  for (std::size_t part = 0; part < noise.size(); ++part) {
    const double of_all = noise_of(noise[part], ones, mean);
    if (of_all > 0.0)
      per_noise[part] = squared[part] * reference_luminance * reference_luminance / of_all;
  }
}

std::optional<LayerErrors::OfSum> LayerErrors::of(std::span<const double> weights) const {
  if (luminance.empty() || weights.size() != luminance.size()) return std::nullopt;
  double mean = 0.0;
  for (std::size_t k = 0; k < luminance.size(); ++k) mean += weights[k] * luminance[k];
  if (mean <= 0.0) return std::nullopt;
  double squares = 0.0;
  for (std::size_t part = 0; part < noise.size(); ++part) {
    if (per_noise[part] > 0.0) squares += per_noise[part] * noise_of(noise[part], weights, mean);
  }
  return OfSum{std::sqrt(squares), mean};
}

void LayerErrors::thin(std::size_t one_in) {
  for (LayerNoise& part : noise) {
    LayerNoise kept;
    kept.edge_px = part.edge_px;
    for (std::size_t k = 0; k < part.place.size(); ++k) {
      LayerNoise::Row row = part.row(k);
      if (!LayerNoise::selects(row, one_in)) continue;
      kept.add(row, {&part.off[k * layer_count()], layer_count()});
    }
    part = std::move(kept);
  }
}

RegionNoise::RegionNoise(const LayerErrors& errors,
                         std::span<const std::vector<std::uint32_t>> regions, std::size_t columns)
    : layers(errors.layer_count()) {
  const std::size_t pairs = layers * (layers + 1) / 2;
  std::vector<std::vector<double>> sums(regions.size());
  base::parallel_chunks(regions.size(), 1, [&](std::size_t r, std::size_t) {
    const std::vector<std::uint32_t>& pixels = regions[r];
    sums[r].assign(pairs, 0.0);
    std::vector<double> off(layers);
    for (const LayerNoise& part : errors.noise) {
      const auto edge = static_cast<std::size_t>(part.edge_px);
      for (std::size_t k = 0; k < part.place.size(); ++k) {
        const std::size_t x = part.place[k] % columns - edge / 2;
        const std::size_t y = part.place[k] / columns - edge / 2;
        double served = 0.0;
        for (std::size_t row = y; row < y + edge; ++row) {
          const auto first = std::lower_bound(pixels.begin(), pixels.end(), row * columns + x);
          served += double(std::lower_bound(first, pixels.end(), row * columns + x + edge) - first);
        }
        if (served <= 0.0) continue;
        const double share = served * double(part.cover[k]) / double(pixels.size());
        for (std::size_t j = 0; j < layers; ++j) off[j] = share * double(part.off[k * layers + j]);
        double* sum = sums[r].data();
        for (std::size_t i = 0; i < layers; ++i) {
          for (std::size_t j = 0; j <= i; ++j) *sum++ += off[i] * off[j];
        }
      }
    }
  });
  for (const std::vector<double>& of_region : sums) {
    for (const double value : of_region) covariance.push_back(static_cast<float>(value));
  }
}

std::vector<double> RegionNoise::variances(std::span<const double> weights) const {
  std::vector<double> variances;
  const std::size_t pairs = layers * (layers + 1) / 2;
  for (std::size_t first = 0; first < covariance.size(); first += pairs) {
    const float* value = &covariance[first];
    double sum = 0.0;
    for (std::size_t i = 0; i < layers; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        sum += (i == j ? 1.0 : 2.0) * weights[i] * weights[j] * double(*value++);
      }
    }
    variances.push_back(std::max(0.0, sum));
  }
  return variances;
}

}  // namespace earthshine::raytrace
