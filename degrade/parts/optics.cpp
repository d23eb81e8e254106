// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/optics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/units.h"

namespace earthshine::degrade {
namespace {

// Multiplies every value by factor(u^2 + v^2), (u, v) the position relative to the centre in half
// heights. Quadrants and planes are equal, so that factor() is called once for all of them.
template <class F>
Picture times_radial(Picture picture, F factor) {
  const double half = picture.rows / 2.0;
  const std::size_t width = static_cast<std::size_t>(picture.columns);
  const std::size_t height = static_cast<std::size_t>(picture.rows);
  base::parallel_chunks((height + 1) / 2, 8, [&](std::size_t begin, std::size_t end) {
    std::vector<double> line((width + 1) / 2);
    for (std::size_t y = begin; y < end; ++y) {
      const double v = (static_cast<double>(y) + 0.5 - half) / half;
      for (std::size_t x = 0; x < line.size(); ++x) {
        const double u = (static_cast<double>(x) + 0.5 - picture.columns / 2.0) / half;
        line[x] = factor(u * u + v * v);
      }
      for (Plane& plane : picture.planes) {
        for (const std::size_t row : {y, height - 1 - y}) {
          float* const values = plane.data() + row * width;
          for (std::size_t x = 0; x < width; ++x) {
            const double share = line[std::min(x, width - 1 - x)];
            values[x] = static_cast<float>(static_cast<double>(values[x]) * share);
          }
          if (height - 1 - y == y) break;  // the middle row is its own mirror image
        }
      }
    }
  });
  return picture;
}

}  // namespace

Picture through_lens(Picture radiance, const CctvCamera& camera, double f_number) {
  const double factor = lens_transfer(camera, f_number);
  return transform(std::move(radiance), [&](double l) { return std::min(l, 1e30) * factor; });
}

Picture fall_off_from_axis(Picture illuminance, double power, double fov_deg) {
  const double tan_half = std::tan(base::radians(fov_deg) / 2.0);
  return times_radial(std::move(illuminance), [&](double r2) {
    return std::pow(1.0 + r2 * tan_half * tan_half, -power / 2.0);
  });
}

Picture add_glare(Picture illuminance, double share) {
  for (Plane& plane : illuminance.planes) {
    double sum = 0.0;
    for (float value : plane) sum += static_cast<double>(value);
    const double veil = share * sum / static_cast<double>(plane.size());
    for (float& value : plane)
      value = static_cast<float>((1.0 - share) * static_cast<double>(value) + veil);
  }
  return illuminance;
}

Picture shade(Picture signal, double droop) {
  const double aspect = static_cast<double>(signal.columns) / signal.rows;
  const double corner2 = 1.0 + aspect * aspect;
  return times_radial(std::move(signal), [&](double r2) { return 1.0 - droop * r2 / corner2; });
}

}  // namespace earthshine::degrade
