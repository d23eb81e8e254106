// SPDX-License-Identifier: Apache-2.0
#include "raytrace/adaptive/sum_errors.h"

#include <algorithm>

#include "base/parallel.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t block_edge_px = 32;

// Light of a pixel by layer, before denoising. Points without samples count as their pixel's
// others.
void undenoised_light(const PixelSums& sums, const GatherField& field, std::size_t pixel,
                      std::span<float> out) {
  const std::size_t layers = sums.image_layers;
  const double n = sums.samples[pixel];
  std::vector<double> light(layers, 0.0);
  for (const Gathered kind : {Gathered::Solution, Gathered::Residual, Gathered::Lobe}) {
    if (!field.gathers(kind)) continue;
    std::vector<double> of_kind(layers, 0.0);
    double all = 0.0, sampled = 0.0;
    for (const FieldTerm& term : sums.terms[pixel]) {
      const Rgb weight(kind == Gathered::Lobe ? term.lobe : term.diffuse);
      const double share = base::luminance(weight), count = field.samples(kind, term.point);
      all += share;
      if (count <= 0.0 || share <= 0.0) continue;
      sampled += share;
      const std::span<const glm::vec3> of_point = field.sampled(kind, term.point);
      for (std::size_t k = 0; k < layers; ++k) {
        of_kind[k] += base::luminance(weight * Rgb(of_point[k])) / count;
      }
    }
    if (sampled <= 0.0) continue;
    for (std::size_t k = 0; k < layers; ++k) light[k] += of_kind[k] * all / sampled;
  }
  for (std::size_t k = 0; k < layers; ++k) {
    light[k] += base::luminance(Rgb(sums.radiance[pixel * sums.entries + k]));
    out[k] = static_cast<float>(light[k] / n);
  }
}

}  // namespace

ErrorDemand::ErrorDemand(const Window& window)
    : picture_columns_(static_cast<std::size_t>(window.columns)),
      columns_((picture_columns_ + block_edge_px - 1) / block_edge_px),
      rows_((static_cast<std::size_t>(window.rows) + block_edge_px - 1) / block_edge_px) {
  factor_.fill(std::vector<float>(blocks(), 0.0F));
}

std::size_t ErrorDemand::block_of(std::size_t pixel) const {
  return pixel / picture_columns_ / block_edge_px * columns_ +
         pixel % picture_columns_ / block_edge_px;
}

std::vector<LayerNoise> noise_by_part(const PixelSums& sums, const GatherField& field, int columns,
                                      std::size_t one_in) {
  std::vector<LayerNoise> noise;
  for (const Gathered kind : {Gathered::Solution, Gathered::Residual, Gathered::Lobe}) {
    noise.push_back(field.layer_noise(kind, one_in));
  }
  noise.push_back(sums.layer_noise(columns, one_in));
  return noise;
}

SumErrors::SumErrors(const PixelSums& sums, const GatherField& field, const ErrorSums& all,
                     std::span<const std::vector<double>> of, int columns)
    : sums_(sums), of_(of) {
  const std::size_t layers = sums.image_layers;
  errors_.noise = noise_by_part(sums, field, columns, layer_noise_step(sums.samples.size()));
  for (LayerNoise& part : errors_.noise) {
    part.luminance.assign(part.off.size(), 0.0F);
    base::parallel_chunks(part.place.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        if (sums.samples[part.place[k]] == 0) continue;
        undenoised_light(sums, field, part.place[k], {&part.luminance[k * layers], layers});
      }
    });
  }
  // The camera's places are pixels that count, so that they also give the layers' means.
  const LayerNoise& pixels = errors_.noise.back();
  errors_.luminance.assign(layers, 0.0);
  double count = 0.0;
  for (std::size_t k = 0; k < pixels.place.size(); ++k) {
    count += double(pixels.stands_for[k]);
    for (std::size_t j = 0; j < layers; ++j) {
      errors_.luminance[j] +=
          double(pixels.stands_for[k]) * double(pixels.luminance[k * layers + j]);
    }
  }
  for (double& mean : errors_.luminance) mean /= std::max(1.0, count);
  errors_.scale_to(all.squared, all.reference_luminance);
  squared_.assign(of.size(), 0.0);
  base::parallel_chunks(of.size(), 1, [&](std::size_t k, std::size_t) {
    const auto error = errors_.of(of[k]);
    if (error) squared_[k] = error->relative() * error->relative();
  });
}

ErrorDemand SumErrors::demand(std::span<const std::size_t> of) const {
  ErrorDemand demand(sums_.window);
  const std::size_t layers = sums_.image_layers, blocks = demand.blocks();
  // Squared errors of each sum, the last one of all layers, by block.
  std::vector<std::vector<double>> squares(of.size() + 1);
  const std::vector<double> ones(layers, 1.0);
  for (std::size_t part = 0; part < errors_.noise.size(); ++part) {
    const LayerNoise& noise = errors_.noise[part];
    base::parallel_chunks(squares.size(), 1, [&](std::size_t s, std::size_t) {
      const std::vector<double>& weights = s < of.size() ? of_[of[s]] : ones;
      double mean = 0.0;
      for (std::size_t j = 0; j < layers; ++j) mean += weights[j] * errors_.luminance[j];
      squares[s].assign(blocks, 0.0);
      for (std::size_t k = 0; k < noise.place.size(); ++k) {
        squares[s][demand.block_of(noise.place[k])] +=
            noise.squared_error(k, weights, mean) / (mean * mean);
      }
    });
    double of_all = 0.0, greatest = 0.0;
    std::vector<float>& factor = demand.part(part);
    for (std::size_t block = 0; block < blocks; ++block) {
      double most = 0.0;
      for (std::size_t s = 0; s < of.size(); ++s) most = std::max(most, squares[s][block]);
      const double all = squares.back()[block];
      of_all += all;
      greatest += most;
      factor[block] = all > 0.0 ? static_cast<float>(most / all) : -1.0F;
    }
    // Blocks without places have the factor of the whole picture.
    const auto whole = static_cast<float>(of_all > 0.0 ? greatest / of_all : 0.0);
    for (float& one : factor) one = one < 0.0F ? whole : one;
  }
  return demand;
}

}  // namespace earthshine::raytrace
