// SPDX-License-Identifier: Apache-2.0
// A small room with fast pictures.
#pragma once

#include "radiosity/solution.h"
#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace earthshine::tests {

// A grey room with a block on its floor, lit by a bright wall and a lamp. Object 6, the block, is a
// target.
struct SmallRoom {
  scenes::Scene scene = made();
  scenes::Camera camera = corner();
  Prepared prepared{scene};
  radiosity::SolveOptions solver = coarse();
  radiosity::Solution solution = prepared.solve(solver);

  [[nodiscard]] scenes::World study() const { return prepared; }
  [[nodiscard]] raytrace::Frame picture(const raytrace::RenderOptions& options) const {
    return raytrace::render(prepared, solution, camera, options);
  }

  static scenes::Scene made() {
    SceneBuilder builder;
    const std::uint32_t m = builder.material(grey(0.5)), bright = builder.material(grey(0.5, 50.0));
    builder.room({bright, m, m, m, m, m});
    builder.quad(m, {0.3, 0.3, 0.2}, {0.6, 0.3, 0.2}, {0.6, 0.6, 0.2}, {0.3, 0.6, 0.2});
    builder.scene.objects[6].name = "block";
    builder.scene.objects[6].target = true;
    scenes::Lamp lamp;
    lamp.name = lamp.group = "lamp";
    lamp.kind = scenes::LampKind::Disk;
    lamp.position = Vec3(0.5, 0.5, 0.95);
    lamp.axis = Vec3(0, 0, -1);
    lamp.radius_m = 0.15;
    lamp.exitance = Rgb(2000.0);
    builder.scene.lamps.push_back(lamp);
    return builder.scene;
  }
  static scenes::Camera corner() {
    scenes::Camera camera;
    camera.name = "corner";
    camera.position = Vec3(0.95, 0.9, 0.6);
    camera.look_at = Vec3(0.4, 0.45, 0.2);
    camera.fov_deg = 60.0;
    return camera;
  }
  static radiosity::SolveOptions coarse() {
    radiosity::SolveOptions options;
    options.patch_edge_m = 0.2;
    options.form_factor_rays = 512;
    return options;
  }
};

inline const SmallRoom& small_room() {
  static const SmallRoom room;
  return room;
}

}  // namespace earthshine::tests
