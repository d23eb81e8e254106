// SPDX-License-Identifier: Apache-2.0
#include "app/console/pack.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/files/deflate.h"

namespace earthshine::app {
namespace {

using Numbers = std::vector<std::uint16_t>;

constexpr std::uint16_t sign_bit = 0x8000;

// Maps half floats to integers in the order of their values; both zeros are 0x8000.
std::uint16_t ordered(std::uint16_t half) {
  const int magnitude = half & 0x7fff;
  return static_cast<std::uint16_t>((half & sign_bit) != 0 ? sign_bit - magnitude
                                                           : sign_bit + magnitude);
}

Numbers ordered_halves(std::span<const float> values, int exponent) {
  Numbers numbers(values.size());
  std::transform(values.begin(), values.end(), numbers.begin(),
                 [&](float value) { return ordered(half_bits(std::ldexp(value, -exponent))); });
  return numbers;
}

Numbers differences(const Numbers& from, const Numbers& of) {
  Numbers result(from.size());
  std::transform(from.begin(), from.end(), of.begin(), result.begin(),
                 [](auto a, auto b) { return static_cast<std::uint16_t>(a - b + sign_bit); });
  return result;
}

// Median of left, above and left + above - corner (ISO 14495-1, A.3).
int predicted(const Numbers& plane, std::size_t i, std::size_t columns) {
  const bool has_left = i % columns != 0, has_above = i >= columns;
  if (!has_left && !has_above) return sign_bit;
  if (!has_above) return plane[i - 1];
  if (!has_left) return plane[i - columns];
  const int left = plane[i - 1], above = plane[i - columns], corner = plane[i - columns - 1];
  if (corner >= std::max(left, above)) return std::min(left, above);
  if (corner <= std::min(left, above)) return std::max(left, above);
  return left + above - corner;
}

// Low bytes of the residuals, then high bytes; zigzag coding makes small residuals small integers.
void add_residuals(const Numbers& plane, std::size_t columns, std::vector<std::uint8_t>& bytes) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + 2 * plane.size());
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const auto residual = static_cast<std::int16_t>(plane[i] - predicted(plane, i, columns));
    const auto folded = static_cast<std::uint16_t>(residual < 0 ? -2 * residual - 1 : 2 * residual);
    bytes[begin + i] = static_cast<std::uint8_t>(folded & 0xff);
    bytes[begin + plane.size() + i] = static_cast<std::uint8_t>(folded >> 8);
  }
}

template <class Number>
std::string deflated_numbers(const std::vector<Number>& numbers) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(numbers.size() * sizeof(Number));
  for (const Number number : numbers) {
    for (std::size_t k = 0; k < sizeof(Number); ++k) {
      bytes.push_back(static_cast<std::uint8_t>((number >> (8 * k)) & 0xff));
    }
  }
  return base::deflated(bytes);
}

}  // namespace

std::uint16_t half_bits(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>((bits >> 16) & sign_bit);
  const float magnitude = std::abs(value);
  if (!(magnitude < 65520.0F)) return static_cast<std::uint16_t>(sign | 0x7c00);
  // Steps of 2^-24 below 2^-14, then 2^10 steps per octave.
  int power = -14;
  if (magnitude >= 0x1p-14F) power = std::ilogb(magnitude);
  const auto steps = static_cast<int>(std::nearbyint(std::ldexp(magnitude, 10 - power)));
  return static_cast<std::uint16_t>(sign | ((power + 14) * 1024 + steps));
}

PackedLayer pack_layer(std::span<const float> r, std::span<const float> g, std::span<const float> b,
                       int columns) {
  float largest = 0.0F;
  for (const std::span<const float>& plane : {r, g, b}) {
    for (const float value : plane) largest = std::max(largest, std::abs(value));
  }
  PackedLayer layer;
  if (!(largest > 0.0F)) return layer;
  layer.exponent = std::ilogb(largest) - 14;
  const Numbers green = ordered_halves(g, layer.exponent);
  const auto width = static_cast<std::size_t>(columns);
  std::vector<std::uint8_t> bytes;
  add_residuals(green, width, bytes);
  add_residuals(differences(ordered_halves(r, layer.exponent), green), width, bytes);
  add_residuals(differences(ordered_halves(b, layer.exponent), green), width, bytes);
  layer.bytes = base::deflated(bytes);
  return layer;
}

std::string pack_runs(const std::vector<std::uint32_t>& indices) {
  std::vector<std::uint32_t> runs;
  std::uint32_t end = 0;
  for (std::size_t i = 0; i < indices.size();) {
    const std::uint32_t first = indices[i];
    std::uint32_t length = 1;
    while (++i < indices.size() && indices[i] == first + length) ++length;
    runs.push_back(first - end);
    runs.push_back(length);
    end = first + length;
  }
  return deflated_numbers(runs);
}

std::string pack_objects(const std::vector<std::int32_t>& objects) {
  std::vector<std::uint16_t> numbers(objects.size());
  std::transform(objects.begin(), objects.end(), numbers.begin(),
                 [](std::int32_t object) { return static_cast<std::uint16_t>(object + 1); });
  return deflated_numbers(numbers);
}

}  // namespace earthshine::app
