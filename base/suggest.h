// SPDX-License-Identifier: Apache-2.0
// Which of the allowed words a wrong one may have meant.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace earthshine::base {

// Insertions, deletions, substitutions and exchanges of neighbours that turn one word into the
// other. Large and small letters are alike.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

// The candidate that `word` misspells by a few letters, else one that begins with it ("fov" for
// "fov_deg") or has it as one of its words ("samples" for "camera_samples"), else one of the same
// meaning ("power" for "flux"); "" if there is none.
[[nodiscard]] std::string nearest_word(std::string_view word,
                                       std::span<const std::string> candidates);
template <class Candidates>
[[nodiscard]] std::string nearest_word(std::string_view word, const Candidates& candidates) {
  const std::vector<std::string> words(std::begin(candidates), std::end(candidates));
  return nearest_word(word, std::span<const std::string>(words));
}

}  // namespace earthshine::base
