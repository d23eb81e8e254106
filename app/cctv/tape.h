// SPDX-License-Identifier: Apache-2.0
// Pictures as television frames.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace earthshine::app {

// Maps pictures to television frames: one still for several frames, or a sequence of pictures, one
// per frame or, for an interlaced camera, one per field.
struct TapeCall {
  std::vector<std::string> inputs;
  std::uint64_t frames = 0;  // number of frames of a single input; 0: unset
  bool fields = false;       // inputs are fields, two per frame
  std::uint64_t first = 0;   // number of the first frame
};

struct TapeFrame {
  std::uint64_t number = 0;
  std::vector<std::string> inputs;  // one, or one per field
};

// Throws base::Error (Input) for --frames with several pictures, and for an odd number of fields.
[[nodiscard]] std::vector<TapeFrame> lay_out(const TapeCall& call);

// The path with the # characters in its file name replaced by the number, zero-padded to their
// count. Without # the path itself.
[[nodiscard]] std::string numbered(const std::string& path, std::uint64_t number);

// Throws base::Error (Input), naming `option`, if several frames would share a file.
void check_numbered(const std::string& option, const std::string& path, std::size_t frames);

}  // namespace earthshine::app
