// SPDX-License-Identifier: Apache-2.0
// What every picture of a comparison is held against, and how sure that makes of a target.
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

// As `targets`; none: not in view. mean: of the pair, per pixel. image: with the layer "variance".
// The noise of a target's luminance: of the mean over its pixels, with pixels as independent; the
// picture's from its variance layer, the reference's from the difference of the two. Neighbours
// that share gather rays are not independent, so that the picture's own part is a lower bound.
[[nodiscard]] std::vector<std::optional<TargetDifference>> target_differences(
    const base::Image& image, const std::vector<TargetView>& targets, const ReferencePair& pair,
    const std::vector<float>& mean);

// Whether two standard deviations of noise, of ratio and contrast each, leave `misleads` as it is.
[[nodiscard]] bool decided(const TargetDifference& difference);

// How far one picture's luminance is off another's, in bands of the ratio.

using Colour = std::array<std::uint8_t, 3>;  // sRGB

struct DifferenceBand {
  double above = 0.0;  // L / L_ref above this, up to that of the band before; the last: from 0
  Colour colour = {};
  std::string_view label;
};

// From far too bright to far too dark. Equal steps of lightness on both sides of white, and hues
// that people with a colour deficiency tell apart (RdBu of colorbrewer2.org
// in 11 classes, without its two palest).
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

// Pixels that show no object, which are not compared.
inline constexpr Colour difference_sky = {160, 160, 160};

// sRGB, row by row as the pictures, which have the same size; each pixel in its band's colour,
// black in both as no difference.
[[nodiscard]] std::vector<std::uint8_t> difference_picture(const base::Image& image,
                                                           const base::Image& reference,
                                                           const ObjectMap& map);

}  // namespace earthshine::studies
