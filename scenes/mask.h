// SPDX-License-Identifier: Apache-2.0
// Opacity masks: where a surface has holes. Holds copies of what it needs, not the scene.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

inline constexpr std::uint32_t unmasked = 0xFFFFFFFFU;

class OpacityMasks {
 public:
  OpacityMasks() = default;
  explicit OpacityMasks(const Scene& scene);

  [[nodiscard]] bool empty() const { return masked_.empty(); }
  // u, v: weights of the triangle's second and third vertex.
  [[nodiscard]] bool is_hole(std::uint32_t triangle, double u, double v) const {
    return number_[triangle] != unmasked && has_hole(number_[triangle], u, v);
  }
  // A running number of the triangles with masks, in the scene's order; or unmasked.
  [[nodiscard]] std::uint32_t number(std::uint32_t triangle) const { return number_[triangle]; }
  [[nodiscard]] bool has_hole(std::uint32_t number, double u, double v) const;

 private:
  struct Masked {
    std::array<glm::vec2, 3> uv;  // of the corners
    const MaterialMaps* maps;
  };
  std::vector<std::uint32_t> number_;  // per triangle
  std::vector<Masked> masked_;
  std::vector<std::shared_ptr<const MaterialMaps>> maps_;  // keeps them
};

// Whether any material has an opacity mask.
[[nodiscard]] bool any_has_holes(const Scene& scene);

// Whether a place of a textured surface is there; uv: of its vertices, mixed.
[[nodiscard]] bool is_opaque(const MaterialMaps& maps, const glm::dvec2& uv);

}  // namespace earthshine::scenes
