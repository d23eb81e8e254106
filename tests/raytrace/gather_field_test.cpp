// SPDX-License-Identifier: Apache-2.0
// What neighbouring gather points may share, on fields written down by hand.
#include "raytrace/gather_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace earthshine::raytrace {
namespace {

constexpr int edge_px = 41;
constexpr float spacing_m = 0.01F;

// Points on a plane 2 m in front of the camera, facing it, one per pixel.
template <class Radiance>
GatherField flat_field(float reach_m, Radiance radiance) {
  GatherField field;
  field.window = {0, 0, edge_px, edge_px};
  field.image_layers = field.layers = 1;
  for (int y = 0; y < edge_px; ++y) {
    for (int x = 0; x < edge_px; ++x) {
      GatherPoint point;
      point.position =
          glm::vec3(spacing_m * static_cast<float>(x), spacing_m * static_cast<float>(y), -2.0F);
      point.normal = glm::vec3(0.0F, 0.0F, 1.0F);
      point.reach_m = reach_m;
      point.spacing_m = spacing_m;
      point.rays = 32.0F;
      field.points.push_back(point);
      field.radiance.emplace_back(static_cast<float>(radiance(x, y)));
      field.squared_error.push_back(0.0F);
    }
  }
  return field;
}

std::size_t pixel(int x, int y) {
  return static_cast<std::size_t>(y) * edge_px + static_cast<std::size_t>(x);
}

TEST(GatherField, SharingKeepsWhatIsLinearInPosition) {
  const auto linear = [](int x, int y) { return 9.0 + 0.3 * x - 0.2 * y; };
  GatherField field = flat_field(1.0F, linear);
  smooth(field, 0.2, 16);
  for (int y = 0; y < edge_px; ++y) {
    for (int x = 0; x < edge_px; ++x) {
      EXPECT_NEAR(field.radiance[pixel(x, y)].g, linear(x, y), 2e-5) << x << ", " << y;
    }
  }
}

TEST(GatherField, SharedNoiseFallsAsItSays) {
  // Independent noise of variance 1 on 10: the stated squared errors must be those found, and far
  // below 1. Twenty pixels apart no two share, so that four per field and 400 fields are
  // independent: the mean of e^2 / stated has a standard error of sqrt(2 / 1600).
  double ratio = 0.0, stated = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    base::Rng rng(base::Key(seed, base::Stream::Test, 4));
    GatherField field =
        flat_field(1.0F, [&](int, int) { return 10.0 + std::sqrt(12.0) * (rng.next() - 0.5); });
    smooth(field, 0.08, 16);
    for (int y = 10; y < edge_px; y += 20) {
      for (int x = 10; x < edge_px; x += 20) {
        const double off = double(field.radiance[pixel(x, y)].g) - 10.0;
        const double error2 = double(field.squared_error[pixel(x, y)]);
        ratio += off * off / error2;
        stated += error2;
        ++count;
      }
    }
  }
  EXPECT_EQ(count, 1600);
  // The variance is estimated from about 40 neighbours and scatters by sqrt(2 / 40): the mean of
  // its inverse is higher by the square of that.
  EXPECT_NEAR(ratio / count, 1.0 + 2.0 / 40.0, 4.0 * std::sqrt(2.0 / 1600.0));
  EXPECT_LT(stated / count, 0.1);
}

TEST(GatherField, NothingIsSharedAcrossAnEdgeOrAStep) {
  for (const bool folded : {true, false}) {
    GatherField field = flat_field(1.0F, [](int x, int) { return x < 20 ? 1.0 : 7.0; });
    for (int y = 0; y < edge_px; ++y) {
      for (int x = 20; x < edge_px; ++x) {
        GatherPoint& point = field.points[pixel(x, y)];
        if (folded) {
          point.normal = glm::vec3(-1.0F, 0.0F, 0.0F);
        } else {
          point.position.z = -2.5F;
        }
      }
    }
    smooth(field, 0.2, 16);
    for (int x = 0; x < edge_px; ++x) {
      EXPECT_NEAR(field.radiance[pixel(x, 20)].g, x < 20 ? 1.0 : 7.0, 1e-5) << x << " " << folded;
    }
  }
}

TEST(GatherField, SharingNeverGoesBelowZero) {
  // At the foot of a steep rise the plane through the neighbours would: there their mean stands.
  GatherField field =
      flat_field(1.0F, [](int x, int) { return x < 3 ? 0.0 : std::pow(x - 2.0, 2.0); });
  smooth(field, 0.12, 16);
  for (const glm::vec3& value : field.radiance) EXPECT_GE(value.g, 0.0F);
}

TEST(GatherField, PointsShareOnlyWithinTheirReach) {
  // Beyond share * reach nothing is taken: a spike 3 pixels away does not arrive with 2.5 pixels,
  // and does with 4.5.
  for (const double pixels : {2.5, 4.5}) {
    GatherField field =
        flat_field(1.0F, [](int x, int y) { return x == 23 && y == 20 ? 9.0 : 1.0; });
    smooth(field, pixels * double(spacing_m), 16);
    const bool arrives = std::abs(double(field.radiance[pixel(20, 20)].g) - 1.0) > 1e-4;
    EXPECT_EQ(arrives, pixels > 3.0) << pixels;
  }
}

TEST(GatherField, APointOnTheSameSurfaceIsFoundAndNoOther) {
  GatherField field = flat_field(1.0F, [](int, int) { return 1.0; });
  const glm::vec3 up(0.0F, 0.0F, 1.0F);
  const auto at = [](int x, int y) {
    return glm::vec3(spacing_m * static_cast<float>(x), spacing_m * static_cast<float>(y), -2.0F);
  };
  EXPECT_EQ(field.find(5, 6, at(5, 6) + glm::vec3(0.004F, 0.004F, 0.0F), up), pixel(5, 6));
  field.points[pixel(5, 6)].reach_m = -1.0F;  // the pixel's own centre meets something else
  EXPECT_EQ(field.find(5, 6, at(5, 6) + glm::vec3(0.004F, 0.0F, 0.0F), up), pixel(6, 6));
  EXPECT_EQ(field.find(5, 6, at(5, 6), glm::vec3(1.0F, 0.0F, 0.0F)), no_point);
  EXPECT_EQ(field.find(5, 6, at(5, 6) + glm::vec3(0.0F, 0.0F, 0.5F), up), no_point);
}

}  // namespace
}  // namespace earthshine::raytrace
