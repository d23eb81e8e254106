// SPDX-License-Identifier: Apache-2.0
// Assigns a scene material to each face of an object.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/read/scene_parts.h"

namespace earthshine::scenes {

// The object's `material` if given; else the face's material name, first in the scene's
// [[material]] tables, then in the mesh's library, whose material is added to the scene.
class MaterialChoice {
 public:
  // Throws base::Error (Input) if the object's `material` is undefined.
  MaterialChoice(Scene& scene, const TableReader& object, ShelvedMesh& shelved,
                 std::size_t own_material_count);

  // Throws base::Error (Input) for a face without material and for an undefined name.
  [[nodiscard]] std::uint32_t material_of(const MeshPolygon& polygon);

 private:
  [[nodiscard]] std::uint32_t own_material(const std::string& name) const;
  [[nodiscard]] std::uint32_t find(const std::string& name, const base::Location& place);
  [[nodiscard]] std::uint32_t add_to_scene(std::uint32_t mesh_material);

  Scene& scene_;
  const TableReader& object_;
  ShelvedMesh& shelved_;
  std::size_t own_material_count_;
  std::vector<std::uint32_t> chosen_;  // per material name of the mesh
  std::uint32_t override_ = no_index;
};

}  // namespace earthshine::scenes
