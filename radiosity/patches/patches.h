// SPDX-License-Identifier: Apache-2.0
// Patches: the cells that surfaces are cut into for the radiosity solve. The ray structure knows
// triangles only; the patch of a hit follows from (triangle, u, v) by arithmetic, in O(1).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::radiosity {

inline constexpr std::uint32_t no_patch = 0xFFFFFFFFU;
inline constexpr std::uint32_t no_tree = 0xFFFFFFFFU;

// A triangle or a parallelogram of the scene with a grid of cells over its parameters (s, t) in
// [0,1]^2; any cell may be halved along s or along t, its halves again, and so on (a binary tree in
// every cell of the grid).
//   parallelogram: p = corner + s a + t b
//   triangle:      p = corner + s (a + t (b - a)): s runs from the apex (the corner opposite the
//   shortest edge)
//                  to that edge, t along it; cells are trapezoids, and long thin triangles get
//                  square ones
// Or a cluster of small triangles (clusters.h), whose parameters only number them
// (cluster_members.h): normal and area are those of all, corner, a and b are not used.
// Cells that walls stand on or pierce are parted along them (parted_cell.h).
struct Facet {
  Vec3 corner, a, b;
  Vec3 normal;  // unit, of the front
  double area_m2 = 0.0;
  std::uint32_t s_count = 1, t_count = 1;
  std::uint32_t first_front = no_patch;  // its leaves, one patch each; without a tree leaf
                                         // s * t_count + t of the grid
  std::uint32_t first_back = no_patch;   // sheets only: the same leaves, seen from behind
  std::uint32_t leaves = 1;
  std::uint32_t tree = no_tree;  // where its grid starts in Patches::tree, if any cell is split
  std::uint32_t triangle = 0;    // first triangle of the scene
  std::uint32_t material = 0, object = 0;
  std::uint8_t apex = 0;  // which vertex of the triangle is the corner
  bool parallelogram = false;
  std::uint32_t members = 0, first_member = 0;  // triangles of a cluster; 0: it is none

  [[nodiscard]] bool is_cluster() const { return members > 0; }
};

struct Parameters {
  double s, t;
};

// A place in a triangle of the scene: weights of its second and third vertex.
struct TrianglePlace {
  std::uint32_t triangle;
  double u, v;
};

struct SurfacePoint {
  Vec3 position, normal;  // unit, on the patch's own side
  std::uint32_t triangle = 0;
};

struct ClusterMembers;
class Traces;

// In the plane of a facet: p = corner + x a + y b.
using PlanePoint = glm::dvec2;
// A part of a cell, counter-clockwise as the facet has it; of a triangle the last corner stands
// twice.
using Outline = std::array<PlanePoint, 4>;
inline constexpr std::uint32_t no_outline = 0xFFFFFFFFU;

// Where a cell is parted: points with way . p >= reach are on the second side. A side is another
// such node, or as ~k part k of the cell.
struct PartNode {
  PlanePoint way;
  double reach;
  std::array<std::int32_t, 2> side;
};

// A leaf: cell (s, t) of the (s_count << s_cuts) x (t_count << t_cuts) cells that its facet would
// have if all of its grid had been halved as often, or part of it.
struct Cell {
  std::uint32_t s = 0, t = 0;
  std::uint8_t s_cuts = 0, t_cuts = 0;
  std::uint16_t part = 0;              // which one; 0 also where it is whole
  std::uint32_t outline = no_outline;  // in Patches::outlines; no_outline: it is whole
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
  std::vector<std::uint8_t> is_back;       // per patch: it is the back of a sheet
  std::vector<std::uint32_t> of_triangle;  // per triangle: its facet
  std::vector<std::uint8_t> second_half;   // per triangle: the second of a parallelogram
  // Facets with split cells: s_count * t_count entries each, then pairs of halves. An entry is a
  // leaf's number within its facet, or split_cell + where its pair is, with halves_t if the halves
  // lie side by side along t and not along s; with parted_cell it is no pair but the number of the
  // leaf that is the cell's first part, the others follow, and where its first node is in
  // part_nodes.
  std::vector<std::uint32_t> tree;
  static constexpr std::uint32_t split_cell = 0x80000000U;
  static constexpr std::uint32_t halves_t = 0x40000000U;
  static constexpr std::uint32_t parted_cell = 0x20000000U;
  static constexpr std::uint32_t pair_of = 0x1FFFFFFFU;  // the bits of an entry that say where
  std::vector<PartNode> part_nodes;
  std::vector<Outline> outlines;
  std::shared_ptr<const Traces> traces;  // of walls, that cells are parted along; or null
  std::shared_ptr<const ClusterMembers> clustered;  // null: there is no cluster
  double cluster_edge_m = 0.0;                      // that clusters were made for; 0: none

  [[nodiscard]] std::size_t count() const { return area_m2.size(); }

  // (s, t) on its facet of a hit with weights u, v of the triangle's second and third vertex.
  [[nodiscard]] Parameters parameters(std::uint32_t triangle, double u, double v) const;
  // no_patch for the back of a one-sided surface.
  [[nodiscard]] std::uint32_t find(std::uint32_t triangle, double u, double v, bool front) const;

  // The leaf at (s, t), counted from the facet's first patch, and where in it that is: x along s, y
  // along t, from 0 to 1.
  struct Place {
    std::uint32_t leaf;
    double x, y;
  };
  [[nodiscard]] Place place(const Facet& of, Parameters where) const;
  // Of a parted cell.
  [[nodiscard]] std::uint32_t part_at(std::uint32_t first_node, const PlanePoint& p) const;
  [[nodiscard]] std::uint32_t leaf(const Facet& of, Parameters where) const {
    return place(of, where).leaf;
  }

  [[nodiscard]] Rectangle rectangle(std::uint32_t patch) const;  // of its cell
  // Counter-clockwise about the patch's own normal; where a triangle's apex is a corner it stands
  // twice. Of several triangles: of a rectangle about their mean normal that they all lie over.
  [[nodiscard]] std::array<Vec3, 4> corners(std::uint32_t patch) const;
  [[nodiscard]] std::pair<Vec3, Vec3> box(std::uint32_t patch) const;  // low, high
  // A point of the patch, uniform in area for uniform (x, y) in [0,1]^2.
  [[nodiscard]] SurfacePoint at(std::uint32_t patch, double x, double y) const;
  [[nodiscard]] Vec3 point(std::uint32_t patch, double x, double y) const {
    return at(patch, x, y).position;
  }
  // The same as a place in its triangle.
  [[nodiscard]] TrianglePlace on_triangle(std::uint32_t patch, double x, double y) const;
  // On the patch's own side; of several triangles that of their mean by area.
  [[nodiscard]] Vec3 normal(std::uint32_t patch) const;
  // Of the triangle itself, on that side of it.
  [[nodiscard]] Vec3 normal_at(std::uint32_t triangle, bool front) const;
  // Whether the patch is several triangles of a cluster.
  [[nodiscard]] bool is_several(std::uint32_t patch) const;
  // Whether it is a part of its cell.
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

// Cuts every surface so that no cell is longer than edge_m along its facet's directions, after
// small triangles were joined to clusters of about cluster_edge_m (clusters.h; 0: none).
// Throws base::Error (Input) when more than 2^26 patches would result.
[[nodiscard]] Patches subdivide(const scenes::Scene& scene, double edge_m,
                                double cluster_edge_m = 0.0);

// How many that would be with clusters of the same edge, without making them. Throws as subdivide
// does.
[[nodiscard]] std::size_t count_patches(const scenes::Scene& scene, double edge_m);

// Area and place in parameters of a cell, or of a part, of a facet, no cluster's.
[[nodiscard]] Rectangle rectangle_of(const Facet& facet, const Cell& cell);
[[nodiscard]] double area_of(const Facet& facet, const Rectangle& rectangle);
[[nodiscard]] double area_of(const Facet& facet, const Outline& outline);
// The place in the triangle: the inverse of Patches::parameters.
[[nodiscard]] TrianglePlace triangle_place(const Facet& facet, Parameters where);
// Of a cell of any facet.
[[nodiscard]] double area_of(const Patches& patches, const Facet& facet, const Cell& cell);

// What bodies leave open of the patches (closed_bodies.h).

class ClosedBodies;

struct OpenParts {
  std::vector<double> share;  // per patch: of its points, those that no body covers; empty: all 1
  std::shared_ptr<const ClosedBodies> bodies;  // null: nothing is covered
};

// area_m2 times the share.
[[nodiscard]] std::vector<double> open_areas(const OpenParts& open,
                                             std::span<const double> area_m2);

// What patches reflect and emit on average over their area, where materials have textures.

// The mean of k_d over what is there of the patch; without a texture the material's.
[[nodiscard]] Rgb patch_diffuse(const scenes::Scene& scene, const Patches& patches,
                                std::uint32_t patch);
// Of the exitance.
[[nodiscard]] Rgb patch_emit(const scenes::Scene& scene, const Patches& patches,
                             std::uint32_t patch);

// rho of patches: k_d and the mean of the lobe (scenes::bihemispherical_albedos). The scene must
// outlive it.
class PatchAlbedos {
 public:
  explicit PatchAlbedos(const scenes::Scene& scene);
  [[nodiscard]] Rgb of(const Patches& patches, std::uint32_t patch) const;

 private:
  const scenes::Scene& scene_;
  std::vector<Rgb> by_material_;
};

}  // namespace earthshine::radiosity
