// SPDX-License-Identifier: Apache-2.0
// The triangles of face clusters (patches.h), ordered so that the halves of a cluster are
// contiguous: n triangles are the first n / 2 and the rest, down to one.
//
// The parameter s of a cluster selects the triangle; t has no influence on it. Its leading binary
// digits, one per bisection of the range, lead to the triangle; the rest is the triangle's own s.
// Thus the cells of a cluster are halved, numbered and found like cells of any facet. A cell with
// several triangles is halved along s only, a cell with a single triangle like a triangle.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

inline constexpr std::uint32_t no_member = 0xFFFFFFFFU;

// Contents of a cluster's cell: several triangles, or part of a single triangle in its own
// parameters.
struct ClusterSpan {
  std::uint32_t first = 0, count = 0;  // members
  Rectangle part{0.0, 1.0, 0.0, 1.0};
};
[[nodiscard]] ClusterSpan span_of(const Facet& cluster, const Cell& cell);

struct ClusterMembers {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> corner;  // per member
  std::vector<std::uint8_t> apex;                    // per member, as used by facet()
  std::vector<std::uint32_t> triangle;               // index in the scene, per member
  std::vector<std::uint32_t> of_triangle;            // per triangle of the scene; no_member: none
  std::vector<double> area_to;                       // area before each member, and in total

  // The triangle as a facet with one cell.
  [[nodiscard]] Facet facet(std::uint32_t member) const;
  [[nodiscard]] double area(const ClusterSpan& span) const;
  // Unit vector of the area-weighted mean normal.
  [[nodiscard]] Vec3 normal(const ClusterSpan& span) const;

  // Selects a triangle by x in [0, 1], in proportion to area; x becomes the position in it.
  [[nodiscard]] std::uint32_t pick(const ClusterSpan& span, double& x) const;

  // Converts a triangle's own parameters to the cluster's.
  [[nodiscard]] Parameters parameters(const Facet& cluster, std::uint32_t member,
                                      Parameters own) const;

  // A rectangle normal to the mean normal below all triangles; counter-clockwise.
  [[nodiscard]] std::array<Vec3, 4> corners(const ClusterSpan& span) const;
  [[nodiscard]] scenes::Box box(const ClusterSpan& span) const;
};

// The corner opposite the shortest edge; if several, the first one.
[[nodiscard]] std::uint8_t apex_of(const std::array<Vec3, 3>& corners);
// The triangle as an undivided facet.
[[nodiscard]] Facet facet_about(const std::array<Vec3, 3>& corners, std::uint8_t apex);
[[nodiscard]] Facet facet_of_triangle(const Vec3& p0, const Vec3& p1, const Vec3& p2);

// Lengths of the edges along a and along t, which determine the division of triangular facets.
struct TriangleLengths {
  double s_m, t_m;
};
[[nodiscard]] TriangleLengths lengths_of(const Facet& triangle);

}  // namespace earthshine::radiosity
