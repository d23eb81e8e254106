// SPDX-License-Identifier: Apache-2.0
// A picture with other lamp settings, from a picture with a layer per light group: light is
// additive, so that any dimming, failure or combination is a weighted sum of the layers.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/image.h"

namespace earthshine::studies {

// Groups that have a layer "light_<group>" of R, G and B, in the order of the channels.
[[nodiscard]] std::vector<std::string> lit_groups(const base::Image& image);

// Multiplies the layers of the named groups by their factors and sets R, G and B to the sum of all
// layers. Layers that are no sum over lights (geometry, object numbers, Cryptomatte) stay. Layers
// that become wrong (direct, indirect, specular, variance) are removed unless all factors are 1.
// source: for error messages. Throws base::Error (Input): no layers; a group without one (with the
// existing groups); layers that do not add up to the picture, within 1e-4 of its mean; no R, G, B.
void relight(base::Image& image, const std::map<std::string, Rgb>& factors,
             const std::string& source);

// Mean luminance of the pixels of each object, by the channel "object"; empty without it.
struct ObjectLight {
  std::size_t pixels = 0;
  double luminance = 0.0;                  // of the picture, cd/m^2
  std::map<std::string, double> by_group;  // of each layer
};
[[nodiscard]] std::map<int, ObjectLight> light_of_objects(const base::Image& image);

}  // namespace earthshine::studies
