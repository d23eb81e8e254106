// SPDX-License-Identifier: Apache-2.0
// Two-sided twins of materials.
#pragma once

#include <cstdint>
#include <map>

#include "scenes/scene.h"

namespace earthshine::scenes {

class Sheets {
 public:
  explicit Sheets(Scene& scene) : scene_(scene) {}

  // The material as both sides of a sheet wear it; added to the scene, once, if it has one side.
  [[nodiscard]] std::uint32_t of(std::uint32_t material) {
    if (scene_.materials[material].two_sided) return material;
    const auto [entry, fresh] =
        twins_.emplace(material, static_cast<std::uint32_t>(scene_.materials.size()));
    if (fresh) {
      Material twin = scene_.materials[material];
      twin.name += ", both sides";
      twin.two_sided = true;
      scene_.materials.push_back(twin);
    }
    return entry->second;
  }

 private:
  Scene& scene_;
  std::map<std::uint32_t, std::uint32_t> twins_;
};

}  // namespace earthshine::scenes
