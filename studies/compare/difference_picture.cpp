// SPDX-License-Identifier: Apache-2.0
#include "studies/compare/difference_picture.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <utility>

#include "studies/compare/bitmap_text.h"

namespace earthshine::studies {
namespace {

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

constexpr int gap = 6, box_width = 14, box_height = 14, letters = 4;
constexpr int scale_width = gap + box_width + 3 + letters * letter_step + 1;
constexpr int scale_height = box_height * static_cast<int>(band_colours.size());
constexpr int captioned_height =
    scale_height + gap + box_height;  // with the box of what is left out
constexpr int least_captioned_width = 300;
constexpr int magnified_to = 256;  // small pictures, so that they can be seen beside the scale
constexpr Colour paper = {255, 255, 255}, ink = {0, 0, 0}, left_out = {160, 160, 160};

void draw_scale(Canvas& canvas, int left) {
  for (std::size_t band = 0; band < band_colours.size(); ++band) {
    canvas.box(left + gap, box_height * static_cast<int>(band), box_width, box_height,
               band_colours[band]);
  }
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const int limit = box_height * static_cast<int>(k + 1);
    canvas.text(left + gap + box_width + 3, limit - letter_height / 2, labels[k], ink);
  }
}

// Each pixel as a square of `edge` dots.
void draw_picture(Canvas& canvas, const base::Image& image, const base::Image& reference,
                  const ObjectMap* map, int edge) {
  const std::vector<float> value = base::luminance_of(image);
  const std::vector<float> right = base::luminance_of(reference);
  std::size_t i = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x, ++i) {
      const bool shown = map == nullptr || map->object[i] != no_object;
      canvas.box(edge * x, edge * y, edge, edge,
                 shown ? band_colours[band_of(double(value[i]), double(right[i]))] : left_out);
    }
  }
}

DifferencePicture taken(const Canvas& canvas) {
  return {canvas.columns(), canvas.rows(), canvas.rgb()};
}

}  // namespace

DifferencePicture difference_picture(const base::Image& image, const base::Image& reference) {
  Canvas canvas(image.width + scale_width, std::max(image.height, scale_height), paper);
  draw_picture(canvas, image, reference, nullptr, 1);
  draw_scale(canvas, image.width);
  return taken(canvas);
}

DifferencePicture difference_picture(const base::Image& image, const base::Image& reference,
                                     const ObjectMap& map,
                                     const std::vector<std::string>& caption) {
  const int edge = std::clamp(magnified_to / std::max(image.width, image.height), 1, 16);
  const int width = edge * image.width, height = edge * image.height;
  const int columns = std::max(width + scale_width, least_captioned_width);
  std::vector<std::string> lines;
  for (const std::string& words : caption) {
    for (std::string& line : wrapped(words, columns - 2 * gap)) lines.push_back(std::move(line));
  }
  const int top = std::max(height, captioned_height) + gap;
  Canvas canvas(columns, top + line_step * static_cast<int>(lines.size()), paper);
  draw_picture(canvas, image, reference, &map, edge);
  draw_scale(canvas, width);
  canvas.box(width + gap, scale_height + gap, box_width, box_height, left_out);
  canvas.text(width + gap + box_width + 3, scale_height + gap + (box_height - letter_height) / 2,
              "sky", ink);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    canvas.text(gap, top + line_step * static_cast<int>(k), lines[k], ink);
  }
  return taken(canvas);
}

}  // namespace earthshine::studies
