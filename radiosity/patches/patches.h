// SPDX-License-Identifier: Apache-2.0
// Patches: cells of the surfaces for the radiosity solve. The ray structure has triangles only; the
// patch of a hit is computed from (triangle, u, v) in O(1).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "scenes/scene.h"
#include "scenes/triangle_point.h"

namespace earthshine::radiosity {

inline constexpr std::uint32_t no_patch = 0xFFFFFFFFU;
inline constexpr std::uint32_t no_tree = 0xFFFFFFFFU;

// A triangle or a parallelogram of the scene with a grid of cells over its parameters (s, t) in
// [0,1]^2. Any cell may be halved along s or along t, its halves again, and so on (a binary tree in
// every cell of the grid).
//   parallelogram: p = corner + s a + t b
//   triangle:      p = corner + s (a + t (b - a)): s from the apex (the corner opposite the
//                  shortest edge) to that edge, t along it; cells are trapezoids, so that long
//                  thin triangles have nearly square ones
// Or a cluster of small triangles (clusters.h), whose parameters only number them
// (cluster_members.h): normal and area are of the whole cluster; corner, a and b are unused. Cells
// with walls on or through them are divided along the walls (parted_cell.h).
struct Facet {
  Vec3 corner, a, b;
  Vec3 normal;  // unit, of the front
  double area_m2 = 0.0;
  std::uint32_t s_count = 1, t_count = 1;
  std::uint32_t first_front = no_patch;  // its leaves, one patch each; without a tree leaf s *
                                         // t_count + t of the grid
  std::uint32_t first_back = no_patch;   // sheets only: patches of the same leaves on the back
  std::uint32_t leaves = 1;
  std::uint32_t tree = no_tree;  // start of its grid in Patches::tree, if any cell is divided
  std::uint32_t triangle = 0;    // index of the first triangle in the scene
  std::uint32_t material = 0, object = 0;
  std::uint8_t apex = 0;  // vertex of the triangle that is the corner
  bool parallelogram = false;
  std::uint32_t members = 0, first_member = 0;  // triangles of a cluster; 0: not a cluster

  [[nodiscard]] bool is_cluster() const { return members > 0; }
};

struct Parameters {
  double s, t;
};

// A point of a scene triangle: weights of its second and third vertex.
struct TrianglePlace {
  std::uint32_t triangle;
  double u, v;
};

struct SurfacePoint {
  Vec3 position, normal;  // unit, on the patch's side
  std::uint32_t triangle = 0;
};

struct ClusterMembers;
class Traces;

// Point of a facet's plane: p = corner + x a + y b.
using PlanePoint = glm::dvec2;
// A part of a cell, counter-clockwise in the facet's orientation; a triangle repeats its last
// corner.
using Outline = std::array<PlanePoint, 4>;
inline constexpr std::uint32_t no_outline = 0xFFFFFFFFU;

// Division of a cell: points with normal . p >= reach are on the second side. A side is the index
// of another node, or ~k for part k of the cell.
struct PartNode {
  PlanePoint normal;
  double reach;
  std::array<std::int32_t, 2> side;
};

// A leaf: cell (s, t) of the (s_count << s_cuts) x (t_count << t_cuts) cells of a facet whose whole
// grid is halved as often, or part of such a cell.
struct Cell {
  std::uint32_t s = 0, t = 0;
  std::uint8_t s_cuts = 0, t_cuts = 0;
  std::uint16_t part = 0;              // index of the part; 0 also for a whole cell
  std::uint32_t outline = no_outline;  // in Patches::outlines; no_outline: whole
};

struct Rectangle {  // in parameters
  double s0, s1, t0, t1;
};

class Patches {
 public:
  std::vector<Facet> facets;
  std::vector<double> area_m2;             // per patch
  std::vector<std::uint32_t> facet;        // per patch
  std::vector<Cell> cell;                  // per patch
  std::vector<std::uint8_t> is_back;       // per patch: 1 for the back of a sheet
  std::vector<std::uint32_t> of_triangle;  // facet of each triangle
  std::vector<std::uint8_t> second_half;   // per triangle: 1 for the second half of a parallelogram
  // Facets with divided cells: s_count * t_count entries each, then pairs of halves. An entry is
  // the index of a leaf in its facet, or split_cell + the position of its pair, with halves_t if
  // the halves are adjacent along t instead of s. With parted_cell the two entries are not a pair
  // but the index of the leaf that is the cell's first part (the others follow) and the position of
  // its first node in part_nodes.
  std::vector<std::uint32_t> tree;
  static constexpr std::uint32_t split_cell = 0x80000000U;
  static constexpr std::uint32_t halves_t = 0x40000000U;
  static constexpr std::uint32_t parted_cell = 0x20000000U;
  static constexpr std::uint32_t pair_of = 0x1FFFFFFFU;  // bits of an entry for the position
  std::vector<PartNode> part_nodes;
  std::vector<Outline> outlines;
  std::shared_ptr<const Traces> traces;             // walls that divide cells; or null
  std::shared_ptr<const ClusterMembers> clustered;  // null: no cluster
  double cluster_edge_m = 0.0;                      // wanted edge of the clusters; 0: none

  [[nodiscard]] std::size_t count() const { return area_m2.size(); }

  // (s, t) on its facet of a hit with weights u, v of the triangle's second and third vertex.
  [[nodiscard]] Parameters parameters(std::uint32_t triangle, double u, double v) const;
  // no_patch for the back of a one-sided surface.
  [[nodiscard]] std::uint32_t find(std::uint32_t triangle, double u, double v, bool front) const;

  // The leaf at (s, t), counted from the facet's first patch, and the position in it: x along s, y
  // along t, from 0 to 1.
  struct Place {
    std::uint32_t leaf;
    double x, y;
  };
  [[nodiscard]] Place place(const Facet& of, Parameters where) const;
  // Index of the part of a divided cell that contains p.
  [[nodiscard]] std::uint32_t part_at(std::uint32_t first_node, const PlanePoint& p) const;
  [[nodiscard]] std::uint32_t leaf(const Facet& of, Parameters where) const {
    return place(of, where).leaf;
  }

  [[nodiscard]] Rectangle rectangle(std::uint32_t patch) const;  // of the patch's cell
  // Counter-clockwise about the patch's own normal; a triangle's apex is repeated. For several
  // triangles: a rectangle below them, normal to their mean normal.
  [[nodiscard]] std::array<Vec3, 4> corners(std::uint32_t patch) const;
  [[nodiscard]] scenes::Box box(std::uint32_t patch) const;  // low, high
  // A point of the patch, uniform in area for uniform (x, y) in [0,1]^2.
  [[nodiscard]] SurfacePoint at(std::uint32_t patch, double x, double y) const;
  [[nodiscard]] Vec3 point(std::uint32_t patch, double x, double y) const {
    return at(patch, x, y).position;
  }
  // The point as a position in its triangle.
  [[nodiscard]] TrianglePlace on_triangle(std::uint32_t patch, double x, double y) const;
  // On the patch's side; for several triangles the area-weighted mean.
  [[nodiscard]] Vec3 normal(std::uint32_t patch) const;
  // Normal of the triangle itself, on this side.
  [[nodiscard]] Vec3 normal_at(std::uint32_t triangle, bool front) const;
  // Whether the patch has several triangles of a cluster.
  [[nodiscard]] bool is_several(std::uint32_t patch) const;
  // Whether it is part of a divided cell.
  [[nodiscard]] bool is_part(std::uint32_t patch) const {
    return cell[patch].outline != no_outline;
  }
  [[nodiscard]] std::uint32_t material(std::uint32_t patch) const {
    return facets[facet[patch]].material;
  }
  [[nodiscard]] std::uint32_t object(std::uint32_t patch) const {
    return facets[facet[patch]].object;
  }
};

// Divides every surface so that no cell is longer than edge_m along its facet's directions, after
// joining small triangles to clusters of about cluster_edge_m (clusters.h; 0: none). Throws
// base::Error (Input) if more than 2^26 patches would result.
[[nodiscard]] Patches subdivide(const scenes::Scene& scene, double edge_m,
                                double cluster_edge_m = 0.0);

// Number of patches with clusters of the same edge, without making them. Throws as subdivide does.
[[nodiscard]] std::size_t count_patches(const scenes::Scene& scene, double edge_m);

// Area, and position in parameters, of a cell or part of a facet that is not a cluster.
[[nodiscard]] Rectangle rectangle_of(const Facet& facet, const Cell& cell);
[[nodiscard]] double area_of(const Facet& facet, const Rectangle& rectangle);
[[nodiscard]] double area_of(const Facet& facet, const Outline& outline);
// Position in the triangle: the inverse of Patches::parameters.
[[nodiscard]] TrianglePlace triangle_place(const Facet& facet, Parameters where);
// Area of a cell of any facet.
[[nodiscard]] double area_of(const Patches& patches, const Facet& facet, const Cell& cell);

// Open parts of the patches (closed_bodies.h).

class ClosedBodies;

struct OpenParts {
  std::vector<double> share;  // per patch: share of its points that no body covers; empty: all 1
  std::shared_ptr<const ClosedBodies> bodies;  // null: nothing is covered
};

// area_m2 times the open share.
[[nodiscard]] std::vector<double> open_areas(const OpenParts& open,
                                             std::span<const double> area_m2);

// Area means of the patches' reflectance and emission for textured materials.

// Mean of k_d over the patch, without holes; without a texture the material's k_d.
[[nodiscard]] Rgb patch_diffuse(const scenes::Scene& scene, const Patches& patches,
                                std::uint32_t patch);
// Mean of the exitance.
[[nodiscard]] Rgb patch_emit(const scenes::Scene& scene, const Patches& patches,
                             std::uint32_t patch);

// Diffuse reflectance rho of patches: k_d plus the albedo of the lobe
// (scenes::bihemispherical_albedos). The scene must outlive it.
class PatchAlbedos {
 public:
  explicit PatchAlbedos(const scenes::Scene& scene);
  [[nodiscard]] Rgb of(const Patches& patches, std::uint32_t patch) const;

 private:
  const scenes::Scene& scene_;
  std::vector<Rgb> by_material_;
};

}  // namespace earthshine::radiosity
