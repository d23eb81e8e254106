// SPDX-License-Identifier: Apache-2.0
// Which pictures become which television frames: one still shown for some frames, or a row of
// pictures, one for each frame or, of an interlaced camera, for each field.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace earthshine::app {

struct TapeCall {
  std::vector<std::string> inputs;
  std::uint64_t frames = 0;  // how long a single input is shown; 0: not said
  bool fields = false;       // inputs are fields: two to a frame
  std::uint64_t first = 0;   // number of the first frame
};

struct TapeFrame {
  std::uint64_t number = 0;
  std::vector<std::string> inputs;  // one, or one for each field
};

// Throws base::Error (Input) when --frames stands beside several pictures, or fields are odd in
// number.
[[nodiscard]] std::vector<TapeFrame> lay_out(const TapeCall& call);

// The path with its run of # in the file's name replaced by the number, as wide as the run at
// least. Without # the path itself.
[[nodiscard]] std::string numbered(const std::string& path, std::uint64_t number);

// Throws base::Error (Input), naming `option`, when several frames would be written into one file.
void check_numbered(const std::string& option, const std::string& path, std::size_t frames);

}  // namespace earthshine::app
