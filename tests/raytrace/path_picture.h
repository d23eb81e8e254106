// SPDX-License-Identifier: Apache-2.0
// Small pictures of the path tracer, tested within their own variance.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/paths/path_tracer.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {

// Straight above the origin, seeing a spot of 2 mm there.
inline scenes::Camera above(double height_m) {
  scenes::Camera camera;
  camera.position = Vec3(0, 0, height_m);
  camera.look_at = Vec3(0.0);
  camera.up = Vec3(0, 1, 0);
  camera.fov_deg = base::degrees(2.0 * std::atan(0.001 / height_m));
  return camera;
}

inline scenes::Camera inside_room() {
  scenes::Camera camera;
  camera.position = Vec3(0.1, 0.4, 0.5);
  camera.look_at = Vec3(1, 0.3, 0.3);
  camera.fov_deg = 90.0;
  return camera;
}

inline Frame picture(const scenes::Scene& scene, const scenes::Camera& camera,
                     const PathOptions& options) {
  const tests::Prepared prepared(scene);
  return trace_paths(prepared, camera, options);
}

inline PathOptions pixels(int edge, int paths) {
  PathOptions options;
  options.columns = options.rows = edge;
  options.paths_per_pixel = paths;
  return options;
}

// Mean of green and its standard error, from the picture's own variance (grey scenes: Y = G).
struct PictureMean {
  double mean = 0.0, std_error = 0.0;
};
inline PictureMean estimate(const Frame& frame) {
  PictureMean e;
  double variance = 0.0;
  for (const float v : frame.image.find("G")->values) e.mean += double(v);
  for (const float v : frame.image.find("variance")->values) variance += double(v);
  const auto n = static_cast<double>(frame.image.pixel_count());
  e.mean /= n;
  e.std_error = std::sqrt(variance) / n;
  return e;
}

// Within four standard errors, plus the rounding of float pixels.
inline void expect_mean(const Frame& frame, double exact) {
  const PictureMean e = estimate(frame);
  EXPECT_NEAR(e.mean, exact, 4.0 * e.std_error + 1e-6 * exact) << "+- " << e.std_error;
}

inline scenes::Sun sun_at(double zenith_deg) {
  scenes::Sun sun;
  sun.direction = Vec3(std::sin(base::radians(zenith_deg)), 0, std::cos(base::radians(zenith_deg)));
  return sun;
}

inline scenes::Earth uniform_earth(double half_angle_deg) {
  scenes::Earth earth;
  earth.half_angle_deg = half_angle_deg;
  earth.model = scenes::EarthModel::Uniform;
  earth.radiance = Rgb(1000.0);
  return earth;
}

inline scenes::Lamp panel(double edge_m, double height_m) {
  scenes::Lamp lamp;
  lamp.name = lamp.group = "panel";
  lamp.kind = scenes::LampKind::Rectangle;
  lamp.position = Vec3(0, 0, height_m);
  lamp.edge_u = Vec3(0, edge_m, 0);
  lamp.edge_v = Vec3(edge_m, 0, 0);
  lamp.axis = Vec3(0, 0, -1);
  lamp.exitance = Rgb(100.0);
  return lamp;
}

// Of glass that does not bend light.
inline scenes::Material sheet(double diffuse, double mirror, double transmit) {
  scenes::Material pane = tests::grey(diffuse);
  pane.two_sided = true;
  pane.mirror = Rgb(mirror);
  pane.transmit = Rgb(transmit);
  return pane;
}

}  // namespace earthshine::raytrace
