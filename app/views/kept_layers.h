// SPDX-License-Identifier: Apache-2.0
// Stored form of a study's pictures in points/.
#pragma once

#include "app/parts/result_cache.h"
#include "raytrace/frame/frame.h"

namespace earthshine::app {

// Layers of a study's picture, stored in 16 bits with as many digits as their noise justifies. They
// are rounded before use, so that a study resumed from points/ gives the same bytes.

// Rounds every channel but "object" to the fewest binary digits m whose rounding error, on average
// 0.42 2^-(m+1) of a value, is at most an eighth of the picture's relative noise: the noise's
// variance then grows by at most a 64th. Does nothing if 11 digits, the capacity of 16 bits, or
// more are needed. Returns the digits after the point, 0 for none. The smallest values, below 2^-29
// of their channel's largest, keep fewer.
int round_layers(base::Image& image, double relative_noise);

// The stored form of an image that was rounded to `digits`, with its facts: each channel is
// multiplied by a power of two that brings it into the range of 16 bits.
[[nodiscard]] CachedResult packed_layers(base::Image image, int digits, Json facts);
// The exact image again. Throws Json::exception if the facts are not those of such a picture.
[[nodiscard]] base::Image unpacked_layers(CachedResult kept);

// Errors of the layers at some pixels, as a picture rounded to 16 bits: channels for the pixels'
// positions, cover and weights and for each layer, a row for each part of the error.
[[nodiscard]] CachedResult packed_noise(const raytrace::LayerErrors& errors);
// Stored without rounding.
[[nodiscard]] CachedResult packed_regions(const raytrace::RegionNoise& regions);
[[nodiscard]] raytrace::RegionNoise unpacked_regions(CachedResult kept);
// Inverse of packed_noise.
void take_noise(CachedResult kept, raytrace::LayerErrors& errors);

}  // namespace earthshine::app
