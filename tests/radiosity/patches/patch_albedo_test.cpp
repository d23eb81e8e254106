// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "radiosity/patches/patches.h"
#include "radiosity/store/solution_key.h"
#include "scenes/surface_texture.h"
#include "scenes/texture/texture.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

// A square of 2 m in the plane z = 0, u along x and v along y, its left half black and its right
// half white. With holes the left half is missing.
scenes::Scene textured_square(bool as_parallelogram, int white = 255, bool holes = false) {
  tests::SceneBuilder builder;
  base::Pixels pixels{2, 1, {0, 0, 0, static_cast<std::uint8_t>(holes ? 0 : 255)}};
  for (const int c : {white, white, white, 255})
    pixels.rgba.push_back(static_cast<std::uint8_t>(c));
  scenes::TextureReading reading;
  reading.is_srgb = false;
  reading.is_crisp = true;
  auto maps = std::make_shared<scenes::MaterialMaps>();
  maps->diffuse.texture = std::make_shared<const scenes::Texture>(pixels, reading);
  maps->diffuse.transform = std::make_shared<const scenes::TextureTransform>();
  if (holes) maps->opacity = maps->diffuse;
  scenes::Material material = tests::grey(0.8);
  material.maps = maps;
  builder.plate(builder.material(material), 2.0, 0.0, true);
  scenes::Scene& scene = builder.scene;
  if (!as_parallelogram) scene.triangles[1].polygon += 1;
  scene.vertex_uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  scenes::settle_textures(scene);
  return scene;
}

TEST(PatchAlbedo, MaterialHasTheMeanOfItsTextureAndPatchesHaveTheirs) {
  for (const bool as_parallelogram : {true, false}) {
    const scenes::Scene scene = textured_square(as_parallelogram);
    EXPECT_NEAR(scene.materials[0].diffuse.r, 0.4, 0.002);
    const Patches patches = subdivide(scene, 0.25);
    double sum = 0.0;
    for (std::uint32_t i = 0; i < patches.count(); ++i) {
      const Rgb rho = patch_diffuse(scene, patches, i);
      sum += patches.area_m2[i] * rho.r;
      double low = 1.0, high = -1.0;
      for (const Vec3& p : patches.corners(i)) {
        low = std::min(low, p.x);
        high = std::max(high, p.x);
      }
      const bool on_left = high <= 1e-9, on_right = low >= -1e-9;
      if (on_left || on_right) {
        // k_d = 0.8 there by the texture's mean, which the sample lattice finds to 1e-3.
        EXPECT_NEAR(rho.r, on_left ? 0.0 : 0.8, 0.8 * 2e-3);
      }
      EXPECT_NEAR(PatchAlbedos(scene).of(patches, i).r, rho.r, 1e-12);
    }
    EXPECT_NEAR(sum, 0.4 * 4.0, 0.01);  // total reflectance of the square
  }
}

// Patches over both halves: half of the square is white; of its halves along the diagonal from (-1,
// -1) to (1, 1) the lower one by 3/4, the upper one by 1/4.
TEST(PatchAlbedo, IsTheMeanByArea) {
  for (const bool as_parallelogram : {true, false}) {
    const scenes::Scene scene = textured_square(as_parallelogram);
    const Patches patches = subdivide(scene, 10.0);
    for (std::uint32_t i = 0; i < patches.count(); ++i) {
      const bool lower = patches.facets[patches.facet[i]].triangle == 0;
      const double white = as_parallelogram ? 0.5 : lower ? 0.75 : 0.25;
      EXPECT_NEAR(patch_diffuse(scene, patches, i).r, 0.8 * white, 0.8 * 0.01);
    }
  }
}

// One patch over both halves: 0.8 times the white half. Over the whole area it would be 0.4.
TEST(PatchAlbedo, IsTheMeanOfWhatIsThere) {
  const scenes::Scene scene = textured_square(true, 255, true);
  EXPECT_NEAR(patch_diffuse(scene, subdivide(scene, 10.0), 0).r, 0.8, 1e-9);
}

TEST(PatchAlbedo, PlaceInTheTriangleIsWhereTheParametersAre) {
  for (const bool as_parallelogram : {true, false}) {
    const scenes::Scene scene = textured_square(as_parallelogram);
    const Patches patches = subdivide(scene, 10.0);
    for (std::uint32_t i = 0; i < patches.count(); ++i) {
      const Facet& facet = patches.facets[patches.facet[i]];
      for (const auto& [s, t] : {std::pair{0.2, 0.7}, {0.9, 0.1}, {0.5, 0.5}}) {
        const TrianglePlace place = triangle_place(facet, {s, t});
        const Parameters back = patches.parameters(place.triangle, place.u, place.v);
        EXPECT_NEAR(back.s, s, 1e-12);
        EXPECT_NEAR(back.t, t, 1e-12);
      }
    }
  }
}

TEST(PatchAlbedo, AnotherPictureIsAnotherSolution) {
  const auto digest = [](const scenes::Scene& scene) {
    const scenes::LightGroups groups = scenes::find_light_groups(scene);
    std::string all;
    for (const ScenePart& part : scene_parts(scene, groups)) {
      all += std::to_string(part.digest) + " ";
    }
    return all;
  };
  EXPECT_EQ(digest(textured_square(true)), digest(textured_square(true)));
  scenes::Scene moved = textured_square(true);
  moved.vertex_uv[0].x = 0.25F;
  EXPECT_NE(digest(textured_square(true)), digest(moved));
  scenes::Scene other = textured_square(true, 254);
  other.materials[0].diffuse = textured_square(true).materials[0].diffuse;
  EXPECT_NE(digest(textured_square(true)), digest(other));
}

}  // namespace
}  // namespace earthshine::radiosity
