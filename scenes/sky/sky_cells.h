// SPDX-License-Identifier: Apache-2.0
// A cap of directions divided into cells that emit separately: light from any distribution of
// radiance over the cap is a weighted sum over its cells (daylight coefficients, Tregenza and
// Waters 1983).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "base/units.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Rings around the axis, each divided into equal sectors. All cells of a ring have equal solid
// angles.
class SkyCells {
 public:
  // bounds_rad: outer angles of the rings from the axis, ascending; the last one is the cap's half
  // angle (up to pi). sectors: number for each ring, at least 1.
  SkyCells(const Vec3& axis, std::vector<double> bounds_rad, std::vector<std::size_t> sectors);

  [[nodiscard]] std::size_t count() const { return first_.back(); }
  [[nodiscard]] const Vec3& axis() const { return axis_; }
  [[nodiscard]] const std::vector<double>& bounds_rad() const { return bounds_rad_; }
  [[nodiscard]] const std::vector<std::size_t>& sectors() const { return sectors_; }

  // Cell of a unit direction; directions outside the cap belong to its last ring.
  [[nodiscard]] std::size_t cell_of(const Vec3& direction) const;

  // Calls visit(direction) for side x side directions, uniform over a cell's solid angle.
  void visit(std::size_t cell, int side, const std::function<void(const Vec3&)>& visit) const;
  // Calls visit for (side + 1)^2 directions from edge to edge, the outermost slightly inside.
  void visit_lattice(std::size_t cell, int side,
                     const std::function<void(const Vec3&)>& visit) const;

 private:
  // Calls visit for all pairs of these shares of the cell's height, in 1 - cos, and of its width.
  void visit_grid(std::size_t cell, const std::vector<double>& shares,
                  const std::function<void(const Vec3&)>& visit) const;

  Vec3 axis_;
  base::Frame3 frame_;
  std::vector<double> bounds_rad_, least_cosine_;  // of each ring
  std::vector<std::size_t> sectors_, first_;       // first cell of each ring, and the end
};

// About `wanted` cells (2 or more) of the Earth's disc of half angle half_angle_rad around
// `direction`. Rings become narrower toward the limb, where one degree covers most of the ground.
[[nodiscard]] SkyCells cells_of_disc(const Vec3& direction, double half_angle_rad,
                                     std::size_t wanted);

// About `wanted` cells of nearly equal size over the whole sphere, for an Earth that moves through
// the sky.
[[nodiscard]] SkyCells cells_of_sphere(std::size_t wanted);

// A sky in parts, each a separate light group: any sky made of the parts, such as the sky at
// another orbit position, is a weighted sum of their pictures. Scene files cannot define one;
// studies use it instead of the Sun and the Earth.

struct SkyParts {
  std::vector<Sun> suns;          // not hidden by the Earth; groups "sun-0", "sun-1", ...
  std::optional<SkyCells> cells;  // of Scene::earth, uniform; groups "earth-0", ...
};

// Number of light groups of the Earth: one per cell, else one.
[[nodiscard]] std::size_t earth_parts(const Scene& scene);
// Index of the Earth's group for a direction.
[[nodiscard]] std::size_t earth_part(const Scene& scene, const Vec3& direction);

// Index in SkyParts::suns of the Sun whose disc contains a direction; if none, their number.
[[nodiscard]] std::size_t sun_part(const Scene& scene, const Vec3& direction);

}  // namespace earthshine::scenes
