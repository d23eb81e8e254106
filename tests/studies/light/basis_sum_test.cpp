// SPDX-License-Identifier: Apache-2.0
// Weighted sums of the layers of one picture against full solves and pictures with the same rays.
#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"
#include "scenes/light/lamp_light.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"
#include "studies/light/light_basis.h"
#include "studies/targets/target_view.h"
#include "tests/studies/basis_scenes.h"

namespace earthshine::studies {
namespace {

using scenes::EarthModel;

// Rounding error between two orders of the same computation in floats, 2^-24 for each operation:
// for every group radiosity, its share at a point, pixel, weight and product; for the sum as many
// additions as there are groups; the same again in the picture of all lights together.
double rounding(std::size_t groups) { return (10.0 + double(groups)) * 0x1p-24; }

void expect_equal_pictures(const base::Image& a, const base::Image& b, std::size_t groups) {
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float>&one = a.find(channel)->values, &other = b.find(channel)->values;
    double sum = 0.0;
    for (std::size_t i = 0; i < one.size(); ++i) {
      sum += double(other[i]);
      // Noise may make a dim pixel negative.
      EXPECT_NEAR(double(one[i]), double(other[i]),
                  rounding(groups) * std::abs(double(other[i])) + 1e-12)
          << channel << ' ' << i;
    }
    EXPECT_GT(sum, 0.0) << channel;
  }
}

// Black lamps do not refine patches: a trace of light keeps the patches of the scene with all
// lamps.
scenes::Scene with_a_trace(scenes::Scene scene) {
  for (scenes::Lamp& lamp : scene.lamps) {
    lamp.intensity_cd = glm::max(lamp.intensity_cd, Rgb(1e-30));
    lamp.exitance = glm::max(lamp.exitance, Rgb(1e-30));
  }
  return scene;
}

void expect_exact(const LightBasis& basis, const scenes::Camera& camera) {
  const raytrace::Frame layers = tests::basis_picture(basis, camera);
  const std::size_t groups = basis.groups().count();
  for (std::size_t place = 0; place < basis.places().size(); ++place) {
    for (std::size_t setting = 0; setting < basis.settings().size(); ++setting) {
      SCOPED_TRACE(std::to_string(place) + ", " + basis.settings()[setting].name);
      expect_equal_pictures(
          weighted_sum(layers.image, basis.groups().names, basis.weights(place, setting)),
          tests::same_rays(with_a_trace(basis.scene_at(place, setting)), camera).image, groups);
    }
  }
}

TEST(BasisSum, DimmedFailedAndColouredLampsAreExact) {
  const scenes::Scene scene = tests::open_room();
  expect_exact(LightBasis(scene, {sky_of(scene)},
                          {{"all", false, {}},
                           {"dimmed", false, {{"bay", Rgb(0.3)}, {"panels", Rgb(2.5)}}},
                           {"one failed", false, {{"right", Rgb(0.0)}}},
                           {"coloured", false, {{"left", Rgb(1, 0.5, 0.2)}}},
                           {"one alone", true, {{"spot", Rgb(0.7)}, {"panels", Rgb(0.1)}}}}),
               tests::into_the_room());
}

TEST(BasisSum, OnePlaceKeepsTheScenesSunAndEarth) {
  scenes::Scene scene = tests::open_room();
  const SkyPlace noon = tests::orbit_places({30}, EarthModel::Lambert, "bay-to-earth", 0.2666)[0];
  scene.sun = noon.sun;
  scene.sun->direction = glm::normalize(Vec3(0.6, -0.3, 0.8));  // both into the room
  scene.earth = noon.earth;
  scene.earth->direction = glm::normalize(Vec3(-1, 0, 0.1));
  expect_exact(LightBasis(scene, {sky_of(scene)},
                          {{"all", false, {}},
                           {"off", true, {}},
                           {"x", true, {{"spot", Rgb(9)}}},
                           {"dim Sun", true, {{"sun", Rgb(0.5, 0.3, 1)}}},
                           {"no Sun", true, {{"sun", Rgb(0.0)}}},
                           {"no Earth", true, {{"earth", Rgb(0.0)}, {"sun", Rgb(2.0)}}}}),
               tests::into_the_room());
}

// Plates without interreflection: the random numbers of the parts' Suns differ from the scene's,
// which affects only the radiosity of half-shaded patches.
TEST(BasisSum, AnEvenEarthInAFixedPlaceIsExact) {
  auto builder = tests::plate_on_ground(0.3, 0.6);
  builder.scene.lamps = {tests::point_lamp("lamp", "lamp", {1, 1, 1}, Rgb(2e4))};
  const scenes::Scene& scene = builder.scene;
  const LightBasis basis(scene, tests::orbit_places({0, 70, 180}, EarthModel::Uniform),
                         {{"all", false, {}}, {"off", true, {}}});
  expect_exact(basis, tests::above(3.0, 2.0));
  const std::vector<Rgb> light(basis.groups().count(), Rgb(1.0));
  for (std::size_t place = 0; place < 3; ++place) {
    const auto error = basis_error(basis.weights(place, 1), light);
    ASSERT_TRUE(error) << place;  // a uniform Earth shines at night, too
    EXPECT_LT(error->bound, 1e-13);
    EXPECT_LT(error->rms, 1e-13);
  }
}

// A tilted plate that sees half of the Earth by day. Both pictures have the same rays: a ray to
// cell k carries w_k instead of L, with an error of at most max|L - w_k|. Hence the difference of
// the pictures is within the bound without noise, except for rounding.
struct Judged {
  double off = 0.0;  // relative, of the target's luminance
  BasisError error;
};
Judged judged(const std::string& attitude, double position_deg, const BasisOptions& options) {
  auto builder = tests::plate_on_ground(0.3, 0.6);
  for (Vec3& v : builder.scene.vertices) v = Vec3(v.x, v.y, v.z + 0.5 * v.x);  // tilted
  scenes::Camera camera = tests::above(3.0, 2.0);
  const auto places =
      tests::orbit_places({position_deg, position_deg + 40}, EarthModel::Lambert, attitude);
  const LightBasis basis(builder.scene, places, {{"none", false, {}}}, options);
  const raytrace::Frame layers = tests::basis_picture(basis, camera);
  const raytrace::Frame truth = tests::same_rays(basis.scene_at(0, 0), camera);
  const TargetView target = find_targets(builder.scene, camera, object_map(truth.image)).front();
  const std::vector<Rgb> by_group =
      mean_by_group(layers.image, basis.groups().names, target.measured);
  const GroupWeights weights = basis.weights(0, 0);
  double sum = 0.0, exact = 0.0;
  for (std::size_t g = 0; g < by_group.size(); ++g) {
    sum += base::luminance(weights.weight[g] * by_group[g]);
  }
  const std::vector<float> luminance = base::luminance_of(truth.image);
  for (const std::uint32_t pixel : target.measured) exact += double(luminance[pixel]);
  exact /= double(target.measured.size());
  const auto error = basis_error(weights, by_group);
  EXPECT_TRUE(error);
  return {std::abs(exact - sum) / sum, error.value_or(BasisError{})};
}

TEST(BasisSum, TheEarthsCellsErrBelowTheirBound) {
  for (const double position : {0.0, 35.0, 70.0, 100.0, 255.0}) {
    for (const std::size_t cells : {2, 12, 48}) {
      const Judged found = judged("bay-to-earth", position, {cells, 192});
      EXPECT_LE(found.off, found.error.bound + rounding(cells)) << position << ' ' << cells;
      EXPECT_LE(found.error.rms, found.error.bound);
    }
  }
  for (const double position : {20.0, 80.0}) {
    const Judged found = judged("bay-to-sun", position, {48, 192});
    EXPECT_LE(found.off, found.error.bound + rounding(192)) << position;
  }
}

// At noon L is proportional to cos(gamma), gamma up to 20.4 deg from the point below: from 1 to
// 0.937. No cell differs from its mean by more than that range, and the exact light of the Sun only
// dilutes it. Cells of a quarter of the disc's width have a fraction of it.
TEST(BasisSum, TheBoundSaysSomething) {
  const double range = 1.0 - (base::earth_radius_m / (base::earth_radius_m + 425e3));
  const double one_ring = judged("bay-to-earth", 0.0, {2, 2}).error.bound;
  const double fine = judged("bay-to-earth", 0.0, {48, 2}).error.bound;
  EXPECT_LT(one_ring, range);
  EXPECT_GT(one_ring, 0.1 * range);
  EXPECT_LT(fine, 0.5 * one_ring);
  EXPECT_LT(judged("bay-to-earth", 0.0, {1000, 2}).error.bound, 0.3 * fine);
}

// A camera or a mirror may see any one direction of a cell: no direction has a larger error than
// stated.
TEST(BasisSum, NoDirectionOfACellIsFurtherOffThanItsLargest) {
  for (const char* attitude : {"bay-to-earth", "bay-to-sun"}) {
    const auto places =
        tests::orbit_places({0, 50, 85, 105, 200, 290}, EarthModel::Lambert, attitude);
    const LightBasis basis(tests::open_room(), places, {{"on", false, {}}});
    const scenes::SkyCells& cells = *basis.scene().sky_parts->cells;
    const double unit = base::luminance(basis.scene().earth->radiance);
    for (std::size_t place = 0; place < places.size(); ++place) {
      scenes::Scene sky;
      sky.sun = places[place].sun;
      sky.earth = places[place].earth;
      const GroupWeights weights = basis.weights(place, 0);
      base::Rng rng(base::Key(1, base::Stream::Test, place));
      double worst = 0.0;
      for (int k = 0; k < 100000; ++k) {
        const double u = rng.next(), v = rng.next();
        const Vec3 direction = scenes::sample_cone(sky.earth->direction,
                                                   base::radians(sky.earth->half_angle_deg), u, v);
        const std::size_t group = basis.groups().earth + cells.cell_of(direction);
        const double off = std::abs(base::luminance(scenes::earth_radiance(sky, direction)) / unit -
                                    base::luminance(weights.weight[group]));
        if (off > 0.0) worst = std::max(worst, off / std::max(weights.largest[group], 1e-300));
      }
      EXPECT_LE(worst, 1.0) << attitude << ' ' << place;
      if (worst > 0.0) {  // by day; the bound is also reached
        EXPECT_GT(worst, 0.9) << attitude << ' ' << place;
      }
    }
  }
}

}  // namespace
}  // namespace earthshine::studies
