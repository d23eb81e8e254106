// SPDX-License-Identifier: Apache-2.0
// A long hall with many lamps of different intensity and crates that occlude some of them.
#pragma once

#include <cmath>
#include <cstddef>

#include "base/numbers/random.h"
#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace earthshine {

inline void add_quad(scenes::Scene& scene, const Vec3& a, const Vec3& b, const Vec3& c,
                     const Vec3& d) {
  const auto v = static_cast<std::uint32_t>(scene.vertices.size());
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  scenes::Object record;
  record.name = "quad-" + std::to_string(object);
  record.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
  record.triangle_count = 2;
  scene.objects.push_back(record);
  scene.vertices.insert(scene.vertices.end(), {a, b, c, d});
  scene.triangles.push_back({{v, v + 1, v + 2}, object, 0, object});
  scene.triangles.push_back({{v, v + 2, v + 3}, object, 0, object});
}

// 60 m x 5 m, with lamps 4 m above the floor and crates 1 m high.
inline scenes::Scene hall_of_lamps(std::size_t count) {
  scenes::Scene scene;
  scenes::Material grey;
  grey.name = "grey";
  grey.diffuse = Rgb(0.5);
  grey.two_sided = true;
  scene.materials.push_back(grey);
  add_quad(scene, {-30, -2.5, 0}, {30, -2.5, 0}, {30, 2.5, 0}, {-30, 2.5, 0});
  for (int k = 0; k < 20; ++k) {
    const double x = -28.5 + 3.0 * k, y = k % 2 == 0 ? -1.0 : 0.5;
    add_quad(scene, {x, y, 1}, {x + 1, y, 1}, {x + 1, y + 1, 1}, {x, y + 1, 1});
    add_quad(scene, {x, y, 0}, {x, y + 1, 0}, {x, y + 1, 1}, {x, y, 1});
    add_quad(scene, {x + 1, y, 0}, {x + 1, y, 1}, {x + 1, y + 1, 1}, {x + 1, y + 1, 0});
  }
  base::Rng rng(base::Key(1, base::Stream::Test, count));
  for (std::size_t k = 0; k < count; ++k) {
    scenes::Lamp lamp;
    lamp.name = "lamp-" + std::to_string(k);
    lamp.group = "lamps";
    lamp.kind = k % 2 == 0 ? scenes::LampKind::Spot : scenes::LampKind::Rectangle;
    const double x = rng.next(), y = rng.next();
    lamp.position = Vec3(60.0 * (x - 0.5), 5.0 * (y - 0.5), 4.0);
    lamp.axis = Vec3(0, 0, -1);
    lamp.beam_deg = 60.0;
    lamp.field_deg = 140.0;
    lamp.edge_u = Vec3(0, 0.2, 0);
    lamp.edge_v = Vec3(0.2, 0, 0);
    const double strength = std::exp(2.0 * rng.next()) * 4096.0 / static_cast<double>(count);
    if (lamp.kind == scenes::LampKind::Spot) lamp.intensity_cd = Rgb(strength);
    if (lamp.kind == scenes::LampKind::Rectangle) lamp.exitance = Rgb(strength * base::pi / 0.04);
    scene.lamps.push_back(lamp);
  }
  scenes::Camera camera;
  camera.name = "A";
  camera.position = Vec3(-29, 0, 3);
  camera.look_at = Vec3(0, 0, 0);
  camera.fov_deg = 60.0;
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace earthshine
