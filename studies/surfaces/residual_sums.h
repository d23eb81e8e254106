// SPDX-License-Identifier: Apache-2.0
// The sums over one patch's points that PatchResidual (surface_samples.h) is made of.
#pragma once

#include "studies/surfaces/surface_samples.h"

namespace earthshine::studies {

class ResidualSums {
 public:
  void start(std::size_t points) { points_.assign(points, {}); }
  // The point (x, y) of the patch, from 0 to 1, the material's reflectance, the radiosity that the
  // solution has there, and the two parts of the illuminance.
  void place(std::size_t point, double x, double y, const Rgb& rho, const Rgb& radiosity,
             const Rgb& lamps, const Rgb& gathered) {
    points_[point] = {true, x, y, base::luminance(radiosity), rho, lamps, gathered, {}, {}, {}};
  }
  [[nodiscard]] bool is_placed(std::size_t point) const { return points_[point].placed; }
  // What one half of the rays found.
  void set(std::size_t point, std::size_t half, const Rgb& lamps, const Rgb& gathered);
  // Weighs each point by the radiosity that it should have over `mean`.
  void finish(double mean, PatchResidual& residual);

 private:
  struct Point {
    bool placed = false;
    double x = 0.0, y = 0.0, radiosity = 0.0;
    Rgb rho{0.0}, lamps{0.0}, gathered{0.0};
    std::array<double, 2> all{}, by_lamps{};  // weighted luminance of r, by half
    std::array<Rgb, 2> rgb{};                 // r
  };
  std::vector<Point> points_;
};

}  // namespace earthshine::studies
