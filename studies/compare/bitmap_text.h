// SPDX-License-Identifier: Apache-2.0
// Pixels, boxes and letters for pictures that must be read without anything beside them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace earthshine::studies {

using Colour = std::array<std::uint8_t, 3>;  // sRGB

// ASCII letters, digits and the punctuation of a caption, 5 x 7 pixels.
inline constexpr int letter_width = 5, letter_height = 7, letter_step = 6, line_step = 10;

// What lies outside is left out.
class Canvas {
 public:
  Canvas(int columns, int rows, const Colour& paper);
  void dot(int x, int y, const Colour& colour);
  void box(int left, int top, int width, int height, const Colour& colour);
  void text(int x, int y, std::string_view words, const Colour& ink);
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] const std::vector<std::uint8_t>& rgb() const { return rgb_; }

 private:
  int columns_, rows_;
  std::vector<std::uint8_t> rgb_;
};

// Lines of no more than the width, broken at blanks where there are any.
[[nodiscard]] std::vector<std::string> wrapped(std::string_view words, int width_px);

}  // namespace earthshine::studies
