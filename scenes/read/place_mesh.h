// SPDX-License-Identifier: Apache-2.0
// Adds a mesh to the scene: transforms and triangulates it, and assigns materials.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenes/health/file_fronts.h"
#include "scenes/mesh.h"
#include "scenes/time/linkage.h"

namespace earthshine::scenes {

// v -> unit (R_z R_y R_x (scale (from_file v)) + translate), metres.
struct Placement {
  double unit_m = 1.0;
  glm::dmat3 from_file{1.0};  // to the scene's axes and unit
  Vec3 scale{1.0};
  glm::dmat3 rotation{1.0};
  Vec3 translate{0.0};  // in the file's unit
  bool inward = false;  // swaps fronts and backs

  [[nodiscard]] Vec3 apply(const Vec3& v) const {
    return unit_m * (rotation * (scale * (from_file * v)) + translate);
  }
  // Followed by a rigid motion, of metres.
  void move(const Pose& pose) {
    rotation = pose.rotation * rotation;
    translate = pose.rotation * translate + pose.offset_m / unit_m;
  }
  // Whether fronts become backs unless the winding is reversed: a mirror image, or `inward`.
  [[nodiscard]] bool is_mirrored() const { return scale.x * scale.y * scale.z < 0.0; }
  [[nodiscard]] bool reverses() const { return inward != is_mirrored(); }
  // Of a direction of the file, unit.
  [[nodiscard]] Vec3 rotated(const Vec3& along) const {
    return glm::normalize(rotation * (scale * (from_file * along)));
  }
};

// Rotations in degrees about x, then y, then z.
[[nodiscard]] glm::dmat3 rotation_xyz(const Vec3& degrees);

// Limit of triangles in one scene: the later stages would need some 20 GB.
inline constexpr std::size_t max_scene_triangles = std::size_t{1} << 27;

// Appends the polygons of `mesh` that belong to `part` (no_index: all) as the object's triangles
// and fills its counts. material_of returns the scene's material for a mesh material (or for
// no_index, for a polygon at mesh.path:line without material). Polygons without area are omitted
// and counted, with a warning. If the mesh has normals and the object sets no orientation, `fronts`
// gets their sides. Throws base::Error (Input), at the polygon's line if known, for outlines that
// cross themselves, polygons with more than 1024 corners or far from planar, and vertices out of
// range; at `where` for an object without area.
void place_mesh(Scene& scene, Object object, const Mesh& mesh, std::uint32_t part,
                const Placement& placement, const base::Location& where,
                const std::function<std::uint32_t(const MeshPolygon&)>& material_of,
                FileFronts& fronts);

}  // namespace earthshine::scenes
