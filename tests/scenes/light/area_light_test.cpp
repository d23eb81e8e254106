// SPDX-License-Identifier: Apache-2.0
// Lamps and emitting surfaces of finite extent: mean of their samples on a plate against closed
// forms of a differential element and a figure (Howell's catalogue B-3, B-4, B-13).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/numbers/random.h"
#include "scenes/light/emitters.h"
#include "scenes/light/lamp_light.h"
#include "scenes/light/solid_angle.h"
#include "tests/support/scene_builder.h"

namespace earthshine::scenes {
namespace {

using base::pi;

using Sample = std::function<LightSample(const Vec3& point, double u, double v)>;

struct Estimate {
  double mean = 0.0, std_error = 0.0, relative_variance = 0.0;
};

// Mean illuminance of a plate from independent samples.
Estimate illuminance(const Sample& sample, const Vec3& point, const Vec3& normal,
                     int count = 40000) {
  base::Rng rng(base::Key(1, base::Stream::Test, 90));
  double sum = 0.0, squares = 0.0;
  for (int n = 0; n < count; ++n) {
    const double u = rng.next(), v = rng.next();
    const LightSample light = sample(point, u, v);
    const double e =
        light.normal_illuminance_lx.g * std::max(0.0, glm::dot(light.direction, normal));
    sum += e;
    squares += e * e;
  }
  Estimate estimate;
  estimate.mean = sum / count;
  const double variance = std::max(0.0, squares / count - estimate.mean * estimate.mean);
  estimate.std_error = std::sqrt(variance / (count - 1));
  estimate.relative_variance = variance / (estimate.mean * estimate.mean);
  return estimate;
}

// Plate parallel to a rectangle, under one of its corners: sides a, b, distance c.
double under_a_corner(double a, double b, double c) {
  const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * pi);
}

// Plate at a corner of a rectangle perpendicular to its plane at the distance c: width b along the
// plane, height a.
double beside_a_corner(double b, double a, double c) {
  const double y = c / b, x = a / b, r = std::sqrt(x * x + y * y);
  return (std::atan(1 / y) - y / r * std::atan(1 / r)) / (2 * pi);
}

Lamp rectangle(double a, double b, double height) {
  Lamp lamp;
  lamp.kind = LampKind::Rectangle;
  lamp.edge_u = Vec3(0, b, 0);
  lamp.edge_v = Vec3(a, 0, 0);
  lamp.position = Vec3(a / 2, b / 2, height);  // a corner above the origin
  lamp.axis = Vec3(0, 0, -1);
  lamp.exitance = Rgb(1000.0);
  return lamp;
}

Sample samples_of(const Lamp& lamp, Spread spread) {
  return [lamp, spread](const Vec3& point, double u, double v) {
    return sample_lamp(lamp, point, u, v, spread);
  };
}

TEST(AreaLight, RectangleOverAPlateGivesItTheClosedForm) {
  for (const double height : {0.05, 0.3, 1.0, 4.0, 20.0}) {
    const Lamp lamp = rectangle(1.0, 0.7, height);
    const double exact = 1000.0 * under_a_corner(1.0, 0.7, height);
    for (const Spread spread : {Spread::Best, Spread::OverArea}) {
      const Estimate e = illuminance(samples_of(lamp, spread), Vec3(0.0), Vec3(0, 0, 1));
      EXPECT_NEAR(e.mean, exact, 4.0 * e.std_error) << height;
    }
  }
}

TEST(AreaLight, RectangleBesideAPlateGivesItTheClosedForm) {
  // It is at x = c and emits toward the plate at the origin; half of it is below the horizon.
  for (const double c : {0.1, 1.0, 5.0}) {
    Lamp lamp;
    lamp.kind = LampKind::Rectangle;
    lamp.edge_u = Vec3(0, 0, 2);
    lamp.edge_v = Vec3(0, 1.5, 0);
    lamp.position = Vec3(c, 0.75, 0);
    lamp.axis = Vec3(-1, 0, 0);
    lamp.exitance = Rgb(1000.0);
    const double exact = 1000.0 * beside_a_corner(1.5, 1.0, c);
    for (const Spread spread : {Spread::Best, Spread::OverArea}) {
      const Estimate e = illuminance(samples_of(lamp, spread), Vec3(0.0), Vec3(0, 0, 1));
      EXPECT_NEAR(e.mean, exact, 4.0 * e.std_error) << c;
    }
  }
}

TEST(AreaLight, ParallelogramsAreNotTakenForRectangles) {
  // A sheared lamp has the area of the rectangle with its base and height: the same light as its
  // two triangles as emitting surfaces.
  Lamp lamp = rectangle(1.0, 1.0, 0.5);
  lamp.edge_v += Vec3(0, 0.8, 0);
  tests::SceneBuilder builder;
  const std::uint32_t bright = builder.material(tests::grey(0.0, 1000.0));
  const Vec3 corner = lamp.position - 0.5 * (lamp.edge_u + lamp.edge_v);
  builder.quad(bright, corner, corner + lamp.edge_u, corner + lamp.edge_u + lamp.edge_v,
               corner + lamp.edge_v);
  const EmitterSet set(builder.scene, bright);
  const Estimate a = illuminance(samples_of(lamp, Spread::Best), Vec3(0.0), Vec3(0, 0, 1));
  const Estimate b =
      illuminance([&](const Vec3& p, double u, double v) { return set.sample(p, u, v); }, Vec3(0.0),
                  Vec3(0, 0, 1));
  EXPECT_NEAR(a.mean, b.mean, 4.0 * std::hypot(a.std_error, b.std_error));
}

TEST(AreaLight, SolidAngleLeavesLittleNoiseNearALamp) {
  // Solid-angle samples vary only with the receiver's cosine; area samples also with cos / r^2.
  const auto variance = [](double height, Spread spread) {
    return illuminance(samples_of(rectangle(1.0, 1.0, height), spread), Vec3(0.5, 0.5, 0.0),
                       Vec3(0, 0, 1))
        .relative_variance;
  };
  EXPECT_LT(variance(0.1, Spread::Best) * 50, variance(0.1, Spread::OverArea));
  EXPECT_LT(variance(1.0, Spread::Best) * 12, variance(1.0, Spread::OverArea));
}

TEST(AreaLight, DiskGivesPlatesBesideItsAxisTheClosedForm) {
  // Parallel element a off the axis of a disk of radius r at distance h: with H = h / a, R = r / a
  // and Z = 1 + H^2 + R^2, F = (1 - (Z - 2 R^2) / sqrt(Z^2 - 4 R^2)) / 2.
  Lamp lamp;
  lamp.kind = LampKind::Disk;
  lamp.radius_m = 0.8;
  lamp.axis = Vec3(0, 0, -1);
  lamp.exitance = Rgb(1000.0);
  for (const double h : {0.3, 1.0, 6.0}) {
    lamp.position = Vec3(0, 0, h);
    for (const double a : {0.2, 1.0, 3.0}) {
      const double hh = h / a, rr = 0.8 / a, z = 1 + hh * hh + rr * rr;
      const double exact = 500.0 * (1.0 - (z - 2 * rr * rr) / std::sqrt(z * z - 4 * rr * rr));
      const Estimate e = illuminance(samples_of(lamp, Spread::Best), Vec3(a, 0, 0), Vec3(0, 0, 1));
      EXPECT_NEAR(e.mean, exact, 4.0 * e.std_error) << h << " " << a;
    }
  }
}

TEST(AreaLight, EmittingSurfacesGiveTheSameAsTheLampOfTheirShape) {
  // A rectangle of 1 m x 0.7 m over a plate, as one quad, as a grid of quads and as a sheet.
  const Sample by_lamp = samples_of(rectangle(1.0, 0.7, 0.4), Spread::Best);
  const double exact = 1000.0 * under_a_corner(1.0, 0.7, 0.4);
  for (const int n : {1, 12}) {
    for (const bool sheet : {false, true}) {
      tests::SceneBuilder builder;
      Material material = tests::grey(0.0, 1000.0);
      material.two_sided = sheet;
      const std::uint32_t bright = builder.material(material);
      for (int i = 0; i < n; ++i) {
        for (int k = 0; k < n; ++k) {
          const double x0 = 1.0 * i / n, x1 = 1.0 * (i + 1) / n;
          const double y0 = 0.7 * k / n, y1 = 0.7 * (k + 1) / n;
          builder.quad(bright, {x0, y0, 0.4}, {x0, y1, 0.4}, {x1, y1, 0.4}, {x1, y0, 0.4});
        }
      }
      const EmitterSet set(builder.scene, bright);
      EXPECT_NEAR(set.flux_lm().g, (sheet ? 2.0 : 1.0) * 700.0, 1e-9);
      for (const Spread spread : {Spread::Best, Spread::OverArea}) {
        const auto sample = [&](const Vec3& p, double u, double v) {
          return set.sample(p, u, v, spread);
        };
        const Estimate below = illuminance(sample, Vec3(0.0), Vec3(0, 0, 1));
        EXPECT_NEAR(below.mean, exact, 4.0 * below.std_error) << n;
        const Estimate above = illuminance(sample, Vec3(0, 0, 0.8), Vec3(0, 0, -1));
        EXPECT_NEAR(above.mean, sheet ? exact : 0.0, 4.0 * above.std_error) << n;
      }
    }
  }
}

TEST(AreaLight, LongEmitterIsSampledWhereItIsNear) {
  // A strip of 200 elements, 20 m long, 10 cm over the plate: selection by flux would nearly always
  // choose an element that gives no light.
  tests::SceneBuilder builder;
  const std::uint32_t bright = builder.material(tests::grey(0.0, 1000.0));
  for (int k = 0; k < 200; ++k) {
    const double x = 0.1 * k;
    builder.quad(bright, {x, 0, 0.1}, {x, 0.1, 0.1}, {x + 0.1, 0.1, 0.1}, {x + 0.1, 0, 0.1});
  }
  const EmitterSet set(builder.scene, bright);
  const auto estimate = [&](Spread spread) {
    return illuminance(
        [&](const Vec3& p, double u, double v) { return set.sample(p, u, v, spread); }, Vec3(0.0),
        Vec3(0, 0, 1));
  };
  const double exact = 1000.0 * under_a_corner(20.0, 0.1, 0.1);
  const Estimate best = estimate(Spread::Best), by_area = estimate(Spread::OverArea);
  EXPECT_NEAR(best.mean, exact, 4.0 * best.std_error);
  EXPECT_NEAR(by_area.mean, exact, 4.0 * by_area.std_error);
  EXPECT_LT(100.0 * best.relative_variance, by_area.relative_variance);
}

TEST(AreaLight, SolidAnglesAreThoseOfTheCubesFaces) {
  // From its middle every face of a cube fills 4 pi / 6, half a face 4 pi / 12. Directions are
  // uniform in it: by symmetry their mean lies on the face's axis.
  const Vec3 corner(-1, -1, -1);
  Vec3 mean(0.0), triangle_mean(0.0);
  base::Rng rng(base::Key(1, base::Stream::Test, 91));
  const int count = 20000;
  for (int n = 0; n < count; ++n) {
    const double u = rng.next(), v = rng.next();
    const auto face = sample_rectangle(Vec3(0.0), corner, {2, 0, 0}, {0, 2, 0}, u, v);
    const auto half = sample_triangle(Vec3(0.0), corner, {2, 0, 0}, {2, 2, 0}, u, v);
    ASSERT_NEAR(face.solid_angle_sr, 4.0 * pi / 6.0, 1e-12);
    ASSERT_NEAR(half.solid_angle_sr, 4.0 * pi / 12.0, 1e-12);
    const Vec3 on_face = face.direction / -face.direction.z,
               on_half = half.direction / -half.direction.z;
    ASSERT_TRUE(std::abs(on_face.x) <= 1 + 1e-9 && std::abs(on_face.y) <= 1 + 1e-9);
    ASSERT_TRUE(on_half.x <= 1 + 1e-9 && on_half.y >= -1 - 1e-9 && on_half.x >= on_half.y - 1e-9);
    mean += face.direction / double(count);
    triangle_mean += (half.direction + Vec3(half.direction.y, half.direction.x, half.direction.z)) /
                     (2.0 * count);
  }
  // Mean cosine over a face from the illuminance of a plate in the middle: E / (L Omega).
  const double cosine = 4.0 * pi * under_a_corner(1.0, 1.0, 1.0) / (4.0 * pi / 6.0);
  for (const Vec3& m : {mean, triangle_mean}) {
    EXPECT_NEAR(m.x, 0.0, 4.0 / std::sqrt(double(count)));
    EXPECT_NEAR(m.y, 0.0, 4.0 / std::sqrt(double(count)));
    EXPECT_NEAR(m.z, -cosine, 4.0 * 0.15 / std::sqrt(double(count)));
  }
}

TEST(AreaLight, SpotFallsSmoothlyFromBeamToField) {
  // Continuous from 1 to 0 and level at both ends: in steps of 0.01 deg of 30 deg no step exceeds
  // 1.5 (the steepest slope of a smoothstep) x 0.01 deg in the cosine.
  Lamp lamp;
  lamp.kind = LampKind::Spot;
  lamp.beam_deg = 40.0;
  lamp.field_deg = 100.0;
  const double width = std::cos(base::radians(20.0)) - std::cos(base::radians(50.0));
  double before = 1.0;
  for (double angle = 19.0; angle < 51.0; angle += 0.01) {
    const double value = spot_profile(lamp, std::cos(base::radians(angle)));
    ASSERT_LE(value, before);
    ASSERT_LT(before - value, 1.5 * base::radians(0.01) * 0.77 / width);
    before = value;
  }
  EXPECT_EQ(before, 0.0);
  const auto at = [&](double angle) { return spot_profile(lamp, std::cos(base::radians(angle))); };
  EXPECT_GT(at(20.1), 1.0 - 1e-4);
  EXPECT_LT(at(49.9), 1e-4);
}

}  // namespace
}  // namespace earthshine::scenes
