// SPDX-License-Identifier: Apache-2.0
// The picture between stages: one plane (luminance) or three (red, green, blue), rows from the top.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/image.h"

namespace earthshine::degrade {

using Plane = std::vector<float>;

struct Picture {
  int columns = 0;
  int rows = 0;
  std::vector<Plane> planes;

  [[nodiscard]] std::size_t pixel_count() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
};

// Replaces every value by f(value); f must be a pure function.
template <class F>
[[nodiscard]] Picture transform(Picture picture, F f);

// Luminance of each pixel: the plane itself, or Rec. 709 weights.
[[nodiscard]] Plane luminance_plane(const Picture& picture);

// Channel Y, or R, G and B.
[[nodiscard]] base::Image to_image(Picture picture);

// Calls body(plane, first, last) for runs of pixels in parallel; body may write only pixels of its
// run.
void for_each_run(
    const Picture& picture,
    const std::function<void(std::size_t plane, std::size_t first, std::size_t last)>& body);

template <class F>
Picture transform(Picture picture, F f) {
  for_each_run(picture, [&](std::size_t plane, std::size_t first, std::size_t last) {
    Plane& values = picture.planes[plane];
    for (std::size_t i = first; i < last; ++i) {
      values[i] = static_cast<float>(f(static_cast<double>(values[i])));
    }
  });
  return picture;
}

}  // namespace earthshine::degrade
