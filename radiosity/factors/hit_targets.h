// SPDX-License-Identifier: Apache-2.0
// Patch of a ray's hit: the arithmetic of Patches::find in single precision, half a cache line per
// triangle.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

class HitTargets {
 public:
  // passes_on: per material, whether rays continue from it (mirror, glass).
  HitTargets(const Patches& patches, const std::vector<bool>& passes_on)
      : patches_(patches), targets_(patches.of_triangle.size()) {
    for (std::size_t k = 0; k < targets_.size(); ++k) {
      const Facet& facet = patches.facets[patches.of_triangle[k]];
      const auto half = static_cast<std::uint8_t>(triangle_kinds + patches.second_half[k]);
      targets_[k] = {facet.s_count,
                     facet.t_count,
                     facet.first_front,
                     facet.first_back,
                     facet.tree,
                     facet.is_cluster()    ? cluster_kind
                     : facet.parallelogram ? half
                                           : facet.apex,
                     static_cast<std::uint8_t>(passes_on[facet.material])};
    }
  }

  [[nodiscard]] bool passes_on(std::uint32_t triangle) const {
    return targets_[triangle].passes_on != 0;
  }

  // Accepts any number, including no_triangle.
  void prefetch(std::uint32_t triangle) const {
    if (triangle < targets_.size()) __builtin_prefetch(&targets_[triangle]);
  }

  // As Patches::find; no_patch for the back of a one-sided surface.
  [[nodiscard]] std::uint32_t find(std::uint32_t triangle, float u, float v, bool front) const {
    const Target& target = targets_[triangle];
    const std::uint32_t first = front ? target.first_front : target.first_back;
    if (first == no_patch) return no_patch;
    if (target.kind == cluster_kind) {
      return target.tree == no_tree
                 ? first
                 : first + patches_.leaf(patches_.facets[patches_.of_triangle[triangle]],
                                         patches_.parameters(triangle, double(u), double(v)));
    }
    const Linear& to = linear[target.kind];
    const float s = to.s[0] + to.s[1] * u + to.s[2] * v;
    float t = to.t[0] + to.t[1] * u + to.t[2] * v;
    if (target.kind < triangle_kinds) t = s > 0.0F ? t / s : 0.0F;
    if (target.tree != no_tree) {
      const Facet& facet = patches_.facets[patches_.of_triangle[triangle]];
      return first + patches_.leaf(facet, {s, t});
    }
    return first + cell(s, target.s_count) * target.t_count + cell(t, target.t_count);
  }

 private:
  struct alignas(32) Target {
    std::uint32_t s_count, t_count;
    std::uint32_t first_front, first_back, tree;
    std::uint8_t kind, passes_on;
  };

  // s and t as s[0] + s[1] u + s[2] v, by kind: triangles with apex 0, 1, 2 (s t instead of t), the
  // first and the second half of a parallelogram.
  struct Linear {
    float s[3], t[3];
  };
  static constexpr std::uint8_t triangle_kinds = 3, cluster_kind = 5;
  static constexpr Linear linear[5] = {{{0, 1, 1}, {0, 0, 1}},
                                       {{1, -1, 0}, {1, -1, -1}},
                                       {{1, 0, -1}, {0, 1, 0}},
                                       {{0, 1, 1}, {0, 0, 1}},
                                       {{0, 1, 0}, {0, 1, 1}}};

  static std::uint32_t cell(float x, std::uint32_t count) {
    const auto index = static_cast<std::int32_t>(x * static_cast<float>(count));
    const auto last = static_cast<std::int32_t>(count) - 1;
    return static_cast<std::uint32_t>(index < 0 ? 0 : index > last ? last : index);
  }

  const Patches& patches_;
  std::vector<Target> targets_;
};

// Counts a row's hits per patch: dense counts and one bit per touched column, which yields the
// columns in order without sorting.

class HitCounter {
 public:
  explicit HitCounter(std::size_t patches)
      : count_(patches, 0.0F), touched_((patches + 63) / 64, 0) {}

  [[nodiscard]] std::size_t patches() const { return count_.size(); }

  void add(std::uint32_t patch, float weight) {
    count_[patch] += weight;
    touched_[patch / 64] |= std::uint64_t{1} << (patch % 64);
  }

  // Appends the touched columns, ascending, with their counts; then resets.
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
