// SPDX-License-Identifier: Apache-2.0
#include "degrade/stage/picture.h"

#include <utility>

#include "base/parallel.h"
#include "base/units.h"

namespace earthshine::degrade {

Plane luminance_plane(const Picture& picture) {
  if (picture.planes.size() == 1) return picture.planes.front();
  Plane y(picture.pixel_count());
  for (std::size_t i = 0; i < y.size(); ++i) {
    y[i] = static_cast<float>(
        base::luminance({picture.planes[0][i], picture.planes[1][i], picture.planes[2][i]}));
  }
  return y;
}

base::Image to_image(Picture picture) {
  base::Image image{picture.columns, picture.rows, {}};
  const char* const colour[] = {"R", "G", "B"};
  const bool grey = picture.planes.size() == 1;
  for (std::size_t p = 0; p < picture.planes.size(); ++p) {
    image.channels.push_back({grey ? "Y" : colour[p], std::move(picture.planes[p])});
  }
  return image;
}

void for_each_run(const Picture& picture,
                  const std::function<void(std::size_t, std::size_t, std::size_t)>& body) {
  constexpr std::size_t run_px = 8192;
  for (std::size_t plane = 0; plane < picture.planes.size(); ++plane) {
    base::parallel_chunks(picture.pixel_count(), run_px,
                          [&](std::size_t first, std::size_t last) { body(plane, first, last); });
  }
}

}  // namespace earthshine::degrade
