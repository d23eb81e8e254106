// SPDX-License-Identifier: Apache-2.0
// Groups and weights of a light basis; basis_sum_test.cpp tests their sums.
#include "studies/light/light_basis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"
#include "tests/studies/basis_scenes.h"

namespace earthshine::studies {
namespace {

using scenes::EarthModel;
using scenes::no_group;
using Factors = std::map<std::string, Rgb>;

LightBasis one_place(const scenes::Scene& scene, std::vector<LampSetting> settings) {
  return LightBasis(scene, {sky_of(scene)}, std::move(settings));
}

Rgb weight_of(const LightBasis& basis, const std::string& group, std::size_t setting,
              double lamps = 1.0) {
  const auto& names = basis.groups().names;
  const auto found = std::find(names.begin(), names.end(), group);
  if (found == names.end()) return Rgb(-1.0);  // no such group
  const auto g = static_cast<std::size_t>(found - names.begin());
  return basis.weights(0, setting, lamps).weight[g];
}

TEST(LightBasis, LampsThatAreNamedHaveGroupsOfTheirOwn) {
  const scenes::Scene scene = tests::open_room();
  EXPECT_EQ(one_place(scene, {{"all", false, {}}}).groups().names,
            (std::vector<std::string>{"spot", "bay", "panels"}));
  EXPECT_EQ(one_place(scene, {{"x", false, {{"right", Rgb(0.5)}}}}).groups().names,
            (std::vector<std::string>{"spot", "bay", "right", "panels"}));
  EXPECT_EQ(one_place(scene, {{"x", false, {{"bay", Rgb(0.5)}}}}).groups().names,
            (std::vector<std::string>{"spot", "bay", "panels"}));
}

TEST(LightBasis, ALampsOwnNameGoesBeforeItsGroups) {
  const LightBasis basis =
      one_place(tests::open_room(), {{"x", false, {{"bay", Rgb(0.25)}, {"right", Rgb(2, 1, 0)}}}});
  EXPECT_EQ(weight_of(basis, "bay", 0), Rgb(0.25));
  EXPECT_EQ(weight_of(basis, "right", 0), Rgb(2, 1, 0));
  EXPECT_EQ(weight_of(basis, "spot", 0), Rgb(1.0));
  const scenes::Scene there = basis.scene_at(0, 0);
  EXPECT_EQ(there.lamps[1].intensity_cd, Rgb(7.5, 5, 2.5));
  EXPECT_EQ(there.lamps[2].intensity_cd, Rgb(50, 25, 0));
  EXPECT_EQ(there.lamps[0].exitance, Rgb(500.0));
}

TEST(LightBasis, WhatIsNotNamedStaysOrIsOff) {
  const LightBasis basis = one_place(tests::open_room(), {{"keep", false, {{"spot", Rgb(3.0)}}},
                                                          {"only", true, {{"spot", Rgb(3.0)}}}});
  for (const char* group : {"bay", "panels"}) {
    EXPECT_EQ(weight_of(basis, group, 0), Rgb(1.0)) << group;
    EXPECT_EQ(weight_of(basis, group, 1), Rgb(0.0)) << group;
  }
  EXPECT_EQ(weight_of(basis, "spot", 0), Rgb(3.0));
  EXPECT_EQ(weight_of(basis, "spot", 1), Rgb(3.0));
  EXPECT_EQ(basis.scene_at(0, 1).materials[2].emit, Rgb(0.0));
  EXPECT_EQ(basis.scene_at(0, 1).lamps[1].intensity_cd, Rgb(0.0));
}

TEST(LightBasis, LampsOfASettingMayBeDimmedTogether) {
  const LightBasis basis = one_place(tests::open_room(), {{"x", false, {{"bay", Rgb(0.5)}}}});
  EXPECT_EQ(weight_of(basis, "bay", 0, 0.5), Rgb(0.25));
  EXPECT_EQ(weight_of(basis, "panels", 0, 0.5), Rgb(0.5));
  EXPECT_EQ(weight_of(basis, "panels", 0, 0.0), Rgb(0.0));
}

TEST(LightBasis, WhatIsOffInAllSettingsHasNoGroup) {
  const scenes::Scene scene = tests::open_room();
  EXPECT_EQ(one_place(scene, {{"a", false, {{"spot", Rgb(0.0)}}}, {"b", true, {{"bay", Rgb(1.0)}}}})
                .groups()
                .names,
            (std::vector<std::string>{"bay", "panels"}));
  EXPECT_EQ(one_place(scene, {{"b", true, {{"left", Rgb(1.0)}}}}).groups().names,
            std::vector<std::string>{"left"});
  EXPECT_TRUE(one_place(scene, {{"dark", true, {}}}).groups().names.empty());
}

// A lamp with the name of another's group: one setting dims both equally, the other does not.
TEST(LightBasis, ALampNamedLikeAnotherGroupKeepsItsOwnWeight) {
  scenes::Scene scene = tests::open_room();
  scene.lamps[0].name = "bay";
  const LightBasis basis =
      one_place(scene, {{"a", false, {{"bay", Rgb(0.5)}}}, {"b", false, {{"spot", Rgb(0.25)}}}});
  EXPECT_NE(basis.groups().lamp[0], basis.groups().lamp[1]);
  const GroupWeights b = basis.weights(0, 1);
  EXPECT_EQ(b.weight[basis.groups().lamp[1]], Rgb(1.0));
  EXPECT_EQ(b.weight[basis.groups().lamp[0]], Rgb(0.25));
}

// The program names the groups of a sky in parts; scenes may have lamps with these names.
TEST(LightBasis, LampsNamedLikePartsOfTheSkyAreApartFromThem) {
  scenes::Scene scene = tests::open_room();
  scene.lamps[0].group = "sun-0";
  scene.lamps[1].group = "earth-3";
  const LightBasis basis(scene, tests::orbit_places({0, 90}, EarthModel::Lambert),
                         {{"half", false, {{"sun-0", Rgb(0.5)}, {"earth-3", Rgb(0.25)}}}});
  const GroupWeights found = basis.weights(0, 0);
  EXPECT_EQ(found.weight[basis.groups().lamp[0]], Rgb(0.5));
  EXPECT_EQ(found.weight[basis.groups().lamp[1]], Rgb(0.25));
  EXPECT_NE(basis.groups().lamp[0], basis.groups().sun_parts);
  EXPECT_NE(basis.groups().lamp[1], basis.groups().earth + 3);
}

void refused(const LampSetting& setting, const std::vector<std::string>& words) {
  try {
    (void)one_place(tests::open_room(), {setting});
    ADD_FAILURE() << "accepted";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.blame(), base::Blame::Input);
    for (const std::string& word : words) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
}

TEST(LightBasis, UnknownLampsAndNegativeFactorsAreRefused) {
  refused({"dim", false, {{"moon", Rgb(0.5)}}},
          {"dim", "\"moon\"", "bay, left, panels, right, spot"});
  refused({"dim", false, {{"left", Rgb(0.5, -0.1, 0)}}}, {"dim", "\"left\"", "below 0"});
  refused({"dim", false, {{"left", Rgb(0.5, std::nan(""), 0)}}}, {"\"left\""});
}

TEST(LightBasis, EqualSunsAreOne) {
  const scenes::Scene scene = tests::open_room();
  const std::vector<LampSetting> lamps = {{"on", false, {}}};
  // Once around, and 0 again as 360 deg; night between about 110 and 250 deg.
  const auto places = tests::orbit_places({0, 90, 180, 270, 360, -90}, EarthModel::Lambert);
  const LightBasis basis(scene, places, lamps);
  EXPECT_EQ(basis.sun_parts(), 3U);
  EXPECT_TRUE(basis.in_parts());
  for (const auto& [a, b] : {std::pair{0, 4}, {3, 5}}) {
    const GroupWeights one = basis.weights(static_cast<std::size_t>(a), 0),
                       same = basis.weights(static_cast<std::size_t>(b), 0);
    for (std::size_t g = 0; g < one.weight.size(); ++g) {
      EXPECT_NEAR(one.weight[g].g, same.weight[g].g, 1e-9 * one.weight[g].g);
    }
  }
  // An attitude that follows the Sun has a single one, and an Earth all around it.
  const LightBasis turned(
      scene, tests::orbit_places({0, 90, 180, 270}, EarthModel::Lambert, "bay-to-sun"), lamps);
  EXPECT_EQ(turned.sun_parts(), 1U);
  EXPECT_EQ(turned.scene().earth->half_angle_deg, 180.0);
}

TEST(LightBasis, InTheUmbraSunAndEarthWeighNothing) {
  const scenes::Scene scene = tests::open_room();
  const LightBasis basis(scene, tests::orbit_places({0, 180}, EarthModel::Lambert),
                         {{"on", false, {}}});
  const GroupWeights night = basis.weights(1, 0);
  const std::size_t lamps = basis.groups().sun_parts + basis.sun_parts();
  ASSERT_EQ(lamps, basis.groups().count() - 3);  // "spot", "bay", "panels"
  for (std::size_t g = 0; g < basis.groups().count(); ++g) {
    EXPECT_EQ(night.weight[g], Rgb(g < lamps ? 0.0 : 1.0)) << basis.groups().names[g];
    EXPECT_EQ(night.largest[g], 0.0);
    EXPECT_EQ(night.scatter[g], 0.0);
  }
  const GroupWeights noon = basis.weights(0, 0);
  for (std::size_t g = 0; g < lamps; ++g) EXPECT_GT(noon.weight[g].g, 0.0);
}

// Weight times the group's Sun is the Sun at the place. If the limb crosses the disc's centre it is
// half of it, corrected for the curvature of the limb, r cot(h) / (3 pi) of the disc. A Sun of
// different illuminance is no separate Sun.
TEST(LightBasis, APartlyHiddenSunWeighsItsShare) {
  auto places = tests::orbit_places({0, 60, 60}, EarthModel::Lambert, "bay-to-earth", 0.2666);
  places[2].sun->illuminance_lx = Rgb(100, 200, 0);
  // At the limb: the Sun's centre is at the Earth's half angle from its centre.
  SkyPlace limb = places[0];
  const double h = base::radians(limb.earth->half_angle_deg);
  limb.earth->direction = Vec3(0, 0, 1);
  limb.sun->direction = Vec3(std::sin(h), 0, std::cos(h));
  places.push_back(limb);
  const LightBasis basis(tests::open_room(), places, {{"on", false, {}}});
  ASSERT_EQ(basis.sun_parts(), 3U);
  const std::size_t part[] = {0, 1, 1, 2};
  const double bend = base::radians(0.2666) / std::tan(h) / (3.0 * base::pi);
  const double share[] = {1.0, 1.0, 1.0, 0.5 + bend};
  for (std::size_t k = 0; k < places.size(); ++k) {
    const GroupWeights found = basis.weights(k, 0);
    for (std::size_t s = 0; s < 3; ++s) {
      const Rgb lux = found.weight[basis.groups().sun_parts + s] *
                      basis.scene().sky_parts->suns[s].illuminance_lx;
      const Rgb expected = s == part[k] ? share[k] * places[k].sun->illuminance_lx : Rgb(0.0);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(lux[c], expected[c], 1e-6 * 133100.0) << k << ' ' << s;
    }
  }
}

TEST(LightBasis, EarthSunOrBothMayBeMissing) {
  const scenes::Scene scene = tests::open_room();
  auto no_earth = tests::orbit_places({0, 90}, EarthModel::Lambert);
  for (SkyPlace& place : no_earth) place.earth.reset();
  const LightBasis suns(scene, no_earth, {{"on", false, {}}});
  EXPECT_EQ(suns.earth_parts(), 0U);
  EXPECT_EQ(suns.sun_parts(), 2U);
  EXPECT_EQ(suns.weights(0, 0).weight.size(), suns.groups().count());
  auto no_sun = tests::orbit_places({0, 90}, EarthModel::Uniform);
  for (SkyPlace& place : no_sun) place.sun.reset();
  const LightBasis earths(scene, no_sun, {{"on", false, {}}});
  EXPECT_EQ(earths.sun_parts(), 0U);
  EXPECT_GT(earths.earth_parts(), 1U);
  const LightBasis none(scene, {SkyPlace{}, SkyPlace{}}, {{"on", false, {}}});
  EXPECT_EQ(none.groups().names, (std::vector<std::string>{"spot", "bay", "panels"}));
  EXPECT_EQ(none.weights(1, 0).weight.size(), 3U);
  // A Sun without light.
  auto dark = tests::orbit_places({0, 90}, EarthModel::Lambert);
  for (SkyPlace& place : dark) place.sun->illuminance_lx = Rgb(0.0);
  const LightBasis black(scene, dark, {{"on", false, {}}});
  for (const Rgb& weight : black.weights(0, 0).weight) EXPECT_TRUE(std::isfinite(weight.g));
}

}  // namespace
}  // namespace earthshine::studies
