// SPDX-License-Identifier: Apache-2.0
// Which of a file's channels are its picture.
#pragma once

#include <string>
#include <vector>

namespace earthshine::base {

struct ExrPicture {
  enum class Kind { None, Rgb, Xyz, Luminance };
  Kind kind = Kind::None;
  std::vector<std::string> channels;  // three or one, as the file names them
  std::vector<std::string> layers;    // kind = None: several that could be meant
};
// As exr_reader.h has it.
[[nodiscard]] ExrPicture find_picture(const std::vector<std::string>& channels);

}  // namespace earthshine::base
