// SPDX-License-Identifier: Apache-2.0
// A cap of directions cut into cells, each of which shines on its own: light from any distribution
// of radiance over the cap is then a weighted sum over its cells (the idea of daylight
// coefficients, Tregenza and Waters 1983).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "base/units.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Rings around the axis, each cut into equal sectors. All cells of a ring have equal solid angles.
class SkyCells {
 public:
  // bounds_rad: where the rings end, from the axis, ascending, the last one the cap's half angle
  // (up to pi); sectors: of each ring, from 1.
  SkyCells(const Vec3& axis, std::vector<double> bounds_rad, std::vector<std::size_t> sectors);

  [[nodiscard]] std::size_t count() const { return first_.back(); }
  [[nodiscard]] const Vec3& axis() const { return axis_; }
  [[nodiscard]] const std::vector<double>& bounds_rad() const { return bounds_rad_; }
  [[nodiscard]] const std::vector<std::size_t>& sectors() const { return sectors_; }

  // Cell of a unit direction; what lies outside the cap counts to its last ring.
  [[nodiscard]] std::size_t cell_of(const Vec3& direction) const;

  // Calls visit(direction) for side x side directions spread evenly over a cell's solid angle.
  void visit(std::size_t cell, int side, const std::function<void(const Vec3&)>& visit) const;
  // The same for (side + 1)^2 directions from edge to edge, the outermost a hair inside.
  void visit_lattice(std::size_t cell, int side,
                     const std::function<void(const Vec3&)>& visit) const;

 private:
  // Directions at all pairs of these shares of the cell's height, by 1 - cos, and of its width.
  void visit_grid(std::size_t cell, const std::vector<double>& shares,
                  const std::function<void(const Vec3&)>& visit) const;

  Vec3 axis_;
  base::Frame3 frame_;
  std::vector<double> bounds_rad_, least_cosine_;  // of each ring
  std::vector<std::size_t> sectors_, first_;       // first cell of each ring, and their number
};

// About `wanted` cells (2 or more) of the Earth's disc seen at half_angle_rad around `direction`:
// rings narrow toward the limb, where the ground is seen at a slant and a degree spans most of it.
[[nodiscard]] SkyCells cells_of_disc(const Vec3& direction, double half_angle_rad,
                                     std::size_t wanted);

// About `wanted` cells of the whole sphere, all of nearly the same size: for an Earth that moves
// through the sky.
[[nodiscard]] SkyCells cells_of_sphere(std::size_t wanted);

// A sky in parts, each a light group of its own: any sky made of them, such as that of another
// place in the orbit, is then a weighted sum of what the parts give. No scene file has one; studies
// put it in the place of the Sun and the Earth.

struct SkyParts {
  std::vector<Sun> suns;          // whole discs that no Earth hides; groups "sun-0", "sun-1", ...
  std::optional<SkyCells> cells;  // of Scene::earth, uniform; groups "earth-0", ...
};

// How many light groups stand for the Earth: one for each cell, else one.
[[nodiscard]] std::size_t earth_parts(const Scene& scene);
// Which of them a direction toward the Earth belongs to.
[[nodiscard]] std::size_t earth_part(const Scene& scene, const Vec3& direction);

// The number of the Sun whose disc a direction meets, among SkyParts::suns; none: their count.
[[nodiscard]] std::size_t sun_part(const Scene& scene, const Vec3& direction);

}  // namespace earthshine::scenes
