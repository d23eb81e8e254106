// SPDX-License-Identifier: Apache-2.0
// Lossless packing of half-float light layers for the console's page.
//
// A layer is R, G and B in cd/m^2 times 2^-exponent, each rounded to a half float (11 significant
// bits: a relative error of at most 2^-11). Halves are mapped to integers in the order of their
// values. R and B are stored as differences from G, which are small on surfaces of one colour. Each
// number is predicted from its neighbours (MED of JPEG-LS); the residuals' low and high bytes are
// deflated separately. console/src/unpack.js is the inverse.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace earthshine::app {

// IEEE 754 binary16, round to nearest, ties to even; infinity beyond its range.
[[nodiscard]] std::uint16_t half_bits(float value);

struct PackedLayer {
  int exponent = 0;   // value = half * 2^exponent
  std::string bytes;  // empty: black
};
// r, g, b: planes with `columns` values per row.
[[nodiscard]] PackedLayer pack_layer(std::span<const float> r, std::span<const float> g,
                                     std::span<const float> b, int columns);

// Ascending indices as runs of (gap, length), 32 bits each, deflated.
[[nodiscard]] std::string pack_runs(const std::vector<std::uint32_t>& indices);
// Object indices, -1 for none, as 16-bit values plus 1, deflated.
[[nodiscard]] std::string pack_objects(const std::vector<std::int32_t>& objects);

}  // namespace earthshine::app
