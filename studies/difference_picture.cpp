// SPDX-License-Identifier: Apache-2.0
#include "studies/difference_picture.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

namespace earthshine::studies {
namespace {

using Colour = std::array<std::uint8_t, 3>;

// From far too bright to far too dark. Equal steps of lightness on both sides of white, and hues
// that people with a colour deficiency tell apart.
constexpr std::array<Colour, 9> band_colours = {{{103, 0, 31},
                                                 {178, 24, 43},
                                                 {214, 96, 77},
                                                 {244, 165, 130},
                                                 {247, 247, 247},
                                                 {146, 197, 222},
                                                 {67, 147, 195},
                                                 {33, 102, 172},
                                                 {5, 48, 97}}};
// Between band k and band k + 1.
constexpr std::array<double, 8> limits = {4.0,       2.0,       1.5,       1.1,
                                          1.0 / 1.1, 1.0 / 1.5, 1.0 / 2.0, 1.0 / 4.0};
constexpr std::array<std::string_view, 8> labels = {"x4",   "x2",   "x1.5", "x1.1",
                                                    "/1.1", "/1.5", "/2",   "/4"};

std::size_t band_of(double value, double reference) {
  const double ratio = reference > 0.0 ? value / reference
                       : value > 0.0   ? std::numeric_limits<double>::infinity()
                                       : 1.0;
  std::size_t band = 0;
  while (band < limits.size() && ratio <= limits[band]) ++band;
  return band;
}

// Just the letters of the labels, 5 x 7, a bit per pixel, the leftmost highest.
struct Glyph {
  char letter;
  std::array<std::uint8_t, 7> rows;
};
constexpr std::array<Glyph, 7> glyphs = {
    {{'1', {0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110}},
     {'2', {0b01110, 0b10001, 0b00001, 0b00010, 0b00100, 0b01000, 0b11111}},
     {'4', {0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010}},
     {'5', {0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110}},
     {'.', {0b00000, 0b00000, 0b00000, 0b00000, 0b00000, 0b01100, 0b01100}},
     {'x', {0b00000, 0b00000, 0b10001, 0b01010, 0b00100, 0b01010, 0b10001}},
     {'/', {0b00001, 0b00001, 0b00010, 0b00100, 0b01000, 0b10000, 0b10000}}}};
constexpr int letter_width = 5, letter_height = 7, letter_step = 6;

constexpr int gap = 6, box_width = 14, box_height = 14, letters = 4;
constexpr int scale_width = gap + box_width + 3 + letters * letter_step + 1;
constexpr int scale_height = box_height * static_cast<int>(band_colours.size());
constexpr Colour paper = {255, 255, 255}, ink = {0, 0, 0};

class Canvas {
 public:
  Canvas(int columns, int rows) {
    picture_.columns = columns;
    picture_.rows = rows;
    picture_.rgb.assign(3 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
                        paper[0]);
  }
  void dot(int x, int y, const Colour& colour) {
    const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.columns) +
                    static_cast<std::size_t>(x);
    std::copy(colour.begin(), colour.end(),
              picture_.rgb.begin() + static_cast<std::ptrdiff_t>(3 * at));
  }
  void text(int x, int y, std::string_view word) {
    for (const char letter : word) {
      const auto glyph = std::find_if(glyphs.begin(), glyphs.end(),
                                      [&](const Glyph& g) { return g.letter == letter; });
      for (int row = 0; row < letter_height; ++row) {
        for (int column = 0; column < letter_width; ++column) {
          const unsigned bit = 1U << static_cast<unsigned>(letter_width - 1 - column);
          if ((glyph->rows[static_cast<std::size_t>(row)] & bit) != 0) {
            dot(x + column, y + row, ink);
          }
        }
      }
      x += letter_step;
    }
  }
  [[nodiscard]] DifferencePicture take() { return std::move(picture_); }

 private:
  DifferencePicture picture_;
};

void draw_scale(Canvas& canvas, int left) {
  for (int y = 0; y < scale_height; ++y) {
    const Colour& colour = band_colours[static_cast<std::size_t>(y / box_height)];
    for (int x = 0; x < box_width; ++x) canvas.dot(left + gap + x, y, colour);
  }
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const int limit = box_height * static_cast<int>(k + 1);
    canvas.text(left + gap + box_width + 3, limit - letter_height / 2, labels[k]);
  }
}

}  // namespace

DifferencePicture difference_picture(const base::Image& image, const base::Image& reference) {
  const std::vector<float> value = base::luminance_of(image);
  const std::vector<float> right = base::luminance_of(reference);
  Canvas canvas(image.width + scale_width, std::max(image.height, scale_height));
  std::size_t i = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x, ++i) {
      canvas.dot(x, y, band_colours[band_of(double(value[i]), double(right[i]))]);
    }
  }
  draw_scale(canvas, image.width);
  return canvas.take();
}

}  // namespace earthshine::studies
