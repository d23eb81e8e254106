// SPDX-License-Identifier: Apache-2.0
// A floor of 4 mm at the origin under lamps, glass and mirrors; everything else is black. Its
// illuminance by patches, camera samples and the path tracer.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "raytrace/render.h"
#include "tests/raytrace/path_picture.h"

namespace earthshine::raytrace::lit_floor {

inline constexpr double rho = 0.5;

inline scenes::Lamp point_lamp(const Vec3& position, double candela) {
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = position;
  lamp.intensity_cd = Rgb(candela);
  return lamp;
}

inline scenes::Material glass(double through, double ior, bool two_sided) {
  scenes::Material material = tests::grey(0.0);
  material.transmit = Rgb(through);
  material.ior = ior;
  material.two_sided = two_sided;
  return material;
}

inline scenes::Material mirror(double share) {
  scenes::Material material = tests::grey(0.0);
  material.mirror = Rgb(share);
  return material;
}

class Floor : public tests::SceneBuilder {
 public:
  Floor() { plate(material(tests::grey(rho)), 4e-3, 0.0, true); }

  // In the plane x = -1, facing the floor.
  void upright_mirror(double share, double height_m, double half_width_m = 20.0) {
    quad(material(mirror(share)), {-1, -half_width_m, 0}, {-1, half_width_m, 0},
         {-1, half_width_m, height_m}, {-1, -half_width_m, height_m});
  }
  // A black sheet in the plane x = -0.5.
  void sheet(double low_m, double high_m) {
    scenes::Material black = tests::grey(0.0);
    black.two_sided = true;
    quad(material(black), {-0.5, -0.5, low_m}, {-0.5, 0.5, low_m}, {-0.5, 0.5, high_m},
         {-0.5, -0.5, high_m});
  }
};

// Illuminance of the floor by each method. `solved` is from the patch's samples, without the scale
// that closes the source's flux, which is 1 within its noise.
struct Found {
  double solved = 0.0, scale = 1.0, drawn = 0.0, traced = 0.0, std_error = 0.0;
};

inline Found find(const scenes::Scene& scene, double camera_height_m = 0.5) {
  const tests::Prepared prepared(scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 100.0;
  const radiosity::Solution solution = prepared.solve(solve);
  Found found;
  if (!solution.report.sources.empty()) found.scale = solution.report.sources[0].scale;
  found.solved = solution.report.objects[0].illuminance_lx.g / found.scale;
  RenderOptions options;
  options.columns = options.rows = 4;
  options.indirect = Indirect::None;
  const scenes::Camera camera = above(camera_height_m);
  const base::Image image = render(prepared, solution, camera, options).image;
  for (const float g : image.find("G")->values) found.drawn += double(g) * base::pi / rho / 16.0;
  const PictureMean paths = estimate(trace_paths(prepared, camera, pixels(4, 256)));
  found.traced = paths.mean * base::pi / rho;
  found.std_error = paths.std_error * base::pi / rho;
  return found;
}

// The light varies by 2e-3 or less over the 4 mm, which the sets of points average to 1e-3; wide
// sources add noise of `noise` relative to the light.
inline void expect_all(const Found& found, double exact, double noise = 0.0) {
  const double slack = (1e-3 + noise) * exact + 1e-9;
  EXPECT_NEAR(found.solved, exact, slack);
  EXPECT_NEAR(found.drawn, exact, slack);
  EXPECT_NEAR(found.traced, exact, slack + 4.0 * found.std_error);
}

inline double from_point(const Vec3& lamp, double candela) {
  return candela * lamp.z / std::pow(glm::length(lamp), 3);
}

}  // namespace earthshine::raytrace::lit_floor
