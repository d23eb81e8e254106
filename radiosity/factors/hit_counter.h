// SPDX-License-Identifier: Apache-2.0
// Counts a row's hits per patch: dense counts, and a bit per touched column so that they come out
// sorted without a sort.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace earthshine::radiosity {

class HitCounter {
 public:
  explicit HitCounter(std::size_t patches)
      : count_(patches, 0.0F), touched_((patches + 63) / 64, 0) {}

  [[nodiscard]] std::size_t patches() const { return count_.size(); }

  void add(std::uint32_t patch, float weight) {
    count_[patch] += weight;
    touched_[patch / 64] |= std::uint64_t{1} << (patch % 64);
  }

  // Appends the touched columns, ascending, with their counts; starts anew.
  void take(std::vector<std::uint32_t>& column, std::vector<float>& hits) {
    for (std::size_t word = 0; word < touched_.size(); ++word) {
      for (std::uint64_t bits = touched_[word]; bits != 0; bits &= bits - 1) {
        const std::size_t patch = 64 * word + static_cast<std::size_t>(std::countr_zero(bits));
        column.push_back(static_cast<std::uint32_t>(patch));
        hits.push_back(count_[patch]);
        count_[patch] = 0.0F;
      }
      touched_[word] = 0;
    }
  }

  void clear() {
    for (std::size_t word = 0; word < touched_.size(); ++word) {
      for (std::uint64_t bits = touched_[word]; bits != 0; bits &= bits - 1) {
        count_[64 * word + static_cast<std::size_t>(std::countr_zero(bits))] = 0.0F;
      }
      touched_[word] = 0;
    }
  }

 private:
  std::vector<float> count_;
  std::vector<std::uint64_t> touched_;
};

}  // namespace earthshine::radiosity
