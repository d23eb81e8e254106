// SPDX-License-Identifier: Apache-2.0
// Scenes, places and pictures for tests of a light basis' weighted sums.
#pragma once

#include <cmath>

#include "raytrace/render.h"
#include "scenes/sky/orbit.h"
#include "studies/light/light_basis.h"
#include "tests/studies/plates.h"
#include "tests/support/scene_builder.h"

namespace earthshine::tests {

inline scenes::Lamp point_lamp(const std::string& name, const std::string& group,
                               const Vec3& position, const Rgb& intensity) {
  scenes::Lamp lamp;
  lamp.name = name;
  lamp.group = group;
  lamp.position = position;
  lamp.intensity_cd = intensity;
  return lamp;
}

// A room without a ceiling with a plate in it (object 5, a target): a disk "spot" with its own
// group, lamps "left" and "right" of the group "bay", and an emitting wall of the group "panels".
// The random numbers of a lamp depend on the number of shining lamps before it in the list. Hence
// lamps that keep their numbers when another fails come first.
inline scenes::Scene open_room() {
  SceneBuilder builder;
  scenes::Material red = grey(0.5);
  red.diffuse = Rgb(0.6, 0.3, 0.2);
  const std::uint32_t m = builder.material(grey(0.6)), r = builder.material(red);
  const std::uint32_t panel = builder.material(grey(0.3, 20.0));
  builder.quad(r, {0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1});
  builder.quad(m, {1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0});
  builder.quad(m, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});
  builder.quad(panel, {0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1});
  builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  builder.quad(r, {0.3, 0.3, 0.2}, {0.6, 0.3, 0.2}, {0.6, 0.6, 0.2}, {0.3, 0.6, 0.2});
  builder.scene.objects[5].target = true;
  builder.scene.lamps = {point_lamp("spot", "spot", {0.5, 0.2, 0.9}, Rgb(0.0)),
                         point_lamp("left", "bay", {0.2, 0.5, 0.8}, {30, 20, 10}),
                         point_lamp("right", "bay", {0.8, 0.5, 0.8}, Rgb(25.0))};
  scenes::Lamp& spot = builder.scene.lamps.front();
  spot.kind = scenes::LampKind::Disk;
  spot.axis = Vec3(0, 0, -1);
  spot.radius_m = 0.1;
  spot.exitance = Rgb(500.0);
  return builder.scene;
}

inline scenes::Camera into_the_room() {
  scenes::Camera camera;
  camera.name = "high";
  camera.position = Vec3(0.9, 0.1, 1.2);
  camera.look_at = Vec3(0.4, 0.5, 0.2);
  camera.fov_deg = 50.0;
  return camera;
}

// Even patches, a converged solver, no denoising: the same rays for any lights.
inline raytrace::Frame same_rays(const scenes::Scene& scene, const scenes::LightGroups& groups,
                                 const scenes::Camera& camera, bool per_light) {
  scenes::Asked asked;
  asked.per_light = per_light;
  const scenes::Effects effects = scenes::find_effects(scene, groups, asked);
  const scenes::RayQuery query(scene);
  radiosity::SolveOptions solver;
  solver.patch_edge_m = 0.25;
  solver.form_factor_rays = 256;
  solver.tolerance = 1e-13;
  raytrace::RenderOptions options;
  options.columns = options.rows = 16;
  options.gather_rays = 64;
  options.denoise = false;
  options.per_light = per_light;
  options.aovs = {"object"};
  return raytrace::render({scene, groups, effects, query},
                          radiosity::solve({scene, groups, effects, query}, solver), camera,
                          options);
}
inline raytrace::Frame same_rays(const scenes::Scene& scene, const scenes::Camera& camera) {
  return same_rays(scene, scenes::find_light_groups(scene), camera, false);
}
inline raytrace::Frame basis_picture(const studies::LightBasis& basis,
                                     const scenes::Camera& camera) {
  return same_rays(basis.scene(), basis.groups(), camera, true);
}

// Sun and Earth along an orbit at 425 km in the plane of the sunlight; a point Sun, so that
// pictures have the same rays with and without the others.
inline std::vector<studies::SkyPlace> orbit_places(const std::vector<double>& positions_deg,
                                                   scenes::EarthModel model,
                                                   const std::string& attitude = "bay-to-earth",
                                                   double sun_radius_deg = 0.0) {
  scenes::Scene sky;
  sky.orbit.emplace();
  sky.orbit->altitude_m = 425e3;
  sky.orbit->attitude = attitude;
  sky.sun.emplace();
  sky.sun->angular_radius_deg = sun_radius_deg;
  sky.earth.emplace();
  sky.earth->altitude_m = 425e3;
  sky.earth->half_angle_deg =
      base::degrees(std::asin(base::earth_radius_m / (base::earth_radius_m + 425e3)));
  sky.earth->model = model;
  sky.earth->radiance = Rgb(5000.0);
  std::vector<studies::SkyPlace> places;
  for (const double position : positions_deg) {
    scenes::move_along_orbit(sky, position);
    places.push_back(studies::sky_of(sky));
  }
  return places;
}

}  // namespace earthshine::tests
