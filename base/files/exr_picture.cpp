// SPDX-License-Identifier: Apache-2.0
#include "base/files/exr_picture.h"

#include <algorithm>
#include <string_view>

namespace earthshine::base {
namespace {

using Names = std::vector<std::string>;

const Names colour_words[] = {{"R", "G", "B"}, {"r", "g", "b"}, {"red", "green", "blue"}};
const Names luminance_words[] = {{"Y"}, {"luminance"}, {"Luminance"}, {"L"}};

bool has_all(const Names& channels, const Names& wanted) {
  return std::all_of(wanted.begin(), wanted.end(), [&](const std::string& name) {
    return std::find(channels.begin(), channels.end(), name) != channels.end();
  });
}

Names within(const std::string& layer, const Names& words) {
  Names names;
  names.reserve(words.size());
  const std::string prefix = layer.empty() ? layer : layer + ".";
  for (const std::string& word : words) names.push_back(prefix + word);
  return names;
}

// The picture of one layer; "" is the file itself. Only there are X, Y and Z colours: in a layer
// they are a position, and its Y is no luminance.
ExrPicture in_layer(const Names& channels, const std::string& layer) {
  for (const Names& words : colour_words) {
    const Names names = within(layer, words);
    if (has_all(channels, names)) return {ExrPicture::Kind::Rgb, names, {}};
  }
  const Names xyz = {"X", "Y", "Z"};
  if (layer.empty() && has_all(channels, xyz)) return {ExrPicture::Kind::Xyz, xyz, {}};
  if (!layer.empty() && has_all(channels, within(layer, {"X"}))) return {};
  for (const Names& words : luminance_words) {
    const Names names = within(layer, words);
    if (has_all(channels, names)) return {ExrPicture::Kind::Luminance, names, {}};
  }
  return {};
}

Names layers_of(const Names& channels) {
  Names layers;
  for (const std::string& name : channels) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) continue;
    const std::string layer = name.substr(0, dot);
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  }
  return layers;
}

bool is_combined(const std::string& layer) {
  return layer == "Combined" || layer.ends_with(".Combined");
}

}  // namespace

ExrPicture find_picture(const Names& channels) {
  if (ExrPicture whole = in_layer(channels, ""); whole.kind != ExrPicture::Kind::None) {
    return whole;
  }
  Names with_picture, combined;
  for (const std::string& layer : layers_of(channels)) {
    if (in_layer(channels, layer).kind == ExrPicture::Kind::None) continue;
    with_picture.push_back(layer);
    if (is_combined(layer)) combined.push_back(layer);
  }
  if (combined.size() == 1) return in_layer(channels, combined.front());
  if (with_picture.size() == 1) return in_layer(channels, with_picture.front());
  return {ExrPicture::Kind::None, {}, with_picture};
}

}  // namespace earthshine::base
