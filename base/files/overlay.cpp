// SPDX-License-Identifier: Apache-2.0
#include "base/files/overlay.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace earthshine::base {
namespace {

std::uint8_t mix(std::uint8_t under, std::uint8_t over, double share) {
  return static_cast<std::uint8_t>(std::lround((1.0 - share) * under + share * over));
}

double distance(const Line& line, double x, double y) {
  const double dx = line.x1 - line.x0, dy = line.y1 - line.y0;
  const double squared = dx * dx + dy * dy;
  const double along =
      squared > 0.0 ? std::clamp(((x - line.x0) * dx + (y - line.y0) * dy) / squared, 0.0, 1.0)
                    : 0.0;
  return std::hypot(x - line.x0 - along * dx, y - line.y0 - along * dy);
}

}  // namespace

std::vector<float> line_coverage(int width, int height, std::span<const Line> lines,
                                 double line_width_px) {
  std::vector<float> coverage(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const double reach = line_width_px / 2 + 0.5, most = std::min(1.0, line_width_px);
  const auto first = [&](double low, int end) {
    return static_cast<int>(std::clamp(std::floor(low - reach - 0.5), 0.0, double(end)));
  };
  const auto last = [&](double high, int end) {
    return static_cast<int>(std::clamp(std::ceil(high + reach + 0.5), 0.0, double(end)));
  };
  for (const Line& line : lines) {
    // Visits only pixels near the line in each row, because the bounding box of a long diagonal is
    // large.
    const int y_end = last(std::max(line.y0, line.y1), height);
    for (int y = first(std::min(line.y0, line.y1), height); y < y_end; ++y) {
      double low = std::min(line.x0, line.x1), high = std::max(line.x0, line.x1);
      if (const double dy = line.y1 - line.y0; std::fabs(dy) > 1e-9) {
        const double slope = (line.x1 - line.x0) / dy;
        const double a = line.x0 + (y + 0.5 - reach - line.y0) * slope;
        const double b = line.x0 + (y + 0.5 + reach - line.y0) * slope;
        low = std::max(low, std::min(a, b));
        high = std::min(high, std::max(a, b));
      }
      const int x_end = last(high, width);
      for (int x = first(low, width); x < x_end; ++x) {
        const double covered = std::min(most, reach - distance(line, x + 0.5, y + 0.5));
        float& pixel = coverage[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                static_cast<std::size_t>(x)];
        pixel = std::max(pixel, static_cast<float>(covered));
      }
    }
  }
  return coverage;
}

void paint(Picture8& picture, std::span<const float> coverage, const Colour8& colour,
           double alpha) {
  if (3 * coverage.size() != picture.rgb.size()) {
    throw Error(Blame::Work, "overlay", "the lines and the picture have different sizes");
  }
  for (std::size_t p = 0; p < coverage.size(); ++p) {
    if (coverage[p] <= 0.0F) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint8_t& value = picture.rgb[3 * p + c];
      value = mix(value, colour[c], alpha * double(coverage[p]));
    }
  }
}

void blend(Picture8& picture, std::span<const std::uint8_t> over_rgb, double alpha) {
  if (over_rgb.size() != picture.rgb.size()) {
    throw Error(Blame::Work, "overlay", "the two pictures have different sizes");
  }
  for (std::size_t k = 0; k < over_rgb.size(); ++k) {
    picture.rgb[k] = mix(picture.rgb[k], over_rgb[k], alpha);
  }
}

}  // namespace earthshine::base
