// SPDX-License-Identifier: Apache-2.0
// What points/ keeps of a study's pictures.
#pragma once

#include "app/parts/result_cache.h"
#include "raytrace/frame/frame.h"

namespace earthshine::app {

// Layers of a study's picture as points/ keeps them: with as many digits as their noise leaves
// them, in 16 bits. They are rounded before anything is judged by them, so that a study that goes
// on from points/ comes to the same bytes.

// Rounds every channel but "object" to the fewest binary digits m whose rounding, 0.42 2^-(m+1) of
// a value on the average, is at most an eighth of the picture's relative noise: the noise's
// variance then grows by at most a 64th. From 11 digits on, what 16 bits hold, nothing is done.
// Returns the digits after the point, 0 for none. The smallest values, below 2^-29 of the largest
// of their channel, keep fewer.
int round_layers(base::Image& image, double relative_noise);

// The image that was rounded to `digits` and its facts as what is kept: each channel times a power
// of two that brings it into the range of 16 bits.
[[nodiscard]] CachedResult packed_layers(base::Image image, int digits, Json facts);
// Back, bit for bit. Throws Json::exception where the facts are not of such a picture.
[[nodiscard]] base::Image unpacked_layers(CachedResult kept);

// What layers are off by at places of the picture, as a picture that is rounded for 16 bits: the
// places' pixels and a channel for each layer, a row for each part of the error.
[[nodiscard]] CachedResult packed_noise(const raytrace::LayerErrors& errors);
// Exact.
[[nodiscard]] CachedResult packed_regions(const raytrace::RegionNoise& regions);
[[nodiscard]] raytrace::RegionNoise unpacked_regions(CachedResult kept);
// Back.
void take_noise(CachedResult kept, raytrace::LayerErrors& errors);

}  // namespace earthshine::app
