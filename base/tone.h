// SPDX-License-Identifier: Apache-2.0
// Tone mapping of radiance for the clean view. The CCTV view has its own chain (degrade/).
#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"

namespace earthshine::base {

// sRGB transfer function of IEC 61966-2-1, rounded to 8 bits; linear is clamped to [0, 1].
[[nodiscard]] std::uint8_t srgb_byte(double linear);
// Its inverse for a signal in [0, 1].
[[nodiscard]] double srgb_linear(double encoded);

// An exposure. Pictures for comparison by eye share one.
struct ToneReport {
  double exposure = 1.0;         // display signal per cd/m^2 below the shoulder
  double white_cd_per_m2 = 0.0;  // luminance that is displayed as full white
};

struct ToneMapped {
  std::vector<std::uint8_t> rgb;  // width * height * 3, sRGB encoded
  ToneReport report;
};

// Global photographic operator (Reinhard et al. 2002, equation 4). The log-mean luminance of the
// lit pixels becomes middle grey 0.18. The 99.5th percentile becomes white, or signal 1 if that is
// more, so that a flat picture stays grey. Lit: above 1e-5 of this percentile. Colours keep their
// ratios, a black image stays black, negative values become 0. Throws base::Error (Work) on NaN or
// infinity. No local adaptation: equal luminance is equal grey everywhere.
[[nodiscard]] ToneMapped tone_map(const Image& image);

// The same operator with a given exposure, such as another picture's report: equal luminance is
// equal grey in both. A white below signal 1 counts as 1. Throws as above.
[[nodiscard]] ToneMapped tone_map_with(const Image& image, const ToneReport& exposure);

// Photographic exposure: linear in luminance up to a given white.
//   Shoulder  L / white up to 0.6, then 1 - 0.4 exp(-(L / white - 0.6) / 0.4): white is displayed
//             at 0.85, and brighter values stay distinct
//   Clip      min(1, L / white): pixels are invertible up to white
// Colours keep their ratios. Throws as tone_map does.
enum class ToneCurve { Shoulder, Clip };
[[nodiscard]] ToneMapped expose(const Image& image, double white_cd_per_m2, ToneCurve curve);

// Luminance percentile of the lit pixels of all pictures together, cd/m^2 (lit as in tone_map, over
// all pictures together); 1 for black pictures.
[[nodiscard]] double white_at(const std::vector<const Image*>& pictures, double percent);

}  // namespace earthshine::base
