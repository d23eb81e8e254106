// SPDX-License-Identifier: Apache-2.0
// Illuminance of small plates by every source, with shadows, in solutions and pictures, against
// closed forms. Means over seeds within four standard errors.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace earthshine {
namespace {

using base::pi;

struct Estimate {
  double mean = 0.0, std_error = 0.0;
};

Estimate over_seeds(int seeds, const std::function<double(std::uint64_t)>& value) {
  std::vector<double> values;
  Estimate estimate;
  for (int seed = 1; seed <= seeds; ++seed) {
    values.push_back(value(static_cast<std::uint64_t>(seed)));
    estimate.mean += values.back() / seeds;
  }
  double variance = 0.0;
  for (const double v : values) variance += (v - estimate.mean) * (v - estimate.mean);
  estimate.std_error = std::sqrt(variance / (seeds - 1) / seeds);
  return estimate;
}

// A white plate of 0.1 mm at the origin, facing up: its radiance is E / pi.
struct PlateScene : tests::SceneBuilder {
  std::uint32_t black;
  PlateScene() {
    const std::uint32_t white = material(tests::grey(1.0));
    scenes::Material dark = tests::grey(0.0);
    dark.two_sided = true;
    black = material(dark);
    plate(white, 1e-4, 0.0, true);
  }
};

// By the solution: the mean over the plate.
Estimate solved(const scenes::Scene& scene, int seeds = 16) {
  const tests::Prepared prepared(scene);
  radiosity::SolveOptions options;
  options.patch_edge_m = 1e3;
  options.form_factor_rays = 1024;
  return over_seeds(seeds, [&](std::uint64_t seed) {
    options.seed = seed;
    return prepared.solve(options).report.objects[0].illuminance_lx.g;
  });
}

// By a picture: four pixels on the plate, from a camera 1 cm above.
Estimate pictured(const scenes::Scene& scene, int seeds = 16) {
  const tests::Prepared prepared(scene);
  scenes::Camera camera;
  camera.position = Vec3(0, 0, 0.01);
  camera.look_at = Vec3(0.0);
  camera.up = Vec3(0, 1, 0);
  camera.fov_deg = 0.1;
  raytrace::RenderOptions options;
  options.columns = options.rows = 2;
  options.indirect = raytrace::Indirect::None;
  options.gather_rays = 256;
  return over_seeds(seeds, [&](std::uint64_t seed) {
    options.seed = seed;
    const auto frame = raytrace::render(prepared, {}, camera, options);
    double sum = 0.0;
    for (const float v : frame.image.find("G")->values) sum += pi * double(v) / 4.0;
    return sum;
  });
}

void expect_both(const scenes::Scene& scene, double exact, double most_relative_error) {
  for (const Estimate& e : {solved(scene), pictured(scene)}) {
    // The minimum covers rounding: some cases are exact, without noise.
    EXPECT_NEAR(e.mean, exact, 4.0 * e.std_error + 1e-5 * exact);
    EXPECT_LT(e.std_error, most_relative_error * exact + 1e-12);
  }
}

scenes::Earth uniform_earth(double half_angle_deg) {
  scenes::Earth earth;
  earth.half_angle_deg = half_angle_deg;
  earth.model = scenes::EarthModel::Uniform;
  earth.radiance = Rgb(1000.0);
  return earth;
}

// Area of a disc beyond a chord at x radii from its centre, relative to the disc.
double beyond_chord(double x) { return 0.5 - (x * std::sqrt(1.0 - x * x) + std::asin(x)) / pi; }

TEST(Plates, SunsPenumbraBehindAStraightEdgeIsADiscCutByAChord) {
  // A screen over x < edge at 2 m: the edge is x radii of the Sun from its centre, where
  // x = edge / (2 m tan r). The disc is small: chord and circle are plane to 1e-5.
  const double radius = base::radians(0.2666), reach = 2.0 * std::tan(radius);
  for (const double x : {-0.9, -0.5, 0.0, 0.3, 0.8}) {
    PlateScene plate;
    const double edge = x * reach;
    plate.quad(plate.black, {-5, -5, 2}, {edge, -5, 2}, {edge, 5, 2}, {-5, 5, 2});
    plate.scene.sun = scenes::Sun{};
    plate.scene.sun->direction = Vec3(0, 0, 1);
    // The plate's 0.1 mm are 0.5 % of the penumbra; the mean over it has no first-order error.
    const double exact = 133100.0 * beyond_chord(x);
    for (const Estimate& e : {solved(plate.scene, 64), pictured(plate.scene, 64)}) {
      EXPECT_NEAR(e.mean, exact, 4.0 * e.std_error + 2e-5 * 133100.0) << x;
      EXPECT_LT(e.std_error, 0.02 * 133100.0);
    }
  }
}

// The Earth's limb, a circle of half angle h about its centre, deviates from the chord across the
// Sun's disc as a parabola, y^2 r cot(h) / 2 in radii r of the disc. Over a chord of half length c
// this leaves c^3 times the following share more of the disc. Higher terms are smaller by r, 5e-3.
double limb_bend(double half_angle_deg) {
  return base::radians(0.2666) / std::tan(base::radians(half_angle_deg)) / (3.0 * pi);
}

TEST(Plates, SunAtTheLimbShinesWithWhatIsLeftOfItsDisc) {
  // The Sun is x radii above the limb. The Earth is black, so that only the Sun shines; the plate
  // faces it.
  for (const double x : {-0.6, 0.0, 0.6}) {
    PlateScene plate;
    plate.scene.sun = scenes::Sun{};
    plate.scene.sun->direction = Vec3(0, 0, 1);
    scenes::Earth earth = uniform_earth(69.6);
    earth.radiance = Rgb(0.0);
    const double angle = base::radians(69.6 + x * 0.2666);
    earth.direction = Vec3(std::sin(angle), 0.0, std::cos(angle));
    plate.scene.earth = earth;
    const double bend = std::pow(1.0 - x * x, 1.5) * limb_bend(69.6);
    expect_both(plate.scene, 133100.0 * (1.0 - beyond_chord(x) + bend), 1e-4);
  }
}

TEST(Plates, SunAtTheLimbCastsThePenumbraOfWhatIsLeftOfIt) {
  // Half of the disc is above the limb (x > 0 at the plate). A screen at 2 m hides all points
  // further than c radii from the limb, so that the slices from 0 to c remain.
  const double reach = 2.0 * std::tan(base::radians(0.2666));
  for (const double c : {-0.3, 0.2, 0.5, 0.8}) {
    PlateScene plate;
    plate.scene.sun = scenes::Sun{};
    plate.scene.sun->direction = Vec3(0, 0, 1);
    scenes::Earth earth = uniform_earth(69.6);
    earth.radiance = Rgb(0.0);
    earth.direction = Vec3(-std::sin(base::radians(69.6)), 0.0, std::cos(base::radians(69.6)));
    plate.scene.earth = earth;
    plate.quad(plate.black, {c * reach, -5, 2}, {5, -5, 2}, {5, 5, 2}, {c * reach, 5, 2});
    const double exact = c > 0.0 ? 133100.0 * (0.5 - beyond_chord(c) + limb_bend(69.6)) : 0.0;
    for (const Estimate& e : {solved(plate.scene, 64), pictured(plate.scene, 64)}) {
      EXPECT_NEAR(e.mean, exact, 4.0 * e.std_error + 2e-5 * 133100.0) << c;
      EXPECT_LT(e.std_error, 0.02 * 133100.0);
    }
  }
}

TEST(Plates, LambertEarthGivesTiltedPlatesTheTable) {
  // A of E = albedo E_sun A at 425 km, by independent integration to four digits: a plate that
  // faces the nadir, and vertical plates on the Sun's side and on the opposite side. The plate is
  // fixed and the Earth is turned.
  struct Row {
    double theta_deg, tilt_deg, expected;
  };
  const Row rows[] = {{0, 0, 0.8749},   {60, 0, 0.4375},   {90, 0, 0.0212},  {30, 90, 0.2552},
                      {60, 90, 0.1613}, {60, -90, 0.1194}, {90, 90, 0.0242}, {80, -90, 0.0260}};
  for (const Row& row : rows) {
    PlateScene plate;
    const double tilt = base::radians(row.tilt_deg), theta = base::radians(row.theta_deg);
    // In the plane x, z: the nadir is at the angle `tilt` to the plate's normal, away from the Sun.
    const Vec3 nadir(-std::sin(tilt), 0.0, std::cos(tilt)),
        along(std::cos(tilt), 0.0, std::sin(tilt));
    scenes::Earth earth;
    earth.direction = nadir;
    earth.half_angle_deg = base::degrees(std::asin(6371.0 / 6796.0));
    earth.albedo = Rgb(1.0);
    plate.scene.earth = earth;
    plate.scene.sun = scenes::Sun{};
    plate.scene.sun->direction = -std::cos(theta) * nadir + std::sin(theta) * along;
    // The plate is one-sided. A distant screen shields it from direct sunlight.
    const Vec3 sun = plate.scene.sun->direction;
    const base::Frame3 frame = base::frame_around(sun);
    const Vec3 middle = 1000.0 * sun, a = 10.0 * frame.tangent, b = 10.0 * frame.bitangent;
    plate.quad(plate.black, middle - a - b, middle + a - b, middle + a + b, middle - a + b);
    // The jump at the limb lies in one stratum of the stratified rays; a share p of the stratum is
    // inside. If p is near 1, so few seeds show the jump that their scatter underestimates it. Its
    // standard error is at most sqrt(p (1 - p)) / 256 / 8 for 64 sets of 256 rays, 8e-5 at p = 0.97
    // as here.
    const double exact = 133100.0 * row.expected, limb = 133100.0 * 8e-5, digits = 133100.0 * 5e-5;
    for (const Estimate& e : {solved(plate.scene), pictured(plate.scene)}) {
      EXPECT_NEAR(e.mean, exact, 4.0 * std::hypot(e.std_error, limb) + digits)
          << row.theta_deg << " " << row.tilt_deg;
      EXPECT_LT(e.std_error, 0.01 * 133100.0 * 0.28);
    }
  }
}

TEST(Plates, WallThatHidesHalfTheEarthLeavesHalfTheLight) {
  // A wall through the plate's axis, 1 mm beside it and very large, hides half of a disc about the
  // axis.
  PlateScene plate;
  plate.quad(plate.black, {-1e-3, -1e3, 0}, {-1e-3, 1e3, 0}, {-1e-3, 1e3, 1e3}, {-1e-3, -1e3, 1e3});
  for (const double half_angle : {8.0, 69.6}) {  // narrow: shadow rays; wide: rays that escape
    plate.scene.earth = uniform_earth(half_angle);
    const double exact = 0.5 * pi * 1000.0 * std::pow(std::sin(base::radians(half_angle)), 2);
    expect_both(plate.scene, exact, 0.01);
  }
}

TEST(Plates, BaysWallsLeaveTheEarthAnInfiniteStrip) {
  // A trough with walls at x = -1 m and x = 2 m, both 3 m high and very long, under an Earth that
  // fills the sky: E = pi L (sin b - sin a) / 2 between the angles a and b from the normal.
  PlateScene plate;
  plate.quad(plate.black, {-1, -3e3, 0}, {-1, 3e3, 0}, {-1, 3e3, 3}, {-1, -3e3, 3});
  plate.quad(plate.black, {2, -3e3, 0}, {2, 3e3, 0}, {2, 3e3, 3}, {2, -3e3, 3});
  plate.scene.earth = uniform_earth(89.99);
  const double height = 3.0;
  const double exact =
      pi * 1000.0 * 0.5 * (2.0 / std::hypot(2.0, height) + 1.0 / std::hypot(1.0, height));
  expect_both(plate.scene, exact, 0.01);
}

TEST(Plates, EveryKindOfLampGivesTheClosedForm) {
  // Lamps at 2 m, 60 deg off the plate's normal, aimed at it: E = I cos 60 / 4. The area lamp is
  // small enough for its intensity M A / pi (1 cm: 1e-5).
  for (const auto kind : {scenes::LampKind::Point, scenes::LampKind::Spot,
                          scenes::LampKind::Rectangle, scenes::LampKind::Disk}) {
    PlateScene plate;
    scenes::Lamp lamp;
    lamp.name = lamp.group = "lamp";
    lamp.kind = kind;
    lamp.position = 2.0 * Vec3(std::sin(pi / 3), 0.0, 0.5);
    lamp.axis = -glm::normalize(lamp.position);
    lamp.beam_deg = 20.0;
    lamp.field_deg = 40.0;
    const base::Frame3 frame = base::frame_around(lamp.axis);
    lamp.edge_u = 0.01 * frame.tangent;
    lamp.edge_v = 0.01 * frame.bitangent;
    lamp.radius_m = 0.01 / std::sqrt(pi);
    const bool wide = kind == scenes::LampKind::Rectangle || kind == scenes::LampKind::Disk;
    (wide ? lamp.exitance : lamp.intensity_cd) = Rgb(wide ? 500.0 * pi / 1e-4 : 500.0);
    plate.scene.lamps.push_back(lamp);
    // The picture samples the lamp and is exact up to the plate's size. The solution also uses the
    // lamp's rays that escaped.
    const Estimate e = pictured(plate.scene, 4);
    EXPECT_NEAR(e.mean, 500.0 * 0.5 / 4.0, 4.0 * e.std_error + 5e-5 * 62.5);
    const Estimate s = solved(plate.scene, 4);
    EXPECT_NEAR(s.mean, 500.0 * 0.5 / 4.0, 4.0 * s.std_error + 1e-4 * 62.5);
  }
}

}  // namespace
}  // namespace earthshine
