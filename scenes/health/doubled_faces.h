// SPDX-License-Identifier: Apache-2.0
// Duplicate faces at the same place.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "scenes/health/coincident.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Two-sided copies of materials.
class Sheets {
 public:
  explicit Sheets(Scene& scene) : scene_(scene) {}

  // The two-sided version of a material, added to the scene once if necessary. Glass stays
  // unchanged: it has no black back, and a sheet of glass would not refract.
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
  // Equal except for two_sided.
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

// The triangles of one file polygon, consecutive in the scene.
struct Face {
  std::uint32_t first = 0, count = 0;
  std::vector<std::uint32_t> corners;  // welded, ascending, without repetitions
};

// Groups of faces with the same corners, in scene order; excludes objects with Orient::AsIs. ids:
// result of welded().
using DoubledFaces = std::vector<std::vector<Face>>;
[[nodiscard]] DoubledFaces find_doubled_faces(const Scene& scene,
                                              std::span<const std::uint32_t> ids);

// Repairs duplicate faces as described at mend_surfaces. Returns whether any face was removed or
// changed.
[[nodiscard]] bool mend_doubled_faces(Scene& scene, const DoubledFaces& doubled, Sheets& sheets,
                                      const FaceParts& parts);

}  // namespace earthshine::scenes
