// SPDX-License-Identifier: Apache-2.0
// Faces that stand at the same place more than once.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "scenes/health/coincident.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Two-sided twins of materials.
class Sheets {
 public:
  explicit Sheets(Scene& scene) : scene_(scene) {}

  // The material as both sides of a sheet wear it; added to the scene, once, if it has one side.
  // Glass has no black back, and a sheet of it would not refract: it stays what it is.
  [[nodiscard]] std::uint32_t of(std::uint32_t material) {
    if (scene_.materials[material].two_sided || is_glass(material)) return material;
    const auto [entry, fresh] =
        twins_.emplace(material, static_cast<std::uint32_t>(scene_.materials.size()));
    if (fresh) {
      Material twin = scene_.materials[material];
      twin.name += ", both sides";
      twin.two_sided = true;
      scene_.materials.push_back(twin);
      originals_.emplace(entry->second, material);
    }
    return entry->second;
  }

  [[nodiscard]] bool is_glass(std::uint32_t material) const {
    return base::max_component(scene_.materials[material].transmit) > 0.0;
  }
  // Alike but for the number of sides.
  [[nodiscard]] bool alike(std::uint32_t a, std::uint32_t b) const {
    return original(a) == original(b);
  }

 private:
  [[nodiscard]] std::uint32_t original(std::uint32_t material) const {
    const auto found = originals_.find(material);
    return found == originals_.end() ? material : found->second;
  }

  Scene& scene_;
  std::map<std::uint32_t, std::uint32_t> twins_, originals_;
};

// The triangles of a polygon of the file; they follow each other in the scene.
struct Face {
  std::uint32_t first = 0, count = 0;
  std::vector<std::uint32_t> corners;  // welded, ascending, each once
};

// Groups of faces with the same corners, the first of the scene first; of none whose object is to
// be left as it is. ids: as welded() gives them.
using DoubledFaces = std::vector<std::vector<Face>>;
[[nodiscard]] DoubledFaces find_doubled_faces(const Scene& scene,
                                              std::span<const std::uint32_t> ids);

// As mend_surfaces has it; whether any were taken out or changed.
[[nodiscard]] bool mend_doubled_faces(Scene& scene, const DoubledFaces& doubled, Sheets& sheets,
                                      const FaceParts& parts);

}  // namespace earthshine::scenes
