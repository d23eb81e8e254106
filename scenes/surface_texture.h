// SPDX-License-Identifier: Apache-2.0
// What a textured surface is like at a point of it, and on average.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// A point of a triangle by the weights u, v of its second and third vertex.
struct SurfacePlace {
  std::uint32_t triangle = 0;
  double u = 0.0, v = 0.0;
};

// k_d and exitance there; without a texture those of the material.
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

// Texels to a metre of the triangle, by their areas, of the finest texture of its material; 0: none.
[[nodiscard]] double texels_per_m(const Scene& scene, std::uint32_t triangle);

// The mean exitance of a triangle over its whole area, holes included.
[[nodiscard]] Rgb mean_emit(const Scene& scene, std::uint32_t triangle);

// Whether anything is there: false in the holes of an opacity mask.
[[nodiscard]] bool is_there(const Scene& scene, std::uint32_t triangle, double u, double v);

// Replaces the factors in diffuse and emit of textured materials, as their files have them, by
// their means over the surfaces that wear them, and finds TextureMap::over_mean. Once, when a scene
// is complete.
void settle_textures(Scene& scene);

// All textures of the scene together, bytes.
[[nodiscard]] std::size_t texture_bytes(const Scene& scene);

// Opacity masks: where a surface has holes. Holds copies of what it needs, not the scene.

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
