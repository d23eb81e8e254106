// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/patch_albedo.h"

#include <cmath>

#include "scenes/reflect/bihemispherical_albedo.h"
#include "scenes/surface_texture.h"

namespace earthshine::radiosity {
namespace {

constexpr int samples = 24;  // along each way of a patch, each as wide as its part of it

using ColourAt = Rgb (*)(const scenes::Scene&, const scenes::Material&,
                         const scenes::SurfacePlace&);

Rgb mean_over(const scenes::Scene& scene, const Patches& patches, std::uint32_t patch,
              ColourAt colour_at) {
  const scenes::Material& material = scene.materials[patches.material(patch)];
  const double width = std::sqrt(patches.area_m2[patch]) / samples;
  Rgb sum(0.0), with_holes(0.0);
  int there = 0;
  for (int i = 0; i < samples; ++i) {
    for (int j = 0; j < samples; ++j) {
      // Each row a little further along, so that the samples are in step with no pattern.
      const double y = (j + 0.5) / samples;
      const double x = (i + glm::fract(0.5 + j * 0.6180339887498949)) / samples;
      const TrianglePlace at = patches.on_triangle(patch, x, y);
      const Rgb colour = colour_at(scene, material, {at.triangle, at.u, at.v, width});
      with_holes += colour;
      if (!scenes::is_there(scene, at.triangle, at.u, at.v)) continue;
      sum += colour;
      ++there;
    }
  }
  // Of a patch that is one hole the rays find out; a colour it has all the same.
  return there > 0 ? sum / double(there) : with_holes / double(samples * samples);
}

}  // namespace

Rgb patch_diffuse(const scenes::Scene& scene, const Patches& patches, std::uint32_t patch) {
  const scenes::Material& material = scene.materials[patches.material(patch)];
  if (!material.maps || !material.maps->diffuse.texture) return material.diffuse;
  return mean_over(scene, patches, patch, scenes::textured_diffuse);
}

Rgb patch_emit(const scenes::Scene& scene, const Patches& patches, std::uint32_t patch) {
  const scenes::Material& material = scene.materials[patches.material(patch)];
  if (!material.maps || !material.maps->emit.texture) return material.emit;
  return mean_over(scene, patches, patch, scenes::textured_emit);
}

PatchAlbedos::PatchAlbedos(const scenes::Scene& scene)
    : scene_(scene), by_material_(scenes::bihemispherical_albedos(scene)) {}

Rgb PatchAlbedos::of(const Patches& patches, std::uint32_t patch) const {
  const std::uint32_t m = patches.material(patch);
  if (!scene_.materials[m].maps) return by_material_[m];
  return by_material_[m] + patch_diffuse(scene_, patches, patch) - scene_.materials[m].diffuse;
}

}  // namespace earthshine::radiosity
