// SPDX-License-Identifier: Apache-2.0
// A 64-bit digest of a sequence of values. Not cryptographic.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "base/numbers/random.h"
#include "base/units.h"

namespace earthshine::base {

class Digest {
 public:
  void add(std::uint64_t word) { state_ = mix64(state_ ^ mix64(word)); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const glm::dvec3& value) {
    for (int c = 0; c < 3; ++c) add(value[c]);
  }
  // The length is added first, so that "ab", "c" differs from "a", "bc".
  void add(std::string_view bytes) {
    add(std::uint64_t{bytes.size()});
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
      add(word);
    }
  }

  [[nodiscard]] std::uint64_t value() const { return state_; }
  // 16 hexadecimal digits.
  [[nodiscard]] std::string text() const {
    std::string digits(16, '0');
    for (std::size_t k = 0; k < digits.size(); ++k) {
      digits[k] = "0123456789abcdef"[(state_ >> (60 - 4 * k)) & 15U];
    }
    return digits;
  }

 private:
  std::uint64_t state_ = 0;
};

}  // namespace earthshine::base
