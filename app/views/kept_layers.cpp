// SPDX-License-Identifier: Apache-2.0
#include "app/views/kept_layers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

namespace earthshine::app {
namespace {

constexpr int half_digits = 10;          // binary digits of a half's mantissa after the point
constexpr int half_top = 15;             // the largest half is below 2^16
constexpr int half_bottom = -14;         // exponent of the smallest normal half
constexpr const char* exact = "object";  // channel of integers, not light
constexpr const char *cover_layer = "cover", *stands_for_layer = "stands for";

// 2^exponent bounds the channel's values; 0 for a black channel.
int exponent_of(const base::Channel& channel) {
  float most = 0.0F;
  for (const float value : channel.values) most = std::max(most, std::abs(value));
  return most > 0.0F ? std::ilogb(most) + 1 : 0;
}

// Rounds to multiples of 2^step: x + c - c, c = 3 2^(step + 22), whose last digit is 2^step.
void round_values(base::Channel& channel, int digits) {
  // Exponent plus one: rounding may increase the largest value to the next power of two.
  const int lowest = exponent_of(channel) + 1 - half_top + half_bottom;
  for (float& value : channel.values) {
    if (value == 0.0F) continue;
    const int exponent = static_cast<int>((std::bit_cast<std::uint32_t>(value) >> 23U) & 0xffU);
    const int step = std::max(exponent - 127, lowest) - digits;
    if (step < -126) {
      value = std::ldexp(std::nearbyint(std::ldexp(value, -step)), step);
      continue;
    }
    const float large = std::bit_cast<float>(static_cast<std::uint32_t>(step + 23 + 127) << 23U);
    value = (value + 1.5F * large) - 1.5F * large;
  }
}

void scale(base::Channel& channel, int exponent) {
  const auto factor = static_cast<float>(std::ldexp(1.0, exponent));
  if (std::isnormal(factor)) {
    for (float& value : channel.values) value *= factor;
    return;
  }
  for (float& value : channel.values) value = std::ldexp(value, exponent);
}

}  // namespace

int round_layers(base::Image& image, double relative_noise) {
  constexpr double mean_rounding = 0.42, of_the_noise = 0.125;
  if (!(relative_noise > 0.0)) return 0;
  const double digits = std::ceil(std::log2(mean_rounding / (of_the_noise * relative_noise))) - 1.0;
  if (digits > half_digits) return 0;
  const int kept = std::max(1, static_cast<int>(digits));
  for (base::Channel& channel : image.channels) {
    if (channel.name != exact) round_values(channel, kept);
  }
  return kept;
}

CachedResult packed_layers(base::Image image, int digits, Json facts) {
  CachedResult kept{std::move(facts), std::move(image)};
  kept.facts["digits"] = digits;
  if (digits == 0) return kept;
  Json& exponents = kept.facts["exponents"] = Json::object();
  for (base::Channel& channel : kept.image.channels) {
    if (channel.name == exact) continue;
    const int exponent = exponent_of(channel) - half_top;
    exponents[channel.name] = exponent;
    scale(channel, -exponent);
    kept.header.half_channels.push_back(channel.name);
  }
  return kept;
}

base::Image unpacked_layers(CachedResult kept) {
  if (kept.facts.at("digits").get<int>() > 0) {
    const Json& exponents = kept.facts.at("exponents");
    for (base::Channel& channel : kept.image.channels) {
      if (channel.name != exact) scale(channel, exponents.at(channel.name).get<int>());
    }
  }
  return std::move(kept.image);
}

CachedResult packed_noise(const raytrace::LayerErrors& errors) {
  const std::size_t layers = errors.luminance.size();
  std::vector<std::size_t> places;  // of each part
  for (const raytrace::LayerNoise& part : errors.noise) places.push_back(part.place.size());
  const std::size_t most = places.empty() ? 0 : *std::max_element(places.begin(), places.end());
  const std::size_t row = std::max<std::size_t>(1, most);
  base::Image picture{
      static_cast<int>(row), static_cast<int>(std::max<std::size_t>(1, places.size())), {}};
  std::vector<int> edges;
  std::vector<float> place(row * places.size()), cover(place), stands_for(place);
  for (std::size_t part = 0; part < places.size(); ++part) {
    const raytrace::LayerNoise& noise = errors.noise[part];
    edges.push_back(noise.edge_px);
    const auto to = static_cast<std::ptrdiff_t>(part * row);
    std::copy(noise.place.begin(), noise.place.end(), place.begin() + to);
    std::copy(noise.cover.begin(), noise.cover.end(), cover.begin() + to);
    std::copy(noise.stands_for.begin(), noise.stands_for.end(), stands_for.begin() + to);
  }
  place.resize(picture.pixel_count());
  picture.add(exact) = std::move(place);
  cover.resize(picture.pixel_count());
  picture.add(cover_layer) = std::move(cover);
  stands_for.resize(picture.pixel_count());
  picture.add(stands_for_layer) = std::move(stands_for);
  for (std::size_t layer = 0; layer < layers; ++layer) {
    std::vector<float>& values = picture.add(std::to_string(layer));
    for (std::size_t part = 0; part < places.size(); ++part) {
      for (std::size_t k = 0; k < places[part]; ++k) {
        values[part * row + k] = errors.noise[part].off[k * layers + layer];
      }
    }
    round_values(picture.channels.back(), half_digits);
  }
  return packed_layers(std::move(picture), half_digits, {{"places", places}, {"edges", edges}});
}

void take_noise(CachedResult kept, raytrace::LayerErrors& errors) {
  const auto places = kept.facts.at("places").get<std::vector<std::size_t>>();
  const auto edges = kept.facts.at("edges").get<std::vector<int>>();
  const base::Image picture = unpacked_layers(std::move(kept));
  const auto row = static_cast<std::size_t>(picture.width);
  // By name: a file sorts its channels by name.
  const std::vector<float>& pixel = picture.find(exact)->values;
  std::vector<const std::vector<float>*> layers;
  while (const base::Channel* layer = picture.find(std::to_string(layers.size()))) {
    layers.push_back(&layer->values);
  }
  const std::vector<float>& cover = picture.find(cover_layer)->values;
  const std::vector<float>& stands_for = picture.find(stands_for_layer)->values;
  errors.noise.assign(places.size(), {});
  std::vector<float> off(layers.size());
  for (std::size_t part = 0; part < places.size(); ++part) {
    errors.noise[part].edge_px = edges[part];
    for (std::size_t k = 0; k < places[part]; ++k) {
      const std::size_t at = part * row + k;
      for (std::size_t layer = 0; layer < layers.size(); ++layer) off[layer] = (*layers[layer])[at];
      errors.noise[part].add({static_cast<std::size_t>(pixel[at]), cover[at], stands_for[at]}, off);
    }
  }
}

CachedResult packed_regions(const raytrace::RegionNoise& regions) {
  const std::size_t pairs = std::max<std::size_t>(1, regions.layers * (regions.layers + 1) / 2);
  const std::size_t count = std::max<std::size_t>(1, regions.covariance.size() / pairs);
  base::Image picture{static_cast<int>(pairs), static_cast<int>(count), {}};
  std::vector<float>& kept = picture.add(exact);
  std::copy(regions.covariance.begin(), regions.covariance.end(), kept.begin());
  return {{{"layers", regions.layers}, {"values", regions.covariance.size()}}, std::move(picture)};
}

raytrace::RegionNoise unpacked_regions(CachedResult kept) {
  raytrace::RegionNoise regions;
  regions.layers = kept.facts.at("layers").get<std::size_t>();
  regions.covariance = std::move(kept.image.channels.front().values);
  regions.covariance.resize(kept.facts.at("values").get<std::size_t>());
  return regions;
}

}  // namespace earthshine::app
