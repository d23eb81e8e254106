// SPDX-License-Identifier: Apache-2.0
// A picture in memory: named float channels, row 0 at the top, planar storage.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.h"

namespace earthshine::base {

struct Channel {
  std::string name;           // "R", "light_sun.G", "Z"; dots separate layers as in OpenEXR
  std::vector<float> values;  // width * height, row by row from the top
};

struct Image {
  int width = 0;
  int height = 0;
  std::vector<Channel> channels;

  [[nodiscard]] std::size_t pixel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  // nullptr if there is no such channel.
  [[nodiscard]] const Channel* find(std::string_view name) const;
  // Adds a channel of zeros and returns its values. The name must be new.
  std::vector<float>& add(std::string name);
};

// An image with the channels R, G and B, all zero.
[[nodiscard]] Image make_rgb_image(int width, int height);

// Luminance of every pixel, from R, G, B or from the single channel Y. Throws base::Error (Input)
// if the image has neither.
[[nodiscard]] std::vector<float> luminance_of(const Image& image);

}  // namespace earthshine::base
