// SPDX-License-Identifier: Apache-2.0
// Keyed random numbers: every number is a pure function of (seed, stream, item, index, dimension),
// never of thread, tile or call order, so results do not depend on how the work was split.
#pragma once

#include <array>
#include <cstdint>

namespace earthshine::base {

// What is being sampled. Two uses never share a stream.
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
  GatherStart
};

// A 64-bit mix of the key's parts (SplitMix64 finaliser, Steele et al. 2014).
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
// "Practical Hash-based Owen Scrambling", JCGT 9(4); direction numbers of Joe and Kuo 2008).
// Any power-of-two prefix is a (t, m, s)-net. Values lie in (0, 1).
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

}  // namespace earthshine::base
