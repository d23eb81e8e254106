// SPDX-License-Identifier: Apache-2.0
#include "base/numbers/random.h"

namespace earthshine::base {
namespace {

// Sobol matrices per byte of the index: four look-ups instead of up to 32 steps.
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

constexpr std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  return reverse_bits(laine_karras(reverse_bits(x), seed));
}

template <std::size_t Dimension>
float coordinate(std::uint32_t i, std::uint32_t seed) {
  const auto& table = sobol_bytes[Dimension];
  const std::uint32_t x = table[0][i & 255U] ^ table[1][(i >> 8) & 255U] ^
                          table[2][(i >> 16) & 255U] ^ table[3][i >> 24];
  return to_open_unit(owen_scramble(x, seed));
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
