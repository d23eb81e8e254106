// SPDX-License-Identifier: Apache-2.0
// A mesh into the scene: transformed, triangulated, with its materials and its place in the counts.
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
  bool inward = false;  // fronts become backs

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
  [[nodiscard]] Vec3 turned(const Vec3& along) const {
    return glm::normalize(rotation * (scale * (from_file * along)));
  }
};

// Degrees about x, then y, then z.
[[nodiscard]] glm::dmat3 rotation_xyz(const Vec3& degrees);

// More triangles than this in one scene are refused: some 20 GB in the stages that follow.
inline constexpr std::size_t max_scene_triangles = std::size_t{1} << 27;

// Appends the polygons of `mesh` that belong to `part` (no_index: all) as the object's triangles
// and fills its counts. material_of gives the scene's material of a mesh material (or of no_index,
// for a polygon at mesh.path:line that has none). Polygons without area are left out and counted,
// with a warning in the scene. Where the mesh has normals, `fronts` gets their sides, unless the
// object says its own. Throws base::Error (Input), at the polygon's line where known, for
// outlines that cross themselves, polygons of more than 1024 corners or far from flat, and vertices
// out of range; at `where` for an object without area.
void place_mesh(Scene& scene, Object object, const Mesh& mesh, std::uint32_t part,
                const Placement& placement, const base::Location& where,
                const std::function<std::uint32_t(const MeshPolygon&)>& material_of,
                FileFronts& fronts);

}  // namespace earthshine::scenes
