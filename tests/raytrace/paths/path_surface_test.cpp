// SPDX-License-Identifier: Apache-2.0
// Surfaces in the path tracer against closed forms: mirrors, glass, the Phong lobe, black backs.
#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/paths/path_tracer.h"
#include "tests/raytrace/path_picture.h"

namespace earthshine::raytrace {
namespace {

TEST(PathTracer, FurnaceWithGlossMirrorAndGlassIsStillUniform) {
  // Walls of rho = 0.8 and M = 0.2: radiance 1 / pi everywhere. A perfect mirror and a clear pane
  // return all light, and so does a solid block of glass, by refraction and total reflection.
  tests::SceneBuilder builder;
  const std::uint32_t wall = builder.material(tests::grey(0.8, 0.2));
  scenes::Material mirror = tests::grey(0.0);
  mirror.mirror = Rgb(1.0);
  const std::uint32_t silver = builder.material(mirror);
  scenes::Material clear = tests::grey(0.0);
  clear.mirror = Rgb(0.1);
  clear.transmit = Rgb(0.9);
  clear.ior = 1.5;
  const std::uint32_t block = builder.material(clear);
  clear.two_sided = true;
  const std::uint32_t pane = builder.material(clear);
  builder.room({wall, wall, silver, wall, wall, wall});
  builder.quad(pane, {0.6, 0.1, 0.1}, {0.6, 0.9, 0.1}, {0.6, 0.9, 0.9}, {0.6, 0.1, 0.9});
  builder.room({block, block, block, block, block, block});  // seen from inside: inverted below
  for (std::size_t t = builder.scene.triangles.size() - 12; t < builder.scene.triangles.size();
       ++t) {
    std::swap(builder.scene.triangles[t].vertex[1], builder.scene.triangles[t].vertex[2]);
  }
  for (std::size_t v = builder.scene.vertices.size() - 24; v < builder.scene.vertices.size(); ++v) {
    builder.scene.vertices[v] = Vec3(0.3, 0.2, 0.2) + 0.2 * builder.scene.vertices[v];
  }
  const Frame frame = picture(builder.scene, inside_room(), pixels(16, 64));
  expect_mean(frame, 1.0 / base::pi);
  EXPECT_GT(frame.report.rays.mirror, 16U * 16U * 64U / 4);
}

TEST(PathTracer, PathsBetweenPerfectMirrorsEnd) {
  // A closed room without losses and without light: black, and finished.
  tests::SceneBuilder builder;
  scenes::Material mirror = tests::grey(0.0);
  mirror.mirror = Rgb(1.0);
  const std::uint32_t m = builder.material(mirror);
  builder.room({m, m, m, m, m, m});
  EXPECT_EQ(estimate(picture(builder.scene, inside_room(), pixels(1, 2))).mean, 0.0);
}

TEST(PathTracer, MirrorShowsTheLampAndTheSunTimesItsReflectance) {
  tests::SceneBuilder builder;
  scenes::Material mirror = tests::grey(0.0);
  mirror.mirror = Rgb(0.9);
  builder.plate(builder.material(mirror), 1.0, 0.0, true);
  builder.scene.lamps.push_back(panel(1.0, 5.0));
  EXPECT_NEAR(estimate(picture(builder.scene, above(2.0), pixels(2, 4))).mean,
              0.9 * 100.0 / base::pi, 1e-4);
  builder.scene.lamps.clear();
  builder.scene.sun = sun_at(0.0);
  // A disc of radius a has radiance E / (pi sin^2 a).
  const double sine = std::sin(base::radians(0.2666));
  const double sun_radiance = 133100.0 / (base::pi * sine * sine);
  EXPECT_NEAR(estimate(picture(builder.scene, above(2.0), pixels(2, 4))).mean / sun_radiance, 0.9,
              1e-5);
}

TEST(PathTracer, GlassSlabLetsThroughTheSquareOfItsShareAndWhatRunsToAndFro) {
  // Shares t and r at each of two faces, seen along the normal, in front of an emitting plate of
  // radiance L: T = t^2 (1 + r^2 + r^4 + ...) = t^2 / (1 - r^2). Reflected rays see the black sky.
  tests::SceneBuilder builder;
  scenes::Material glass = tests::grey(0.0);
  glass.transmit = Rgb(0.7);
  glass.mirror = Rgb(0.2);
  glass.ior = 1.5;
  const std::uint32_t m = builder.material(glass);
  builder.plate(m, 1.0, 1.0, true);
  builder.plate(m, 1.0, 0.9, false);
  builder.plate(builder.material(tests::grey(0.0, 100.0)), 10.0, 0.0, true);
  expect_mean(picture(builder.scene, above(2.0), pixels(8, 256)),
              100.0 / base::pi * 0.49 / (1.0 - 0.04));
}

TEST(PathTracer, GlassBendsBySnellsLaw) {
  // A ray enters a slab of 0.1 m at 45 deg. It leaves the slab shifted along the surface by 0.1
  // (tan 45 - tan asin(sin 45 / 1.5)) and hits the plate under the slab, 0.3 m deep in all, beside
  // the edge between a bright and a dark half, which it would miss without refraction.
  const double inside = std::asin(std::sin(base::pi / 4) / 1.5);
  const double shift = 0.1 * (1.0 - std::tan(inside));
  for (const double side : {-1.0, 1.0}) {
    tests::SceneBuilder builder;
    scenes::Material glass = tests::grey(0.0);
    glass.transmit = Rgb(1.0);
    glass.ior = 1.5;
    const std::uint32_t m = builder.material(glass);
    builder.plate(m, 1.0, 0.3, true);
    builder.plate(m, 1.0, 0.2, false);
    // Without refraction the axis meets z = 0 at x = 0, with it at x = -shift. Bright beyond an
    // edge 1 % of the shift away.
    const double edge = -shift * (1.0 + 0.01 * side);
    const std::uint32_t bright = builder.material(tests::grey(0.0, 100.0));
    builder.quad(bright, {edge, -1, 0}, {edge + 2, -1, 0}, {edge + 2, 1, 0}, {edge, 1, 0});
    scenes::Camera camera = above(1.0);
    camera.position = Vec3(-1, 0, 1);
    camera.fov_deg = 0.001;
    const double seen = estimate(picture(builder.scene, camera, pixels(2, 8))).mean;
    EXPECT_NEAR(seen, side > 0.0 ? 100.0 / base::pi : 0.0, 1e-4);
  }
}

TEST(PathTracer, PhongLobeReflectsItsEnergyBound) {
  // Seen along the normal in uniform surroundings, pi L = k_d + 2 k_s / (n + 2) per unit.
  for (const double n : {1.0, 10.0, 400.0}) {
    tests::SceneBuilder builder;
    const std::uint32_t wall = builder.material(tests::grey(0.7, 0.3));
    builder.room({wall, wall, wall, wall, wall, wall});
    for (Vec3& p : builder.scene.vertices) p = 20.0 * (p - Vec3(0.5));
    scenes::Material glossy = tests::grey(0.2);
    glossy.specular = Rgb(0.3 * (n + 2.0));  // 0.6 in the lobe
    glossy.shininess = n;
    builder.plate(builder.material(glossy), 0.01, 0.0, true);
    expect_mean(picture(builder.scene, above(2.0), pixels(8, 256)), 0.8 / base::pi);
  }
}

TEST(PathTracer, HighlightFallsWithTheCosinesPower) {
  // Sun 20 deg off the normal, camera on the normal: pi L / (E cos) = k_d + k_s cos^n(20 deg). The
  // Sun's disc of 0.27 deg changes it by about n^2 (0.0047)^2 / 8 = 4e-4.
  tests::SceneBuilder builder;
  scenes::Material glossy = tests::grey(0.3);
  glossy.specular = Rgb(0.6);
  glossy.shininess = 12.0;
  builder.plate(builder.material(glossy), 1.0, 0.0, true);
  builder.scene.sun = sun_at(20.0);
  const double c = std::cos(base::radians(20.0));
  const double exact = 133100.0 * c / base::pi * (0.3 + 0.6 * std::pow(c, 12.0));
  const PictureMean e = estimate(picture(builder.scene, above(2.0), pixels(8, 64)));
  EXPECT_NEAR(e.mean / exact, 1.0, 4.0 * e.std_error / exact + 1e-3);
}

TEST(PathTracer, BlackBacksOfOneSidedSurfacesAndBothSidesOfSheets) {
  for (const bool two_sided : {false, true}) {
    tests::SceneBuilder builder;
    scenes::Material material = tests::grey(0.5);
    material.two_sided = two_sided;
    builder.plate(builder.material(material), 1.0, 0.0, false);
    builder.scene.sun = sun_at(60.0);
    const double seen = estimate(picture(builder.scene, above(2.0), pixels(2, 8))).mean;
    EXPECT_NEAR(seen, two_sided ? 0.5 * 133100.0 * 0.5 / base::pi : 0.0, 1e-3 * seen);
  }
}

TEST(PathTracer, WhatAFlatMirrorThrowsComesOnce) {
  // A mirror facing a plate reflects the light of a panel that does not light the plate directly:
  // unfolded, the panel's image is 3 m above the visible point. E = rho_m M F. Shadow rays carry
  // this light, so that paths that hit the panel by the mirror must not.
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 0.1, 0.0, true);
  scenes::Material mirror = tests::grey(0.0);
  mirror.mirror = Rgb(0.9);
  builder.plate(builder.material(mirror), 20.0, 2.0, false);
  scenes::Lamp lamp = panel(2.0, 1.0);
  lamp.axis = Vec3(0, 0, 1);
  std::swap(lamp.edge_u, lamp.edge_v);
  builder.scene.lamps.push_back(lamp);
  PathOptions options = pixels(8, 256);
  const double x = 1.0 / std::sqrt(10.0);
  const double form_factor = 4.0 / base::pi * x * std::atan(x);
  for (const PathSet paths : {PathSet::All, PathSet::NoCaustics}) {
    options.paths = paths;
    expect_mean(picture(builder.scene, above(0.5), options),
                0.5 * 0.9 * 100.0 / base::pi * form_factor);
  }
}

TEST(PathTracer, CausticsAreLeftOutOfTheGatheredPaths) {
  // A plate of glass that bends light, 1 mm thick: it displaces the panel's image by 0.3 mm,
  // absorbs 1 - 0.9^2 of its light, and blocks shadow rays. E = 0.81 M F with the panel at 3 m.
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 0.1, 0.0, true);
  scenes::Material glass = tests::grey(0.0);
  glass.transmit = Rgb(0.9);
  glass.ior = 1.5;
  builder.plate(builder.material(glass), 20.0, 1.0, false);
  builder.plate(1, 20.0, 1.001, true);
  builder.scene.lamps.push_back(panel(2.0, 3.0));
  PathOptions options = pixels(8, 256);
  const double x = 1.0 / std::sqrt(10.0);
  const double form_factor = 4.0 / base::pi * x * std::atan(x);
  expect_mean(picture(builder.scene, above(0.5), options),
              0.5 * 0.81 * 100.0 / base::pi * form_factor);
  options.paths = PathSet::NoCaustics;
  EXPECT_EQ(estimate(picture(builder.scene, above(0.5), options)).mean, 0.0);
}

// Light by lobes is no caustic: shadow rays carry it, or paths in both sets. Hence without mirrors
// and glass the sets are the same, path by path.
TEST(PathTracer, LobesThrowNoCaustics) {
  tests::SceneBuilder builder;
  scenes::Material glossy = tests::grey(0.4);
  glossy.specular = Rgb(0.5);
  glossy.shininess = 200.0;
  builder.plate(builder.material(glossy), 2.0, 0.0, true);
  builder.plate(builder.material(glossy), 2.0, 1.0, false);
  builder.plate(builder.material(tests::grey(0.3, 50.0)), 0.2, 0.9, false);
  builder.scene.lamps.push_back(panel(2.0, 0.5));
  PathOptions options = pixels(8, 64);
  const Frame all = picture(builder.scene, above(0.5), options);
  EXPECT_GT(estimate(all).mean, 0.0);
  options.paths = PathSet::NoCaustics;
  const Frame gathered = picture(builder.scene, above(0.5), options);
  EXPECT_EQ(all.image.find("R")->values, gathered.image.find("R")->values);
}

}  // namespace
}  // namespace earthshine::raytrace
