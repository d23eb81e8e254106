// SPDX-License-Identifier: Apache-2.0
// Test pictures and their moments.
#pragma once

#include <cmath>
#include <cstddef>

#include "base/image.h"
#include "degrade/stage/camera.h"
#include "degrade/stage/picture.h"

namespace earthshine::test {

inline degrade::Picture flat(int columns, int rows, float value, std::size_t planes = 1) {
  degrade::Picture picture{columns, rows, {}};
  picture.planes.assign(planes, degrade::Plane(picture.pixel_count(), value));
  return picture;
}

inline base::Image grey(int width, int height, float value) {
  base::Image image{width, height, {}};
  image.add("Y").assign(image.pixel_count(), value);
  return image;
}

// Linear with fixed exposure: the signal is the radiance (pi tau / (4 N^2 E_white) = 1).
inline degrade::CctvCamera linear_camera() {
  degrade::CctvCamera camera;
  camera.iris = degrade::IrisMode::Fixed;
  camera.f_number = 1.0;
  camera.transmittance = 1.0;
  camera.white_lux = 3.14159265358979323846 / 4.0;
  camera.gamma = 1.0;
  camera.white_clip = 0.0;
  return camera;
}

inline double slope(double x, double y) { return 0.3 + 0.5 * x + 0.2 * y; }

// A picture of f(x, y), with x and y from 0 to 1.
template <class F>
base::Image painted(int width, int height, F f) {
  base::Image image = grey(width, height, 0.0F);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(x);
      image.channels[0].values[i] = static_cast<float>(f((x + 0.5) / width, (y + 0.5) / height));
    }
  }
  return image;
}

struct Moments {
  double mean = 0.0, variance = 0.0, third = 0.0, fourth = 0.0;  // second to fourth central
};
inline Moments moments(const degrade::Plane& values) {
  Moments m;
  const double count = static_cast<double>(values.size());
  for (float v : values) m.mean += static_cast<double>(v) / count;
  for (float v : values) {
    const double d = static_cast<double>(v) - m.mean;
    m.variance += d * d / count;
    m.third += d * d * d / count;
    m.fourth += d * d * d * d / count;
  }
  return m;
}

// Correlation coefficient of two planes; b is shifted by (dx, dy).
inline double correlation(const degrade::Plane& a, const degrade::Plane& b, int columns, int rows,
                          int dx, int dy) {
  const Moments ma = moments(a), mb = moments(b);
  double sum = 0.0;
  std::size_t count = 0;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const int u = x + dx, v = y + dy;
      if (u < 0 || u >= columns || v < 0 || v >= rows) continue;
      const auto index = [&](int i, int j) {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(i);
      };
      sum += (static_cast<double>(a[index(x, y)]) - ma.mean) *
             (static_cast<double>(b[index(u, v)]) - mb.mean);
      ++count;
    }
  }
  return sum / static_cast<double>(count) / std::sqrt(ma.variance * mb.variance);
}

}  // namespace earthshine::test
