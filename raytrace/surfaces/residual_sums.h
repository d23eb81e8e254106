// SPDX-License-Identifier: Apache-2.0
// Of one patch, what the points that are sampled say of the residual (surface_samples.h).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "raytrace/surfaces/surface_samples.h"

namespace earthshine::raytrace {

// The sums over one patch's points that PatchResidual is made of.
class ResidualSums {
 public:
  void start(std::size_t points) { points_.assign(points, {}); }
  // The point (x, y) of the patch, from 0 to 1, the material's reflectance, the radiosity that the
  // solution has there, and the two parts of the illuminance.
  void place(std::size_t point, double x, double y, const Rgb& rho, const Rgb& radiosity,
             const Rgb& lamps, const Rgb& gathered) {
    points_[point] = {true, x,  y, base::luminance(radiosity), rho, lamps, gathered, {}, {},
                      {},   {}, {}};
  }
  // What one half of the rays found.
  void set(std::size_t point, std::size_t half, const Rgb& lamps, const Rgb& gathered);
  // Whether the point's weight is another by either half, or by the solution.
  [[nodiscard]] bool is_unsure(std::size_t point, double mean) const;
  // Weighs the point by what further rays find there, in place of the halves: weights that follow
  // their chance would count what both have missed as dark, what both have met as bright.
  void weigh_by(std::size_t point, const Rgb& lamps, const Rgb& gathered);
  // Weighs each point by the larger of the radiosity that the solution has and that it should have,
  // over `mean`.
  void finish(double mean, PatchResidual& residual);

 private:
  struct Point {
    bool placed = false;
    double x = 0.0, y = 0.0, radiosity = 0.0;
    Rgb rho{0.0}, lamps{0.0}, gathered{0.0};
    std::array<double, 2> all{}, by_lamps{};  // luminance of r, by half; weighted by finish()
    std::array<double, 2> gathered_lx{};      // luminance
    std::array<Rgb, 2> rgb{};                 // r
    std::optional<double> weighed_by;         // luminance of r
  };
  std::vector<Point> points_;
};

}  // namespace earthshine::raytrace
