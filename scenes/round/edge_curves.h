// SPDX-License-Identifier: Apache-2.0
// Curves for the edges of a mesh that represents a curved surface: one cubic from corner to corner
// for all faces of an edge, so that no gap opens between a side and a cap at a crease.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/units.h"
#include "scenes/mesh.h"

namespace earthshine::scenes {

// Bezier points from the end with the lower id to the other end, and the number of segments.
struct EdgeCurve {
  std::array<Vec3, 4> points;
  std::uint32_t pieces = 1;
  std::vector<std::uint32_t> vertices;  // vertices of the new mesh between the ends, once created
};

// The point at t in [0, 1] (de Casteljau).
[[nodiscard]] Vec3 point_on(const EdgeCurve& curve, double t);

class EdgeCurves {
 public:
  // Reserves memory for this number of uses.
  void reserve(std::size_t uses) { uses_.reserve(uses); }
  // Adds a face's edge from a to b with its normals there; a and b are ids of places. Returns the
  // index of this use of the edge: 0, 1, 2 ...
  std::uint32_t add(std::uint32_t a, std::uint32_t b, const Vec3& normal_a, const Vec3& normal_b);
  // Computes curves for all edges, after the last add(). At each end the curve starts in the
  // tangent plane of the faces' common normal (Vlachos, Peters, Boyd and Mitchell, "Curved PN
  // triangles", 2001), or along the crease of two normals, with the length for an arc (Goldapp,
  // "Approximation of circular arcs by cubic polynomials", 1991). It is divided so that no segment
  // turns by more than step_deg. place: position for each id.
  void find(const std::vector<Vec3>& place, double step_deg);

  [[nodiscard]] EdgeCurve& of_use(std::uint32_t use) { return curves_[of_use_[use]]; }

 private:
  struct Use {
    std::uint32_t low, high, number;
    Vec3 at_low, at_high;  // normals
  };
  [[nodiscard]] static EdgeCurve curve_of(std::span<const Use> uses, const std::vector<Vec3>& place,
                                          double step_deg);

  std::vector<Use> uses_;
  std::vector<std::uint32_t> of_use_;  // into curves_
  std::vector<EdgeCurve> curves_;
};

// Normals, at the corners of the polygons, of the surface that a mesh represents.

// One unit normal for each of mesh.indices, on its polygon's side. The file's normal has priority;
// otherwise, with crease_deg, the area-weighted mean of the normals around the corner that differ
// by less than crease_deg from the polygon's; else the polygon's normal. ids: of the vertices,
// equal at equal positions (health/topology.h).
[[nodiscard]] std::vector<Vec3> corner_normals(const Mesh& mesh,
                                               const std::vector<std::uint32_t>& ids,
                                               std::optional<double> crease_deg);

}  // namespace earthshine::scenes
