// SPDX-License-Identifier: Apache-2.0
// Lamps and cameras that stand in a mesh file, as a scene's own.
#pragma once

#include <string>

#include "scenes/mesh.h"
#include "scenes/read/place_mesh.h"

namespace earthshine::scenes {

// Appends those of the part (no_index: all), placed as the object's faces are; strengths do not
// change with scale. Their names are "OBJECT.NAME" and new to the scene; each lamp is a light group
// of its own. Throws base::Error (Input) at `where` for coordinates that are too large.
void add_file_lamps(Scene& scene, const std::string& object, const Mesh& mesh, std::uint32_t part,
                    const Placement& placement, const base::Location& where);
void add_file_cameras(Scene& scene, const std::string& object, const Mesh& mesh, std::uint32_t part,
                      const Placement& placement, const base::Location& where);

}  // namespace earthshine::scenes
