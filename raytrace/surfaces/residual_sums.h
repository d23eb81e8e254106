// SPDX-License-Identifier: Apache-2.0
// Statistics of the residual at the sampled points of one patch (surface_samples.h).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "raytrace/surfaces/surface_samples.h"

namespace earthshine::raytrace {

// Sums over one patch's points, from which finish() fills a PatchResidual.
class ResidualSums {
 public:
  void start(std::size_t points) { points_.assign(points, {}); }
  // The point (x, y) of the patch, from 0 to 1, with the material's reflectance and the solution's
  // radiosity and both parts of its illuminance there.
  void place(std::size_t point, double x, double y, const Rgb& rho, const Rgb& radiosity,
             const Rgb& lamps, const Rgb& gathered) {
    points_[point] = {true, x,  y, base::luminance(radiosity), rho, lamps, gathered, {}, {},
                      {},   {}, {}};
  }
  // The illuminances from one half of the rays.
  void set(std::size_t point, std::size_t half, const Rgb& lamps, const Rgb& gathered);
  // Whether the point's weight differs strongly between the halves and the solution.
  [[nodiscard]] bool is_unsure(std::size_t point, double mean) const;
  // Weights the point by the illuminance from independent rays. The weight would otherwise depend
  // on the chance of the halves: light that both miss would count as dark, light that both hit as
  // bright.
  void weigh_by(std::size_t point, const Rgb& lamps, const Rgb& gathered);
  // Weights each point by error_weight() of the larger of the solution's and the true radiosity,
  // with respect to `mean`.
  void finish(double mean, PatchResidual& residual);

 private:
  // From alternate open points.
  void finish_halves(PatchResidual& residual) const;
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
