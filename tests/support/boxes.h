// SPDX-License-Identifier: Apache-2.0
// A cube seen from inside with boxes in it, divided into patches of given size.
#pragma once

#include "radiosity/patches/patches.h"
#include "tests/support/scene_builder.h"

namespace earthshine::tests {

struct CutScene {
  scenes::Scene scene;
  radiosity::Patches patches;
};

// The box low..high seen from outside: six quads.
inline void add_box(SceneBuilder& builder, std::uint32_t material, const Vec3& low,
                    const Vec3& high) {
  const auto p = [&](int x, int y, int z) {
    return Vec3(x != 0 ? high.x : low.x, y != 0 ? high.y : low.y, z != 0 ? high.z : low.z);
  };
  builder.quad(material, p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0));
  builder.quad(material, p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1));
  builder.quad(material, p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
  builder.quad(material, p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0));
  builder.quad(material, p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0));
  builder.quad(material, p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
}

// Patches of a scene with count(facet) x count(facet) cells per facet.
template <class Count>
radiosity::Patches cut_facets(const scenes::Scene& scene, Count count) {
  radiosity::Patches patches = radiosity::subdivide(scene, 1e9);
  patches.area_m2.clear();
  patches.facet.clear();
  patches.cell.clear();
  patches.is_back.clear();
  for (std::uint32_t f = 0; f < patches.facets.size(); ++f) {
    radiosity::Facet& facet = patches.facets[f];
    const std::uint32_t n = count(f);
    facet.s_count = facet.t_count = n;
    facet.leaves = n * n;
    facet.first_front = static_cast<std::uint32_t>(patches.count());
    for (std::uint32_t c = 0; c < n * n; ++c) {
      patches.area_m2.push_back(facet.area_m2 / (double(n) * n));
      patches.facet.push_back(f);
      patches.cell.push_back({c / n, c % n});
      patches.is_back.push_back(0);
    }
  }
  return patches;
}

// The cube [0,1]^3, n x n patches per face, and the box [.35,.65]^3, n/4 x n/4 per face.
inline CutScene cube_and_box(std::uint32_t n) {
  SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.room({m, m, m, m, m, m});
  add_box(builder, m, Vec3(0.35), Vec3(0.65));
  return {builder.scene,
          cut_facets(builder.scene, [n](std::uint32_t f) { return f < 6 ? n : n / 4; })};
}

// The same cube with k x k x k boxes in a lattice, each half as wide as the spacing, one patch per
// face.
inline CutScene cube_and_boxes(std::uint32_t n, int k) {
  SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.5));
  builder.room({m, m, m, m, m, m});
  for (int box = 0; box < k * k * k; ++box) {
    const Vec3 middle = (Vec3(box % k, box / k % k, box / (k * k)) + 0.5) / double(k);
    add_box(builder, m, middle - 0.25 / k, middle + 0.25 / k);
  }
  return {builder.scene,
          cut_facets(builder.scene, [n](std::uint32_t f) { return f < 6 ? n : 1U; })};
}

}  // namespace earthshine::tests
