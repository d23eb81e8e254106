// SPDX-License-Identifier: Apache-2.0
#include "studies/compare/difference_picture.h"

#include <algorithm>

#include "studies/compare/compare.h"

namespace earthshine::studies {

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
