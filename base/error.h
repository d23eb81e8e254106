// SPDX-License-Identifier: Apache-2.0
// The one exception type of the project. Libraries throw it; app/main prints it and chooses the
// exit code.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace earthshine::base {

// A position in a file that the user wrote. line and column start at 1; 0: unknown.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
};

// "scene.toml:14:3", or without unknown column or line: "scene.toml:14", "scene.toml".
[[nodiscard]] std::string to_string(const Location& location);

// Input: the command line, the scene or a file that it names is wrong (exit code 2).
// Work: valid input, but the work failed, such as by a full disk (exit code 1).
enum class Blame { Input, Work };

// A message has the place, the fault, the allowed values and the remedy. allowed and remedy are
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

// The system's text for an error number, e.g. "No such file or directory".
[[nodiscard]] std::string system_reason(int error_number);

// Blame for a file or folder that cannot be written. Input: the name is invalid (too long, below a
// file). Work: the system refuses (no permission, read only, full disk).
[[nodiscard]] Blame blame_of_target(int error_number);

// Terminal-safe text. All names from files and arguments are escaped before they are printed, so
// that none can move the cursor, change the writing direction or be invisible.

// Length in bytes of the UTF-8 character at the start of `text`; 0 if it is invalid (also overlong
// forms, surrogates and values above U+10FFFF).
[[nodiscard]] std::size_t utf8_length(std::string_view text);

// Escapes control characters below U+0020 and invalid UTF-8 as \xNN. Escapes DEL, U+0080 to U+009F,
// direction marks, line separators and zero-width characters as \uNNNN, which is the same character
// in JSON. kept: control characters that are not escaped.
[[nodiscard]] std::string escaped(std::string_view text, std::string_view kept = {});

}  // namespace earthshine::base
