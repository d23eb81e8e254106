// SPDX-License-Identifier: Apache-2.0
#include "base/numbers/sobol_set.h"

#include <algorithm>
#include <numeric>

namespace earthshine::base {
namespace {

std::uint32_t sobol(std::size_t dimension, std::uint32_t index) {
  std::uint32_t x = 0;
  for (std::size_t bit = 0; bit < 32; ++bit) {
    if ((index >> bit) & 1U) x ^= sobol_matrices[dimension][bit];
  }
  return x;
}

// Interleaves the upper halves of both numbers bit by bit (Morton code).
std::uint32_t interleave(std::uint32_t x, std::uint32_t y) {
  std::uint32_t z = 0;
  for (int bit = 31; bit >= 16; --bit) {
    z = (z << 2) | (((x >> bit) & 1U) << 1) | ((y >> bit) & 1U);
  }
  return z;
}

}  // namespace

SobolSet4::SobolSet4(std::uint32_t count) : count_(count) {
  std::vector<std::uint32_t> order(count), morton(count);
  std::iota(order.begin(), order.end(), 0U);
  for (std::uint32_t i = 0; i < count; ++i) morton[i] = interleave(sobol(0, i), sobol(1, i));
  std::sort(order.begin(), order.end(), [&morton](std::uint32_t a, std::uint32_t b) {
    return morton[a] != morton[b] ? morton[a] < morton[b] : a < b;
  });
  for (std::size_t d = 0; d < 4; ++d) {
    bits_[d].reserve(std::max(count, width));
    for (const std::uint32_t i : order) bits_[d].push_back(reverse_bits(sobol(d, i)));
    for (std::uint32_t k = count; k < width; ++k) bits_[d].push_back(bits_[d][k % count]);
  }
}

SobolSet4::Scramble::Scramble(Key key) : seed{}, run{} {
  for (std::uint32_t d = 0; d < 4; ++d) {
    seed[d] = static_cast<std::uint32_t>(mix64(key.value ^ (d + 1)) >> 32);
  }
}

void SobolSet4::go_to_run(std::uint32_t run, Scramble& scramble) const {
  for (std::size_t d = 0; d < 4; ++d) scramble.run[d] = reverse_bits(sobol(d, run * count()));
}

void SobolSet4::points(std::uint32_t first, const Scramble& scramble, Points& out) const {
  for (std::size_t d = 0; d < 4; ++d) {
    const std::uint32_t* bits = &bits_[d][first];
    const std::uint32_t seed = scramble.seed[d], run = scramble.run[d];
    for (std::uint32_t k = 0; k < width; ++k) {
      out.x[d][k] = to_open_unit(reverse_bits(laine_karras(bits[k] ^ run, seed)));
    }
  }
}

}  // namespace earthshine::base
