// SPDX-License-Identifier: Apache-2.0
// Keyed random numbers. Each is a pure function of (seed, stream, item, index, dimension) and not
// of thread, tile or call order, so that results do not depend on the division of work.
#pragma once

#include <array>
#include <cstdint>

namespace earthshine::base {

// Purpose of the samples. Two uses never share a stream.
enum class Stream : std::uint32_t {
  FormFactor = 1,
  DirectLight,
  LampFlux,
  Pixel,
  Lens,
  FinalGather,
  LightSample,
  Lobe,
  Roulette,
  ShotNoise,
  ReadNoise,
  Test,
  HalfSample,
  ExactOpening,
  Refinement,
  Path,
  RangeNoise,
  ErrorBudget,
  Residual,
  GatherOrigin,
  ShutInLight,
  Dataset
};

// 64-bit mixing function (finaliser of SplitMix64, Steele et al. 2014).
[[nodiscard]] constexpr std::uint64_t mix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

struct Key {
  std::uint64_t value = 0;
  Key(std::uint64_t seed, Stream stream, std::uint64_t item)
      : value(mix64(mix64(mix64(seed) ^ static_cast<std::uint64_t>(stream)) ^ item)) {}
  [[nodiscard]] Key with(std::uint64_t part) const {
    Key key = *this;
    key.value = mix64(value ^ mix64(part));
    return key;
  }
};

// Counter-based generator: the n-th draw of a key, uniform in [0, 1) with 53 bits.
[[nodiscard]] inline double uniform(Key key, std::uint64_t n) {
  return static_cast<double>(mix64(key.value + n * 0xd1342543de82ef95ULL) >> 11) * 0x1p-53;
}

// Sequential draws of one key.
class Rng {
 public:
  explicit Rng(Key key) : key_(key) {}
  [[nodiscard]] double next() { return uniform(key_, count_++); }

 private:
  Key key_;
  std::uint64_t count_ = 0;
};

// Owen-scrambled Sobol points in four dimensions, scrambled and shuffled per key (Burley 2020,
// "Practical Hash-based Owen Scrambling", JCGT 9(4); direction numbers of Joe and Kuo 2008). The
// first 2^k points are a (t, m, s)-net for any k. Values are in (0, 1).
class SobolOwen4 {
 public:
  explicit SobolOwen4(Key key);
  [[nodiscard]] std::array<float, 4> point(std::uint32_t index) const;
  // The first two dimensions of point(index), at half the cost.
  [[nodiscard]] std::array<float, 2> point2(std::uint32_t index) const;

 private:
  std::uint32_t shuffle_seed_;
  std::array<std::uint32_t, 4> scramble_seed_;
};

// Bit operations shared by SobolOwen4 and SobolSet4 (Burley 2020; Joe and Kuo 2008).

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
  x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
  x = ((x >> 4) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4);
  return (x >> 24) | ((x >> 8) & 0xff00U) | ((x << 8) & 0xff0000U) | (x << 24);
}

// Laine-Karras permutation with Vegdahl's constants: each output bit depends on lower bits only. On
// the bit-reversed number this is Owen scrambling.
constexpr std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return x;
}

// 23 bits plus half a step keep the value inside (0, 1) in single precision.
constexpr float to_open_unit(std::uint32_t bits) {
  return (static_cast<float>(static_cast<std::int32_t>(bits >> 9)) + 0.5F) * 0x1p-23F;
}

using SobolMatrix = std::array<std::uint32_t, 32>;

// Direction numbers from a primitive polynomial of degree s with coefficients a and initial numbers
// m (Joe and Kuo 2008, table new-joe-kuo-6, dimensions 1 to 4).
constexpr SobolMatrix sobol_direction_numbers(std::uint32_t s, std::uint32_t a,
                                              std::array<std::uint32_t, 3> m) {
  SobolMatrix v{};
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

inline constexpr std::array<SobolMatrix, 4> sobol_matrices = {
    sobol_direction_numbers(0, 0, {}), sobol_direction_numbers(1, 0, {1, 0, 0}),
    sobol_direction_numbers(2, 1, {1, 3, 0}), sobol_direction_numbers(3, 1, {1, 3, 1})};

}  // namespace earthshine::base
