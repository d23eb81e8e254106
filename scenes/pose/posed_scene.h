// SPDX-License-Identifier: Apache-2.0
// Another pose of a scene that was read, without reading its files again.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// Differences to the pose that was read. Shifts are in m, in the axes of the file, before the joint
// that the object or lamp hangs on moves it.
struct PoseChange {
  struct ObjectShift {
    std::size_t object;
    Vec3 shift_m;
  };
  struct LampShift {
    std::size_t lamp;
    Vec3 shift_m;
    std::optional<Vec3> axis;  // likewise before the joint; empty: as it was
  };
  struct JointAngle {
    std::size_t joint;  // of Linkage::joints, with a fixed angle
    double angle_deg;
  };
  std::vector<ObjectShift> objects;
  std::vector<LampShift> lamps;
  std::vector<JointAngle> joints;

  [[nodiscard]] bool moves_surfaces() const { return !objects.empty() || !joints.empty(); }
};

// Lamps and cameras of an object's mesh file move with the object. Positions are those of a scene
// read with these values to rounding: 1e-15 of the scene's size. Surfaces are not mended again, and
// lamps that come to lie on a surface are not lifted off it. Throws base::Error (Input) for parts
// that are moved out of the range of coordinates.
[[nodiscard]] Scene posed_scene(const Scene& scene, const PoseChange& change);

}  // namespace earthshine::scenes
