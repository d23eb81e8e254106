// SPDX-License-Identifier: Apache-2.0
// The curves that the edges of a mesh stand for: cubics from corner to corner, one for all the
// faces of an edge, so that no gap opens between a side and the cap it meets at a crease.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/units.h"
#include "scenes/mesh.h"

namespace earthshine::scenes {

// Bezier points from the end with the lower id to the other, and the pieces that it is cut into.
struct EdgeCurve {
  std::array<Vec3, 4> points;
  std::uint32_t pieces = 1;
  std::vector<std::uint32_t> vertices;  // of the new mesh, between the ends, once they are made
};

// The point at t in [0, 1] (de Casteljau).
[[nodiscard]] Vec3 point_on(const EdgeCurve& curve, double t);

class EdgeCurves {
 public:
  // So many uses will be added.
  void reserve(std::size_t uses) { uses_.reserve(uses); }
  // A face has the edge from a to b, and these normals there; a and b are ids of places. Returns
  // the number of this use of the edge: 0, 1, 2 ...
  std::uint32_t add(std::uint32_t a, std::uint32_t b, const Vec3& normal_a, const Vec3& normal_b);
  // Curves for all edges, after the last add(). At each end the curve leaves in the tangent plane
  // of the faces' common normal (Vlachos, Peters, Boyd and Mitchell, "Curved PN triangles", 2001),
  // or along the crease of two, as far as an arc does (Goldapp, "Approximation of circular arcs by
  // cubic polynomials", 1991); it is cut so that no piece turns by more than turn_deg. place: of an
  // id.
  void find(const std::vector<Vec3>& place, double turn_deg);

  [[nodiscard]] EdgeCurve& of_use(std::uint32_t use) { return curves_[of_use_[use]]; }

 private:
  struct Use {
    std::uint32_t low, high, number;
    Vec3 at_low, at_high;  // normals
  };
  [[nodiscard]] static EdgeCurve curve_of(std::span<const Use> uses, const std::vector<Vec3>& place,
                                          double turn_deg);

  std::vector<Use> uses_;
  std::vector<std::uint32_t> of_use_;  // into curves_
  std::vector<EdgeCurve> curves_;
};

// Normals of the surface that a mesh stands for, at the corners of its polygons.

// One for each of mesh.indices, of unit length, on its polygon's side: the file's own where it has
// one; else, with crease_deg, the mean of the normals of the polygons around the corner's place
// that are turned less than that against its own, by area; else its polygon's. ids: of the
// vertices, equal at one place (health/topology.h).
[[nodiscard]] std::vector<Vec3> corner_normals(const Mesh& mesh,
                                               const std::vector<std::uint32_t>& ids,
                                               std::optional<double> crease_deg);

}  // namespace earthshine::scenes
