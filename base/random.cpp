// SPDX-License-Identifier: Apache-2.0
#include "base/random.h"

namespace earthshine::base {
namespace {

using Matrix = std::array<std::uint32_t, 32>;

// Direction numbers from a primitive polynomial of degree s with coefficients a and first numbers m
// (Joe and Kuo 2008, table new-joe-kuo-6, dimensions 1 to 4).
constexpr Matrix direction_numbers(std::uint32_t s, std::uint32_t a,
                                   std::array<std::uint32_t, 3> m) {
  Matrix v{};
  if (s == 0) {
    for (std::uint32_t i = 0; i < 32; ++i) v[i] = 1U << (31 - i);
    return v;
  }
  for (std::uint32_t i = 0; i < s; ++i) v[i] = m[i] << (31 - i);
  for (std::uint32_t i = s; i < 32; ++i) {
    v[i] = v[i - s] ^ (v[i - s] >> s);
    for (std::uint32_t k = 1; k < s; ++k) v[i] ^= ((a >> (s - 1 - k)) & 1U) * v[i - k];
  }
  return v;
}

constexpr std::array<Matrix, 4> sobol_matrices = {
    direction_numbers(0, 0, {}), direction_numbers(1, 0, {1, 0, 0}),
    direction_numbers(2, 1, {1, 3, 0}), direction_numbers(3, 1, {1, 3, 1})};

// The matrices applied a byte of the index at a time: four look-ups instead of up to 32 steps.
constexpr std::array<std::array<std::array<std::uint32_t, 256>, 4>, 4> byte_tables() {
  std::array<std::array<std::array<std::uint32_t, 256>, 4>, 4> tables{};
  for (std::size_t d = 0; d < 4; ++d) {
    for (std::size_t byte = 0; byte < 4; ++byte) {
      for (std::uint32_t value = 0; value < 256; ++value) {
        std::uint32_t x = 0;
        for (std::size_t bit = 0; bit < 8; ++bit) {
          if ((value >> bit) & 1U) x ^= sobol_matrices[d][8 * byte + bit];
        }
        tables[d][byte][value] = x;
      }
    }
  }
  return tables;
}
constexpr auto sobol_bytes = byte_tables();

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
  x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
  x = ((x >> 4) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4);
  return __builtin_bswap32(x);
}

// Laine-Karras permutation with Vegdahl's constants: each output bit depends on lower bits only,
// which on the reversed number is Owen scrambling.
constexpr std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return x;
}

constexpr std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  return reverse_bits(laine_karras(reverse_bits(x), seed));
}

template <std::size_t Dimension>
float coordinate(std::uint32_t i, std::uint32_t seed) {
  const auto& table = sobol_bytes[Dimension];
  const std::uint32_t x = table[0][i & 255U] ^ table[1][(i >> 8) & 255U] ^
                          table[2][(i >> 16) & 255U] ^ table[3][i >> 24];
  // 23 bits and half a step keep the value strictly inside (0, 1) in single precision.
  return (static_cast<float>(owen_scramble(x, seed) >> 9) + 0.5F) * 0x1p-23F;
}

}  // namespace

SobolOwen4::SobolOwen4(Key key)
    : shuffle_seed_(static_cast<std::uint32_t>(mix64(key.value) >> 32)), scramble_seed_{} {
  for (std::uint32_t d = 0; d < 4; ++d) {
    scramble_seed_[d] = static_cast<std::uint32_t>(mix64(key.value ^ (d + 1)) >> 32);
  }
}

std::array<float, 4> SobolOwen4::point(std::uint32_t index) const {
  const std::uint32_t i = owen_scramble(index, shuffle_seed_);
  return {coordinate<0>(i, scramble_seed_[0]), coordinate<1>(i, scramble_seed_[1]),
          coordinate<2>(i, scramble_seed_[2]), coordinate<3>(i, scramble_seed_[3])};
}

std::array<float, 2> SobolOwen4::point2(std::uint32_t index) const {
  const std::uint32_t i = owen_scramble(index, shuffle_seed_);
  return {coordinate<0>(i, scramble_seed_[0]), coordinate<1>(i, scramble_seed_[1])};
}

}  // namespace earthshine::base
