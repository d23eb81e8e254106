// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/occlusion/convex_bodies.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace earthshine::radiosity {
namespace {

struct DirectedEdge {
  std::uint32_t from, to;  // merged corners
  std::uint32_t polygon;
  int k;  // from corner k of the face to the next
};

// Numbers corners by position: corners within margin_m of each other get one number. Sorted by x.
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
  std::size_t first = 0;  // earlier positions are farther back in x than the margin
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

// Directed edges sorted by their ends.
class EdgeTable {
 public:
  EdgeTable(std::span<const ConvexPolygon> polygons, double margin_m) {
    const auto number = number_corners(polygons, margin_m);
    for (std::uint32_t p = 0; p < polygons.size(); ++p) {
      const std::size_t count = number[p].size();
      for (std::size_t k = 0; k < count; ++k) {
        edges_.push_back({number[p][k], number[p][(k + 1) % count], p, static_cast<int>(k)});
      }
    }
    std::sort(edges_.begin(), edges_.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
      return std::tie(a.from, a.to, a.polygon) < std::tie(b.from, b.to, b.polygon);
    });
  }
  [[nodiscard]] const std::vector<DirectedEdge>& all() const { return edges_; }
  // The edge from one corner to another if it is unique.
  [[nodiscard]] const DirectedEdge* only(std::uint32_t from, std::uint32_t to) const {
    const auto range = std::equal_range(edges_.begin(), edges_.end(), DirectedEdge{from, to, 0, 0},
                                        [](const DirectedEdge& a, const DirectedEdge& b) {
                                          return std::tie(a.from, a.to) < std::tie(b.from, b.to);
                                        });
    return range.second - range.first == 1 ? &*range.first : nullptr;
  }

 private:
  std::vector<DirectedEdge> edges_;
};

// Whether every face has the corners of all other faces behind it.
bool is_convex(std::span<const ConvexPolygon> polygons, std::span<const std::uint32_t> faces,
               double margin_m) {
  for (const std::uint32_t f : faces) {
    const Plane plane{polygons[f][0], polygons[f].normal};
    for (const std::uint32_t g : faces) {
      for (int k = 0; k < polygons[g].count; ++k) {
        if (plane.height(polygons[g][k]) > margin_m) return false;
      }
    }
  }
  return true;
}

}  // namespace

bool ConvexBody::is_before(const Plane& plane, double margin_m) const {
  return std::all_of(edges.begin(), edges.end(), [&](const Edge& edge) {
    return plane.height(edge.from) >= -margin_m && plane.height(edge.to) >= -margin_m;
  });
}

ConvexBodies find_convex_bodies(std::span<const ConvexPolygon> polygons, double margin_m) {
  const EdgeTable table(polygons, margin_m);
  std::vector<std::uint32_t> parent(polygons.size());
  std::iota(parent.begin(), parent.end(), 0U);
  std::vector<bool> open(polygons.size(), false);
  for (const DirectedEdge& edge : table.all()) {
    const DirectedEdge* opposite = table.only(edge.to, edge.from);
    if (opposite != nullptr && table.only(edge.from, edge.to) != nullptr) {
      parent[root(parent, edge.polygon)] = root(parent, opposite->polygon);
    } else {
      open[edge.polygon] = true;
    }
  }
  std::vector<std::vector<std::uint32_t>> faces(polygons.size());
  for (std::uint32_t p = 0; p < polygons.size(); ++p) faces[root(parent, p)].push_back(p);

  ConvexBodies found;
  found.of_polygon.assign(polygons.size(), no_body);
  std::vector<std::uint32_t> place(polygons.size(), 0);  // index among its body's faces
  for (const std::vector<std::uint32_t>& group : faces) {
    const bool closed = std::none_of(group.begin(), group.end(), [&](auto f) { return open[f]; });
    if (group.size() < 4 || !closed || !is_convex(polygons, group, margin_m)) continue;
    ConvexBody body;
    for (const std::uint32_t f : group) {
      found.of_polygon[f] = static_cast<std::uint32_t>(found.bodies.size());
      place[f] = static_cast<std::uint32_t>(body.faces.size());
      body.faces.push_back({polygons[f][0], polygons[f].normal});
    }
    found.bodies.push_back(body);
  }
  for (const DirectedEdge& edge : table.all()) {
    const std::uint32_t body = found.of_polygon[edge.polygon];
    if (body == no_body || edge.from > edge.to) continue;
    const ConvexPolygon& face = polygons[edge.polygon];
    found.bodies[body].edges.push_back({face[edge.k], face.next(edge.k), place[edge.polygon],
                                        place[table.only(edge.to, edge.from)->polygon]});
  }
  return found;
}

Shaft::Shaft(const ConvexPolygon& first, const ConvexPolygon& second, double margin_m)
    : low_(first[0]), high_(first[0]), margin_m_(margin_m) {
  for (const ConvexPolygon* polygon : {&first, &second}) {
    for (int k = 0; k < polygon->count; ++k) {
      low_ = glm::min(low_, (*polygon)[k]);
      high_ = glm::max(high_, (*polygon)[k]);
    }
  }
  add_planes(first, second);
  add_planes(second, first);
}

void Shaft::add_planes(const ConvexPolygon& from, const ConvexPolygon& to) {
  for (int k = 0; k < from.count; ++k) {
    const Vec3& start = from[k];
    const Vec3 edge = from.next(k) - start;
    // Rotates a plane about the edge, outward, until all of `to` is behind it.
    Vec3 normal = glm::cross(edge, to[0] - start);
    for (int j = 1; j < to.count; ++j) {
      if (glm::dot(normal, to[j] - start) > 0.0) normal = glm::cross(edge, to[j] - start);
    }
    const double length = glm::length(normal);
    if (length <= margin_m_ * glm::length(edge)) continue;
    const Plane plane{start, normal / length};
    // Touching polygons have corners on the edge's line, which leave the rotation undefined.
    bool bounds = true;
    for (const ConvexPolygon* polygon : {&from, &to}) {
      for (int j = 0; j < polygon->count; ++j) {
        bounds = bounds && plane.height((*polygon)[j]) <= margin_m_;
      }
    }
    if (bounds) outside_[count_++] = plane;
  }
}

bool Shaft::may_hide(const ConvexPolygon& blocker) const {
  Vec3 low = blocker[0], high = blocker[0];
  for (int k = 1; k < blocker.count; ++k) {
    low = glm::min(low, blocker[k]);
    high = glm::max(high, blocker[k]);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (low[axis] > high_[axis] + margin_m_ || high[axis] < low_[axis] - margin_m_) return false;
  }
  for (std::size_t p = 0; p < count_; ++p) {
    bool beyond = true;
    for (int k = 0; k < blocker.count && beyond; ++k) {
      beyond = outside_[p].height(blocker[k]) >= -margin_m_;
    }
    if (beyond) return false;
  }
  return true;
}

}  // namespace earthshine::radiosity
