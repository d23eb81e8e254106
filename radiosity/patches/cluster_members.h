// SPDX-License-Identifier: Apache-2.0
// The triangles of face clusters (patches.h), in an order in which whatever a cluster is halved
// into stands together: n triangles are the first n / 2 and the rest, down to one.
//
// The parameter s of a cluster says which triangle, t nothing more: its binary digits, one for each
// time that the range is halved, lead to the triangle, and what follows is the triangle's own s.
// So the cells of a cluster are halved, numbered and found as those of any facet; one that holds
// several triangles is halved along s only, one that holds a lone triangle as that triangle is.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

inline constexpr std::uint32_t no_member = 0xFFFFFFFFU;

// What a cell of a cluster holds: triangles, or of a lone one the part in its own parameters.
struct ClusterSpan {
  std::uint32_t first = 0, count = 0;  // members
  Rectangle part{0.0, 1.0, 0.0, 1.0};
};
[[nodiscard]] ClusterSpan span_of(const Facet& cluster, const Cell& cell);

struct ClusterMembers {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> corner;  // per member
  std::vector<std::uint8_t> apex;                    // per member: as of facet()
  std::vector<std::uint32_t> triangle;               // per member: of the scene
  std::vector<std::uint32_t> of_triangle;            // per triangle of the scene; no_member: none
  std::vector<double> area_to;                       // of the members before; one entry more

  // The triangle as a facet of one cell.
  [[nodiscard]] Facet facet(std::uint32_t member) const;
  [[nodiscard]] double area(const ClusterSpan& span) const;
  // The unit normal of the mean of the triangles, by area.
  [[nodiscard]] Vec3 normal(const ClusterSpan& span) const;

  // The triangle that x in [0, 1] falls on, each as wide as its area; x becomes the place in it.
  [[nodiscard]] std::uint32_t pick(const ClusterSpan& span, double& x) const;

  // Parameters in the cluster of a place in the triangle's own.
  [[nodiscard]] Parameters parameters(const Facet& cluster, std::uint32_t member,
                                      Parameters own) const;

  // Of a rectangle about the mean normal that has all triangles over it; counter-clockwise.
  [[nodiscard]] std::array<Vec3, 4> corners(const ClusterSpan& span) const;
  [[nodiscard]] std::pair<Vec3, Vec3> box(const ClusterSpan& span) const;
};

// The corner opposite the shortest edge, the first of those.
[[nodiscard]] std::uint8_t apex_of(const std::array<Vec3, 3>& corners);
// The triangle as a facet, uncut.
[[nodiscard]] Facet facet_of_triangle(const Vec3& p0, const Vec3& p1, const Vec3& p2);

// Lengths of the edges along a and along t, by which facets of triangles are cut.
struct TriangleLengths {
  double s_m, t_m;
};
[[nodiscard]] TriangleLengths lengths_of(const Facet& triangle);

}  // namespace earthshine::radiosity
