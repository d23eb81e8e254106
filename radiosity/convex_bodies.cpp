// SPDX-License-Identifier: Apache-2.0
#include "radiosity/convex_bodies.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace earthshine::radiosity {
namespace {

struct DirectedEdge {
  std::uint32_t from, to;  // merged corners
  std::uint32_t polygon;
};

// Numbers corners by place: those within margin_m of each other along the sorted x get one number.
std::vector<std::vector<std::uint32_t>> number_corners(std::span<const ConvexPolygon> polygons,
                                                       double margin_m) {
  struct Corner {
    Vec3 at;
    std::uint32_t polygon, k;
  };
  std::vector<Corner> corners;
  std::vector<std::vector<std::uint32_t>> number(polygons.size());
  for (std::uint32_t p = 0; p < polygons.size(); ++p) {
    number[p].resize(static_cast<std::size_t>(polygons[p].count));
    for (int k = 0; k < polygons[p].count; ++k) {
      corners.push_back({polygons[p][k], p, static_cast<std::uint32_t>(k)});
    }
  }
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return std::tie(a.at.x, a.at.y, a.at.z, a.polygon, a.k) <
           std::tie(b.at.x, b.at.y, b.at.z, b.polygon, b.k);
  });
  std::vector<Vec3> place;
  std::size_t first = 0;  // places before it lie further back in x than the margin
  for (const Corner& corner : corners) {
    while (first < place.size() && place[first].x < corner.at.x - margin_m) ++first;
    std::size_t found = first;
    while (found < place.size() && glm::distance(place[found], corner.at) > margin_m) ++found;
    if (found == place.size()) place.push_back(corner.at);
    number[corner.polygon][corner.k] = static_cast<std::uint32_t>(found);
  }
  return number;
}

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t k) {
  while (parent[k] != k) k = parent[k] = parent[parent[k]];
  return k;
}

}  // namespace

std::vector<std::uint32_t> find_convex_bodies(std::span<const ConvexPolygon> polygons,
                                              double margin_m) {
  const auto number = number_corners(polygons, margin_m);
  std::vector<DirectedEdge> edges;
  for (std::uint32_t p = 0; p < polygons.size(); ++p) {
    const std::size_t count = number[p].size();
    for (std::size_t k = 0; k < count; ++k) {
      edges.push_back({number[p][k], number[p][(k + 1) % count], p});
    }
  }
  const auto by_ends = [](const DirectedEdge& a, const DirectedEdge& b) {
    return std::tie(a.from, a.to, a.polygon) < std::tie(b.from, b.to, b.polygon);
  };
  std::sort(edges.begin(), edges.end(), by_ends);
  const auto range = [&](std::uint32_t from, std::uint32_t to) {
    return std::equal_range(edges.begin(), edges.end(), DirectedEdge{from, to, 0},
                            [](const DirectedEdge& a, const DirectedEdge& b) {
                              return std::tie(a.from, a.to) < std::tie(b.from, b.to);
                            });
  };

  std::vector<std::uint32_t> parent(polygons.size());
  std::iota(parent.begin(), parent.end(), 0U);
  std::vector<bool> open(polygons.size(), false);
  for (const DirectedEdge& edge : edges) {
    const auto own = range(edge.from, edge.to), opposite = range(edge.to, edge.from);
    if (own.second - own.first == 1 && opposite.second - opposite.first == 1) {
      parent[root(parent, edge.polygon)] = root(parent, opposite.first->polygon);
    } else {
      open[edge.polygon] = true;
    }
  }
  std::vector<std::vector<std::uint32_t>> faces(polygons.size());
  for (std::uint32_t p = 0; p < polygons.size(); ++p) faces[root(parent, p)].push_back(p);

  std::vector<std::uint32_t> body(polygons.size(), no_body);
  constexpr std::size_t most_faces = 256;  // beyond it the test of every corner costs too much
  for (std::uint32_t b = 0; b < polygons.size(); ++b) {
    bool closed = faces[b].size() >= 4 && faces[b].size() <= most_faces;
    for (std::size_t f = 0; f < faces[b].size() && closed; ++f) {
      const ConvexPolygon& face = polygons[faces[b][f]];
      closed = !open[faces[b][f]];
      for (std::size_t g = 0; g < faces[b].size() && closed; ++g) {
        const ConvexPolygon& other = polygons[faces[b][g]];
        for (int k = 0; k < other.count; ++k) {
          closed = closed && glm::dot(face.normal, other[k] - face[0]) <= margin_m;
        }
      }
    }
    if (!closed) continue;
    for (const std::uint32_t p : faces[b]) body[p] = b;
  }
  return body;
}

}  // namespace earthshine::radiosity
