// SPDX-License-Identifier: Apache-2.0
// Plates seen from straight above: scenes with known results of the studies.
#pragma once

#include <cmath>

#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace earthshine::tests {

// At `height_m` above the origin, looking down; its picture spans `size_m` at z = 0.
inline scenes::Camera above(double height_m, double size_m) {
  scenes::Camera camera;
  camera.name = "above";
  camera.position = Vec3(0, 0, height_m);
  camera.look_at = Vec3(0.0);
  camera.up = Vec3(0, 1, 0);
  camera.fov_deg = base::degrees(2.0 * std::atan(size_m / 2 / height_m));
  return camera;
}

// A point Sun at the zenith.
inline scenes::Sun overhead_sun(double illuminance_lx) {
  scenes::Sun sun;
  sun.direction = Vec3(0, 0, 1);
  sun.illuminance_lx = Rgb(illuminance_lx);
  sun.angular_radius_deg = 0.0;
  return sun;
}

// Ground 4 m wide at z = -0.01 and on it, at z = 0, a target plate 1 m wide: objects 0 and 1.
inline SceneBuilder plate_on_ground(double ground_diffuse, double plate_diffuse) {
  SceneBuilder builder;
  builder.plate(builder.material(grey(ground_diffuse)), 4.0, -0.01, true);
  builder.plate(builder.material(grey(plate_diffuse)), 1.0, 0.0, true);
  builder.scene.objects[1].target = true;
  return builder;
}

// A plate of reflectance 0.5 under 1000 lx, with 500 / pi cd/m2, on black ground; 2 m seen from 10
// m in 16 pixels. In front of the centre of a pixel a lamp shines at the camera, 2000 times
// brighter, and lights nothing.
inline scenes::Scene plate_behind_a_speck(double radius_m) {
  SceneBuilder builder = plate_on_ground(0.0, 0.5);
  builder.scene.sun = overhead_sun(1000.0);
  scenes::Lamp lamp;
  lamp.name = lamp.group = "speck";
  lamp.kind = scenes::LampKind::Disk;
  lamp.position = Vec3(0.0625, 0.0625, 0.1);
  lamp.axis = Vec3(0, 0, 1);
  lamp.radius_m = radius_m;
  lamp.exitance = Rgb(1e6);
  builder.scene.lamps.push_back(lamp);
  return builder.scene;
}

// Direct light only, with the layer "object".
inline raytrace::Frame direct_picture(const scenes::Scene& scene, const scenes::Camera& camera,
                                      int size) {
  const Prepared prepared(scene);
  raytrace::RenderOptions options;
  options.columns = options.rows = size;
  options.gather_rays = 16;
  options.indirect = raytrace::Indirect::None;
  options.aovs = {"object"};
  return raytrace::render(prepared, {}, camera, options);
}

}  // namespace earthshine::tests
