// SPDX-License-Identifier: Apache-2.0
#include "raytrace/frame/join.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace earthshine::raytrace {
namespace {

bool lies_in(const Window& part, const Window& whole) {
  return part.x >= whole.x && part.y >= whole.y &&
         part.x + part.columns <= whole.x + whole.columns &&
         part.y + part.rows <= whole.y + whole.rows;
}

// values: of a part, row by row.
template <class Value>
void place(const std::vector<Value>& values, const Window& part, const Window& whole,
           std::vector<Value>& all) {
  for (int row = 0; row < part.rows; ++row) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(row) * part.columns;
    std::copy(from, from + part.columns,
              all.begin() + static_cast<std::ptrdiff_t>(whole.index(part.x, part.y + row)));
  }
}

}  // namespace

Frame join(const std::vector<Frame>& parts, const Window& window) {
  std::size_t pixels = 0;
  for (const Frame& part : parts) {
    pixels += part.window.pixel_count();
    if (!lies_in(part.window, window)) throw std::invalid_argument("a part leaves the picture");
  }
  if (pixels != window.pixel_count()) throw std::invalid_argument("the parts do not fill it");
  Frame whole;
  whole.window = window;
  whole.report = parts.front().report;
  whole.report.rays = {};
  whole.report.seconds = whole.report.gather_seconds = 0.0;
  whole.image = {window.columns, window.rows, {}};
  for (const base::Channel& channel : parts.front().image.channels) whole.image.add(channel.name);
  whole.error = StatedError(pixels);
  // Recovers integer sums exactly from the parts' means.
  double samples = 0.0, finished = 0.0;
  for (const Frame& part : parts) {
    const auto count = static_cast<double>(part.window.pixel_count());
    samples += std::round(part.report.camera_samples * count);
    finished += std::round(part.report.finished_share * count);
    whole.report.most_camera_samples =
        std::max(whole.report.most_camera_samples, part.report.most_camera_samples);
    whole.report.rays += part.report.rays;
    whole.report.seconds += part.report.seconds;
    whole.report.unexplained_pixels += part.report.unexplained_pixels;
    whole.report.gather_seconds += part.report.gather_seconds;
    for (base::Channel& channel : whole.image.channels) {
      const base::Channel* const own = part.image.find(channel.name);
      if (own == nullptr) throw std::invalid_argument("a part lacks a layer");
      place(own->values, part.window, window, channel.values);
    }
    place(part.error.luminance, part.window, window, whole.error.luminance);
    place(part.error.squared, part.window, window, whole.error.squared);
    place(part.error.source, part.window, window, whole.error.source);
    place(part.error.shows, part.window, window, whole.error.shows);
  }
  whole.report.camera_samples = samples / static_cast<double>(pixels);
  whole.report.finished_share = finished / static_cast<double>(pixels);
  whole.report.relative_noise = std::sqrt(add_up(whole.error).squared_error());
  return whole;
}

}  // namespace earthshine::raytrace
