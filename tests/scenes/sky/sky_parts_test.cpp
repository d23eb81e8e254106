// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/effects/effects.h"
#include "scenes/effects/light_groups.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::scenes {
namespace {

Sun sun_at(const Vec3& direction, double radius_deg) {
  Sun sun;
  sun.direction = glm::normalize(direction);
  sun.angular_radius_deg = radius_deg;
  return sun;
}

Scene sky_in_parts(double half_angle_deg, std::size_t wanted) {
  Scene scene;
  Earth earth;
  earth.model = EarthModel::Uniform;
  earth.radiance = Rgb(1.0);
  earth.half_angle_deg = half_angle_deg;
  scene.earth = earth;
  SkyParts parts;
  parts.suns = {sun_at({0, 0, -1}, 0.3), sun_at({1, 0, 0}, 2.0)};
  parts.cells = cells_of_disc(earth.direction, base::radians(half_angle_deg), wanted);
  scene.sky_parts = std::make_shared<const SkyParts>(parts);
  Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.intensity_cd = Rgb(1.0);
  scene.lamps.push_back(lamp);
  return scene;
}

TEST(SkyParts, EachHasALightGroupBeforeTheLamps) {
  const Scene scene = sky_in_parts(60.0, 2);
  const LightGroups groups = find_light_groups(scene);
  EXPECT_EQ(groups.names,
            (std::vector<std::string>{"earth-0", "earth-1", "sun-0", "sun-1", "lamp"}));
  EXPECT_EQ(groups.earth, 0U);
  EXPECT_EQ(groups.sun_parts, 2U);
  EXPECT_EQ(groups.lamp[0], 4U);
  EXPECT_EQ(groups.sun, no_group);
  EXPECT_EQ(earth_parts(scene), 2U);
}

TEST(SkyParts, AWholeSkyHasOnePartOfEach) {
  Scene scene = sky_in_parts(60.0, 2);
  scene.sky_parts.reset();
  scene.sun = sun_at({1, 0, 0}, 0.3);
  const LightGroups groups = find_light_groups(scene);
  EXPECT_EQ(groups.names, (std::vector<std::string>{"sun", "earth", "lamp"}));
  EXPECT_EQ(groups.sun_parts, no_group);
  EXPECT_EQ(earth_parts(scene), 1U);
  EXPECT_EQ(earth_part(scene, {0, 0, 1}), 0U);
  EXPECT_EQ(sun_part(scene, {1, 0, 0}), 0U);
}

TEST(SkyParts, DirectionsMeetTheSunWhoseDiscTheyAreIn) {
  const Scene scene = sky_in_parts(60.0, 48);
  const auto off_x = [](double deg) {
    return Vec3(std::cos(base::radians(deg)), std::sin(base::radians(deg)), 0.0);
  };
  EXPECT_EQ(sun_part(scene, {0, 0, -1}), 0U);
  EXPECT_EQ(sun_part(scene, off_x(1.9)), 1U);
  EXPECT_EQ(sun_part(scene, off_x(2.1)), 2U);  // none
  EXPECT_EQ(earth_part(scene, {0, 0, 1}), scene.sky_parts->cells->cell_of({0, 0, 1}));
}

// Shadow rays toward a narrow Earth would give all of its light to one group.
TEST(SkyParts, AnEarthInCellsIsGatheredHoweverNarrow) {
  for (const double half_angle_deg : {1.0, 18.0, 19.0, 70.0}) {
    const Scene scene = sky_in_parts(half_angle_deg, 12);
    EXPECT_TRUE(find_effects(scene, find_light_groups(scene)).earth_by_gather) << half_angle_deg;
  }
  Scene whole = sky_in_parts(10.0, 12);
  whole.sky_parts.reset();
  EXPECT_FALSE(find_effects(whole, find_light_groups(whole)).earth_by_gather);
}

}  // namespace
}  // namespace earthshine::scenes
