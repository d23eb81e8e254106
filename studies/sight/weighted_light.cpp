// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "studies/light/light_basis.h"

namespace earthshine::studies {
namespace {

using Planes = std::array<const std::vector<float>*, 3>;

// A picture of a scene with a single group has no layers beside R, G, B.
Planes layer_of(const base::Image& layers, const std::string& group, bool alone) {
  Planes planes{};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string letter(1, "RGB"[c]);
    const base::Channel* channel = layers.find(fmt::format("light_{}.{}", group, letter));
    if (channel == nullptr && alone) channel = layers.find(letter);
    if (channel == nullptr) {
      throw base::Error(base::Blame::Input, "study",
                        "the picture has no layer of light group \"" + group + "\"", {},
                        "Render it with a layer per light");
    }
    planes[c] = &channel->values;
  }
  return planes;
}

}  // namespace

base::Image weighted_sum(const base::Image& layers, const std::vector<std::string>& groups,
                         const GroupWeights& weights) {
  struct Term {
    const float* values;
    float weight;
  };
  std::array<std::vector<Term>, 3> terms;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (base::max_component(weights.weight[g]) <= 0.0) continue;
    const Planes planes = layer_of(layers, groups[g], groups.size() == 1);
    for (std::size_t c = 0; c < 3; ++c) {
      terms[c].push_back(
          {planes[c]->data(), static_cast<float>(weights.weight[g][static_cast<int>(c)])});
    }
  }
  base::Image sum;
  sum.width = layers.width;
  sum.height = layers.height;
  const std::size_t count = layers.pixel_count();
  for (std::size_t c = 0; c < 3; ++c) {
    sum.channels.push_back({std::string(1, "RGB"[c]), std::vector<float>(count, 0.0F)});
  }
  base::parallel_chunks(count, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = 0; c < 3; ++c) {
      float* out = sum.channels[c].values.data();
      for (const Term& term : terms[c]) {
        for (std::size_t i = begin; i < end; ++i) out[i] += term.weight * term.values[i];
      }
    }
  });
  return sum;
}

std::vector<Rgb> mean_by_group(const base::Image& layers, const std::vector<std::string>& groups,
                               const std::vector<std::uint32_t>& pixels) {
  std::vector<Rgb> means;
  for (const std::string& group : groups) {
    const Planes planes = layer_of(layers, group, groups.size() == 1);
    Rgb sum(0.0);
    for (const std::uint32_t pixel : pixels) {
      for (int c = 0; c < 3; ++c) {
        sum[c] += double((*planes[static_cast<std::size_t>(c)])[pixel]);
      }
    }
    means.push_back(pixels.empty() ? sum : sum / static_cast<double>(pixels.size()));
  }
  return means;
}

std::optional<BasisError> basis_error(const GroupWeights& weights,
                                      const std::vector<Rgb>& by_group) {
  double sum = 0.0, bound = 0.0, squares = 0.0;
  for (std::size_t g = 0; g < by_group.size(); ++g) {
    sum += base::luminance(weights.weight[g] * by_group[g]);
    const double unit = std::abs(base::luminance(by_group[g]));  // noise may make it negative
    bound += weights.largest[g] * unit;
    squares += std::pow(weights.scatter[g] * unit, 2);
  }
  if (sum <= 0.0) return std::nullopt;
  return BasisError{bound / sum, std::sqrt(squares) / sum};
}

}  // namespace earthshine::studies
