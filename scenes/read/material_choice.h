// SPDX-License-Identifier: Apache-2.0
// Which of the scene's materials a face of an object wears.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/read/scene_parts.h"

namespace earthshine::scenes {

// The object's `material` if it has one; else the face's own material name, looked up first in the
// scene's
// [[material]] and then in the mesh's library, whose material is then added to the scene.
class MaterialChoice {
 public:
  // Throws base::Error (Input) if the object's `material` is one that nobody defines.
  MaterialChoice(Scene& scene, const TableReader& object, ShelvedMesh& shelved,
                 std::size_t own_material_count);

  // Throws base::Error (Input) for a face without material, and for a name that nobody defines.
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
