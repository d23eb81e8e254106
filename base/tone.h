// SPDX-License-Identifier: Apache-2.0
// From radiance to a picture on a screen, for the clean view (the CCTV view has a chain of its
// own).
#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"

namespace earthshine::base {

// sRGB transfer function of IEC 61966-2-1, rounded to 8 bits; linear is clamped to [0, 1].
[[nodiscard]] std::uint8_t srgb_byte(double linear);

// An exposure. Pictures that are to be compared by eye share one.
struct ToneReport {
  double exposure = 1.0;         // display signal per cd/m^2 before the shoulder
  double white_cd_per_m2 = 0.0;  // luminance that reaches full white
};

struct ToneMapped {
  std::vector<std::uint8_t> rgb;  // width * height * 3, sRGB encoded
  ToneReport report;
};

// Global photographic operator (Reinhard et al. 2002, equation 4): the log-mean luminance of the
// lit pixels becomes middle grey 0.18, the 99.5th percentile becomes white (or signal 1, whichever
// is more, so that a flat picture stays grey). Lit: above 1e-5 of that percentile. Colours keep
// their ratios; a black image stays black; negative values count as 0. Throws base::Error (Work) on
// NaN or infinity. Deterministic; no local adaptation, so equal luminance is equal grey everywhere.
[[nodiscard]] ToneMapped tone_map(const Image& image);

// The same operator with an exposure given, such as another picture's report: equal luminance is
// equal grey in both. A white below signal 1 counts as 1. Throws as above.
[[nodiscard]] ToneMapped tone_map_with(const Image& image, const ToneReport& exposure);

// As a photograph is exposed: linear in the luminance, with a white that is given.
//   Shoulder  L / white up to 0.6, then 1 - 0.4 exp(-(L / white - 0.6) / 0.4): white itself is at
//             0.85 of the screen's, what is brighter keeps its differences
//   Clip      min(1, L / white): pixels can be read back, what is brighter than white is white
// Colours keep their ratios, as above. Throws as tone_map does.
enum class ToneCurve { Shoulder, Clip };
[[nodiscard]] ToneMapped expose(const Image& image, double white_cd_per_m2, ToneCurve curve);

// The luminance that `percent` of the lit pixels of all pictures together lie below (lit as for
// tone_map, by the brightest of them); 1 for black pictures.
[[nodiscard]] double white_at(const std::vector<const Image*>& pictures, double percent);

}  // namespace earthshine::base
