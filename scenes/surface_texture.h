// SPDX-License-Identifier: Apache-2.0
// Properties of a textured surface, at a point and on average.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// A point of a triangle: u, v are the weights of its second and third vertex.
struct SurfacePlace {
  std::uint32_t triangle = 0;
  double u = 0.0, v = 0.0;
};

// k_d and exitance at a place; without a texture the material's values.
[[nodiscard]] Rgb textured_diffuse(const Scene& scene, const Material& material,
                                   const SurfacePlace& place);
[[nodiscard]] Rgb textured_emit(const Scene& scene, const Material& material,
                                const SurfacePlace& place);

[[nodiscard]] inline Rgb diffuse_at(const Scene& scene, const Material& material, const Hit& hit) {
  if (!material.maps) return material.diffuse;
  return textured_diffuse(scene, material, {hit.triangle, hit.u, hit.v});
}
[[nodiscard]] inline Rgb emit_at(const Scene& scene, const Material& material, const Hit& hit) {
  if (!material.maps) return material.emit;
  return textured_emit(scene, material, {hit.triangle, hit.u, hit.v});
}

// Texels per metre of the triangle, from areas, of its material's finest texture; 0: no texture.
[[nodiscard]] double texels_per_m(const Scene& scene, std::uint32_t triangle);

// Mean exitance of a triangle over its whole area, including holes.
[[nodiscard]] Rgb mean_emit(const Scene& scene, std::uint32_t triangle);

// False in the holes of an opacity mask.
[[nodiscard]] bool is_there(const Scene& scene, std::uint32_t triangle, double u, double v);

// Replaces the factors in diffuse and emit of textured materials by their means over the surfaces
// of the material, and computes TextureMap::over_mean. Call once, when a scene is complete.
void settle_textures(Scene& scene);

// Size of all textures of the scene, bytes.
[[nodiscard]] std::size_t texture_bytes(const Scene& scene);

// Opacity masks: holes of surfaces. Copies its data from the scene.

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
  // Index among triangles with masks, in the scene's order; or unmasked.
  [[nodiscard]] std::uint32_t number(std::uint32_t triangle) const { return number_[triangle]; }
  [[nodiscard]] bool has_hole(std::uint32_t number, double u, double v) const;

 private:
  struct Masked {
    std::array<glm::vec2, 3> uv;  // of the corners
    const MaterialMaps* maps;
  };
  std::vector<std::uint32_t> number_;  // per triangle
  std::vector<Masked> masked_;
  std::vector<std::shared_ptr<const MaterialMaps>> maps_;  // owns them
};

// Whether any material has an opacity mask.
[[nodiscard]] bool any_has_holes(const Scene& scene);

// Whether a textured surface exists at a place; uv: interpolated texture coordinates.
[[nodiscard]] bool is_opaque(const MaterialMaps& maps, const glm::dvec2& uv);

}  // namespace earthshine::scenes
