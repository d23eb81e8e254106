// SPDX-License-Identifier: Apache-2.0
#include "scenes/round/round.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/health/topology.h"
#include "scenes/mesh/triangulate.h"
#include "scenes/round/edge_curves.h"

namespace earthshine::scenes {
namespace {

constexpr std::size_t most_round_triangles = std::size_t{1} << 24;

// A triangle of a polygon: its corners, as indices into Mesh::indices, and the first of its edge
// uses (edge_curves.h). The use from corner k to the next is the k-th after it.
struct Piece {
  std::array<std::uint32_t, 3> corner;
  std::uint32_t first_use = 0;
};

class Rounder {
 public:
  Rounder(const Mesh& mesh, const Rounding& rounding, const base::Location& where)
      : mesh_(mesh),
        where_(where),
        ids_(welded(mesh.vertices)),
        normals_(corner_normals(mesh, ids_, rounding.crease_deg)),
        pieces_(mesh.polygons.size()) {
    made_ = mesh;
    made_.indices.clear();
    made_.polygons.clear();
    made_.uv_indices.clear();
    made_.normal_indices.clear();
    std::size_t triangles = 0;
    for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
      cut(p);
      triangles += pieces_[p].size();
    }
    curves_.reserve(3 * triangles);
    for (std::vector<Piece>& of_polygon : pieces_) {
      for (Piece& piece : of_polygon) add_edges(piece);
    }
    std::vector<Vec3> place(mesh.vertices.size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) place[ids_[v]] = mesh.vertices[v];
    curves_.find(place, rounding.step_deg);
  }

  Mesh make() {
    for (std::size_t p = 0; p < mesh_.polygons.size(); ++p) {
      const bool curved = std::any_of(pieces_[p].begin(), pieces_[p].end(),
                                      [&](const Piece& piece) { return most(piece) > 1; });
      if (!curved) {
        keep(mesh_.polygons[p]);
        continue;
      }
      for (const Piece& piece : pieces_[p]) refine(piece, mesh_.polygons[p]);
    }
    return std::move(made_);
  }

 private:
  void cut(std::size_t p) {
    const MeshPolygon& polygon = mesh_.polygons[p];
    if (polygon.count > max_polygon_corners) return;  // reported when it is placed
    std::vector<Vec3> corners;
    for (std::uint32_t k = 0; k < polygon.count; ++k) {
      corners.push_back(mesh_.vertices[mesh_.indices[polygon.first + k]]);
    }
    Triangulation cut;
    triangulate(corners, 0.0, cut);
    for (const auto& [a, b, c] : cut.triangles) {
      pieces_[p].push_back({{polygon.first + a, polygon.first + b, polygon.first + c}});
    }
  }

  [[nodiscard]] std::uint32_t id(std::uint32_t corner) const { return ids_[mesh_.indices[corner]]; }
  // Edge from corner k of the triangle to the next.
  EdgeCurve& edge(const Piece& piece, std::size_t k) {
    return curves_.of_use(piece.first_use + static_cast<std::uint32_t>(k));
  }

  void add_edges(Piece& piece) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = piece.corner[k], b = piece.corner[(k + 1) % 3];
      const std::uint32_t use = curves_.add(id(a), id(b), normals_[a], normals_[b]);
      if (k == 0) piece.first_use = use;
    }
  }

  std::uint32_t most(const Piece& piece) {
    return std::max({edge(piece, 0).pieces, edge(piece, 1).pieces, edge(piece, 2).pieces});
  }

  void keep(const MeshPolygon& polygon) {
    std::vector<std::uint32_t> corners, uv;
    for (std::uint32_t k = polygon.first; k < polygon.first + polygon.count; ++k) {
      corners.push_back(mesh_.indices[k]);
      if (!mesh_.uv.empty()) uv.push_back(uv_of(k));
    }
    add(corners, uv, polygon);
  }

  void add(const std::vector<std::uint32_t>& corners, const std::vector<std::uint32_t>& uv,
           const MeshPolygon& polygon) {
    add_polygon(made_, corners, polygon.part_set, polygon.material, polygon.line);
    made_.uv_indices.insert(made_.uv_indices.end(), uv.begin(), uv.end());
    // From here on only the side of the normals matters.
    if (polygon.first < mesh_.normal_indices.size()) {
      made_.normal_indices.resize(made_.indices.size() - corners.size(), no_index);
      made_.normal_indices.insert(made_.normal_indices.end(), corners.size(),
                                  mesh_.normal_indices[polygon.first]);
    }
    if (made_.polygons.size() <= most_round_triangles) return;
    throw base::Error(base::Blame::Input, where_, "the rounded mesh is too large",
                      fmt::format("it has at most {} triangles", most_round_triangles),
                      "Raise round_deg");
  }

  [[nodiscard]] std::uint32_t uv_of(std::uint32_t corner) const {
    return corner < mesh_.uv_indices.size() ? mesh_.uv_indices[corner] : no_index;
  }

  // Vertex k on the curve of the edge that begins at corner `from`, at k / pieces of its length.
  std::uint32_t on_edge(const Piece& piece, std::size_t from, std::uint32_t k) {
    EdgeCurve& curve = edge(piece, from);
    const std::uint32_t a = piece.corner[from], b = piece.corner[(from + 1) % 3];
    if (k == 0) return mesh_.indices[a];
    if (k == curve.pieces) return mesh_.indices[b];
    if (curve.vertices.empty()) {
      for (std::uint32_t n = 1; n < curve.pieces; ++n) {
        curve.vertices.push_back(static_cast<std::uint32_t>(made_.vertices.size()));
        made_.vertices.push_back(point_on(curve, double(n) / curve.pieces));
      }
    }
    return curve.vertices[id(a) < id(b) ? k - 1 : curve.pieces - 1 - k];
  }

  // A point of a refined triangle, with corner weights in multiples of 1/n.
  struct Point {
    std::uint32_t vertex = 0, uv = no_index;
  };

  // The cubic patch whose edges are the curves (Vlachos and others 2001): for corner weights w, the
  // sum of b_ijk 3!/(i! j! k!) w^ijk. The middle point follows from the others.
  [[nodiscard]] Vec3 patch_point(const Piece& piece, const Vec3& w) {
    Vec3 sum(0.0), edges(0.0), ends(0.0);
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const std::uint32_t a = piece.corner[std::size_t(k)], b = piece.corner[std::size_t(next)];
      const EdgeCurve& curve = edge(piece, std::size_t(k));
      const bool forward = id(a) < id(b);
      const Vec3& near = curve.points[forward ? 1 : 2];
      const Vec3& far = curve.points[forward ? 2 : 1];
      const Vec3& corner = mesh_.vertices[mesh_.indices[a]];
      sum += w[k] * w[k] * w[k] * corner + 3.0 * w[k] * w[next] * (w[k] * near + w[next] * far);
      edges += near + far;
      ends += corner;
    }
    const Vec3 middle = edges / 4.0 - ends / 6.0;  // E + (E - V)/2, E = edges/6, V = ends/3
    return sum + 6.0 * w[0] * w[1] * w[2] * middle;
  }

  Point point(const Piece& piece, std::uint32_t n, const std::array<std::uint32_t, 3>& at) {
    std::array<double, 3> share{};
    for (std::size_t k = 0; k < 3; ++k) share[k] = double(at[k]) / n;
    Point made;
    const auto zero = static_cast<std::size_t>(std::find(at.begin(), at.end(), 0U) - at.begin());
    if (zero < 3) {
      // On the edge opposite the corner the neighbour has its own number of segments; uses the
      // nearest of its points.
      const std::size_t from = (zero + 1) % 3, to = (zero + 2) % 3;
      const std::uint32_t pieces = edge(piece, from).pieces;
      const auto k = static_cast<std::uint32_t>(std::lround(share[to] * pieces));
      made.vertex = on_edge(piece, from, k);
      share[to] = double(k) / pieces;
      share[from] = 1.0 - share[to];
    } else {
      made.vertex = static_cast<std::uint32_t>(made_.vertices.size());
      made_.vertices.push_back(patch_point(piece, {share[0], share[1], share[2]}));
    }
    const auto& [a, b, c] = piece.corner;
    const std::array<std::uint32_t, 3> uv{uv_of(a), uv_of(b), uv_of(c)};
    if (uv[0] == no_index || uv[1] == no_index || uv[2] == no_index) return made;
    made.uv = static_cast<std::uint32_t>(made_.uv.size());
    glm::dvec2 mixed(0.0);
    for (std::size_t k = 0; k < 3; ++k) mixed += share[k] * glm::dvec2(mesh_.uv[uv[k]]);
    made_.uv.emplace_back(mixed);
    const auto mix = [&](auto& list) {
      if (list.empty()) return;
      auto sum = 0.0F * list.front();
      for (std::size_t k = 0; k < 3; ++k) sum += float(share[k]) * list[uv[k]];
      list.push_back(sum);
    };
    mix(made_.second_uv);
    mix(made_.colours);
    return made;
  }

  void refine(const Piece& piece, const MeshPolygon& polygon) {
    const std::uint32_t n = most(piece);
    std::vector<Point> above, row;
    for (std::uint32_t i = 0; i <= n; ++i) {  // rows from corner 0 to the opposite edge
      row.clear();
      for (std::uint32_t j = 0; j <= i; ++j) row.push_back(point(piece, n, {n - i, i - j, j}));
      for (std::uint32_t j = 0; j < i; ++j) {
        add_triangle(above[j], row[j], row[j + 1], polygon);
        if (j + 1 < i) add_triangle(above[j], row[j + 1], above[j + 1], polygon);
      }
      std::swap(above, row);
    }
  }

  void add_triangle(const Point& a, const Point& b, const Point& c, const MeshPolygon& polygon) {
    if (a.vertex == b.vertex || b.vertex == c.vertex || c.vertex == a.vertex) return;
    const std::vector<std::uint32_t> uv =
        mesh_.uv.empty() ? std::vector<std::uint32_t>() : std::vector{a.uv, b.uv, c.uv};
    add({a.vertex, b.vertex, c.vertex}, uv, polygon);
  }

  const Mesh& mesh_;
  const base::Location& where_;
  std::vector<std::uint32_t> ids_;  // per vertex: equal at one place
  std::vector<Vec3> normals_;       // per vertex: equal at equal positions
  std::vector<std::vector<Piece>> pieces_;
  EdgeCurves curves_;
  Mesh made_;
};

}  // namespace

Mesh rounded(const Mesh& mesh, const Rounding& rounding, const base::Location& where) {
  return Rounder(mesh, rounding, where).make();
}

}  // namespace earthshine::scenes
