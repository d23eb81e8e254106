// SPDX-License-Identifier: Apache-2.0
// The reference of a comparison, and the confidence of its verdicts.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/image.h"
#include "studies/compare/compare.h"
#include "studies/targets/target_view.h"

namespace earthshine::studies {

// As `targets`; empty: not in view. mean: of the pair, per pixel. image: with the layer "variance".
// The noise of a target's luminance is that of the mean over its pixels, assumed independent: in
// the picture from its variance layer, in the reference from the difference of the pair. Neighbours
// that share gather rays are correlated, so that the picture's part is a lower bound.
[[nodiscard]] std::vector<std::optional<TargetDifference>> target_differences(
    const base::Image& image, const std::vector<TargetView>& targets, const ReferencePair& pair,
    const std::vector<float>& mean);

// Whether `misleads` is the same at two standard deviations of ratio and contrast.
[[nodiscard]] bool decided(const TargetDifference& difference);

// Bands of the ratio of two pictures' luminances.

using Colour = std::array<std::uint8_t, 3>;  // sRGB

struct DifferenceBand {
  double above = 0.0;  // L / L_ref above this, up to the band before; the last: from 0
  Colour colour = {};
  std::string_view label;
};

// From far too bright to far too dark. Equal steps of lightness on both sides of white, in hues
// that are distinct with colour vision deficiencies (RdBu of colorbrewer2.org in 11 classes,
// without its two palest).
inline constexpr std::array<DifferenceBand, 9> difference_bands = {
    {{4.0, {103, 0, 31}, "over ×4"},
     {2.0, {178, 24, 43}, "×2 to ×4"},
     {1.5, {214, 96, 77}, "×1.5 to ×2"},
     {1.1, {244, 165, 130}, "×1.1 to ×1.5, too bright"},
     {1.0 / 1.1, {247, 247, 247}, "within ×1.1, or black in both"},
     {1.0 / 1.5, {146, 197, 222}, "÷1.1 to ÷1.5, too dark"},
     {1.0 / 2.0, {67, 147, 195}, "÷1.5 to ÷2"},
     {1.0 / 4.0, {33, 102, 172}, "÷2 to ÷4"},
     {0.0, {5, 48, 97}, "under ÷4"}}};

// Pixels without an object, which are not compared.
inline constexpr Colour difference_sky = {160, 160, 160};

// sRGB, row by row, for pictures of equal size. Each pixel has its band's colour; black in both
// counts as equal.
[[nodiscard]] std::vector<std::uint8_t> difference_picture(const base::Image& image,
                                                           const base::Image& reference,
                                                           const ObjectMap& map);

}  // namespace earthshine::studies
