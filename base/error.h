// SPDX-License-Identifier: Apache-2.0
// The one exception type of the project. Libraries throw it; app/main prints it and picks the exit
// code.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace earthshine::base {

// A place in a file the user wrote. line and column count from 1; 0 means "not known".
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
};

// "scene.toml:14:3", "scene.toml:14" or "scene.toml", as far as known.
[[nodiscard]] std::string to_string(const Location& location);

// Input: the call, the scene or a file it names is wrong (exit code 2).
// Work: the call was right but the work failed, e.g. a full disk (exit code 1).
enum class Blame { Input, Work };

// Every message says where, what was found, what is allowed and what to do. allowed and remedy are
// whole sentences without the final stop; either may be empty.
class Error : public std::runtime_error {
 public:
  Error(Blame blame, std::string_view where, std::string_view found, std::string_view allowed = {},
        std::string_view remedy = {});
  Error(Blame blame, const Location& where, std::string_view found, std::string_view allowed = {},
        std::string_view remedy = {});

  [[nodiscard]] Blame blame() const { return blame_; }

  // What the message is put together from. `where` may name an option or a setting as its file.
  struct Parts {
    Location where;
    std::string found, allowed, remedy;
  };
  [[nodiscard]] const Parts& parts() const { return *parts_; }

 private:
  Blame blame_;
  std::shared_ptr<const Parts> parts_;  // copies of an exception may not throw
};

// What the system says of an error number, e.g. "No such file or directory".
[[nodiscard]] std::string system_reason(int error_number);

// Whose fault it is that a file or folder cannot be written: Input where its name can be none (too
// long, below a file), Work where the machine refuses (no permission, read only, full).
[[nodiscard]] Blame blame_of_target(int error_number);

// The candidate nearest to `word` by edit distance, or "" when none is near enough to be meant:
// words that have no letter in common are not. Candidates: any range of strings. Large and small
// letters are alike.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

template <class Candidates>
[[nodiscard]] std::string nearest_word(std::string_view word, const Candidates& candidates) {
  std::size_t best = word.size() / 2 + 2;
  std::string found;
  for (const auto& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    const std::string_view other(candidate);
    if (distance < best && distance < std::max(word.size(), other.size())) {
      best = distance;
      found = std::string(other);
    }
  }
  return found;
}

// Text from files and calls made fit for a terminal. The program writes everything that a person
// reads through this, so that no name can move the cursor, turn the direction of writing or hide.

// Length in bytes of the UTF-8 character at the start of `text`; 0 if it is not one (overlong
// forms, surrogates and values beyond U+10FFFF included).
[[nodiscard]] std::size_t utf8_length(std::string_view text);

// Control characters below U+0020 and bytes that are not UTF-8 become \xNN; what else a terminal
// obeys or does not show (DEL, U+0080 to U+009F, marks of direction, separators of lines,
// characters without width) becomes \uNNNN, which in JSON means the same character. `kept`: control
// characters that stay.
[[nodiscard]] std::string escaped(std::string_view text, std::string_view kept = {});

}  // namespace earthshine::base
