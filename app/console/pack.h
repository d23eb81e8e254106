// SPDX-License-Identifier: Apache-2.0
// Layers of light as the console's page has them: half floats, packed without loss.
//
// A layer is R, G and B in cd/m^2 times 2^-exponent, each rounded to a half float (11 significant
// bits, so a relative error of at most 2^-11). The halves become whole numbers in the order of
// their values; R and B are stored as differences from G, which are small where a surface has one
// colour; each number is predicted from its neighbours (MED of JPEG-LS) and the residuals' low and
// high bytes are deflated apart. console/src/unpack.js is the inverse.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace earthshine::app {

// IEEE 754 binary16, to nearest, ties to even; beyond its range infinity.
[[nodiscard]] std::uint16_t half_bits(float value);

struct PackedLayer {
  int exponent = 0;   // value = half * 2^exponent
  std::string bytes;  // empty: black
};
// r, g, b: planes of `columns` values a row.
[[nodiscard]] PackedLayer pack_layer(std::span<const float> r, std::span<const float> g,
                                     std::span<const float> b, int columns);

// Ascending indices as runs, (gap, length) of 32 bits each, deflated.
[[nodiscard]] std::string pack_runs(const std::vector<std::uint32_t>& indices);
// Objects by number from 0, -1 none, as 16 bits + 1, deflated.
[[nodiscard]] std::string pack_objects(const std::vector<std::int32_t>& objects);

}  // namespace earthshine::app
