// SPDX-License-Identifier: Apache-2.0
// The Earth as an ellipsoid, its albedo by place, and moonlight.
#include <gtest/gtest.h>

#include <cmath>

#include "base/files/exr_file.h"
#include "base/files/png_file.h"
#include "scenes/effects/effects.h"
#include "scenes/effects/light_groups.h"
#include "scenes/sky/airglow.h"
#include "scenes/sky/albedo_grid.h"
#include "scenes/sky/moon.h"
#include "scenes/sky/sky.h"
#include "scenes/time/mission.h"
#include "tests/scenes/scene_text.h"
#include "tests/scenes/time/oem_text.h"

namespace earthshine::scenes {
namespace {

constexpr double equator_m = 6378137.0, polar_m = 6356752.314245;  // WGS 84

// Along the equator's plane the limb is that of a circle of the equator's radius, asin(a / r). From
// above the pole it is the circle about it where lines touch the ellipse: at the height z = b^2 / r
// and the distance a sqrt(1 - b^2 / r^2) from the axis.
TEST(EllipsoidLimb, MatchesClosedFormsOfEquatorAndPole) {
  const double r = 6778e3;
  const Vec3 pole(0.0, 0.0, 1.0);
  EXPECT_NEAR(ellipsoid_limb_rad({r, 0, 0}, {0, 1, 0}, pole), std::asin(equator_m / r), 1e-12);
  const double z = polar_m * polar_m / r;
  const double off_axis = equator_m * std::sqrt(1.0 - polar_m * polar_m / (r * r));
  EXPECT_NEAR(ellipsoid_limb_rad({0, 0, r}, {1, 0, 0}, pole), std::atan(off_axis / (r - z)), 1e-9);
  // From over the equator toward the pole: the ellipse in that plane, touched at x = a^2 / r and
  // z = b sqrt(1 - a^2 / r^2).
  const double x = equator_m * equator_m / r;
  const double height = polar_m * std::sqrt(1.0 - equator_m * equator_m / (r * r));
  EXPECT_NEAR(ellipsoid_limb_rad({r, 0, 0}, {-0.5, 0, 0.8}, pole), std::atan(height / (r - x)),
              1e-9);
}

// A polar orbit in the plane of the Sun at the equinox: of a point Sun far away the shadow is a
// cylinder, in this plane a band of half the height b, the polar radius, which the spacecraft
// enters where r sin u = b, u from orbit midnight. A sphere of 6371 km would be 14 km higher: 5 s.
// The Sun's parallax is 0.04 s, and it moves 0.5 s worth of orbit in half a turn.
TEST(EllipsoidEclipse, OfAPolarOrbitIsWhereTheClosedFormHasIt) {
  // The Sun crosses the equator on 2026-03-20 at 14:46 UTC.
  const Instant equinox = *read_instant("2026-03-20T14:46:00", TimeSystem::Utc);
  const test::Ellipse orbit{.semi_major_m = 7000e3, .inclination_deg = 90.0, .node_deg = 0.0};
  const test::SceneFolder folder;
  folder.put("t.oem", test::oem_of(orbit, equinox, 60.0, 120));
  const auto half_span = [&](const std::string& shape) {
    const Scene scene = folder.read(
        "format = 1\n[orbit]\ntrajectory = \"t.oem\"\nearth_shape = \"" + shape + "\"\n");
    const Mission& mission = *mission_of(scene);
    const auto found = eclipses_between(mission, equinox, equinox + 7100.0, 0.0);
    EXPECT_EQ(found.size(), 1U);
    return 0.5 * (*found[0].umbra_end - *found[0].umbra_begin);
  };
  const double per_rad = 1.0 / orbit.mean_motion_rad_s();
  EXPECT_NEAR(half_span("ellipsoid"), std::asin(polar_m / orbit.semi_major_m) * per_rad, 1.0);
  EXPECT_NEAR(half_span("sphere"), std::asin(base::earth_radius_m / orbit.semi_major_m) * per_rad,
              1.0);
  EXPECT_NEAR(half_span("sphere") - half_span("ellipsoid"),
              (std::asin(base::earth_radius_m / 7000e3) - std::asin(polar_m / 7000e3)) * per_rad,
              0.05);
}

// Full Moon: 10^(-0.4 (26.74 - 12.73)) = 2.4889e-6 of the Sun's illuminance. At 90 deg the law has
// 0.026 90 + 4e-9 90^4 = 2.60244 magnitudes less. Twice as far is a quarter.
TEST(Moonlight, FollowsAllensPhaseLawAndTheInverseSquare) {
  const auto lx = [](double phase, double far) {
    return moon_illuminance_lx(Rgb(133100.0), phase, far * mean_moon_distance_m,
                               astronomical_unit_m)
        .r;
  };
  EXPECT_NEAR(lx(0.0, 1.0), 133100.0 * 2.4889e-6, 1e-5);
  EXPECT_NEAR(lx(90.0, 1.0) / lx(0.0, 1.0), std::pow(10.0, -0.4 * 2.60244), 1e-9);
  EXPECT_NEAR(lx(0.0, 2.0) / lx(0.0, 1.0), 0.25, 1e-12);
}

// The mission's Moon: full on 2026-03-03 at 11:38 UTC (a total lunar eclipse, phase within 0.5 deg
// of 0 as seen from the Earth's centre, 1.5 from a low orbit), new on 2026-03-19 at 01:23 UTC.
TEST(Moonlight, HasTheDatesOfFullAndNewMoon) {
  const test::SceneFolder folder;
  const auto phase = [&](const std::string& date) {
    const Instant t = *read_instant(date, TimeSystem::Utc);
    folder.put("t.oem", test::oem_of(test::Ellipse(), t, 60.0, 20));
    return folder.read("format = 1\n[moon]\n[orbit]\ntrajectory = \"t.oem\"\n").moon->phase_deg;
  };
  EXPECT_LT(phase("2026-03-03T11:38:00"), 2.0);
  EXPECT_GT(phase("2026-03-19T01:23:00"), 174.0);  // the Moon is up to 5.1 deg from the ecliptic
}

// Of the total eclipse of 2026 March 3 the Moon is in the penumbra from 8:44 to 14:23 UTC, in part
// in the umbra from 9:50, and whole from 11:04 to 12:03 (Espenak and Meeus, "Five millennium canon
// of lunar eclipses", NASA/TP-2009-214172). The share of its centre falls from 1 to 0 from 9:00 to
// 10:30 and is symmetric about 11:34. The full Moon of 2026 May 31, at 8:45, has no eclipse.
TEST(Moonlight, IsTheShareOfTheSunThatTheEarthLeavesTheMoon) {
  const test::SceneFolder folder;
  // Begins at the right ascension 220 deg, the Moon near 163 deg: not behind the Earth.
  const test::Ellipse ellipse{.node_deg = 220.0};
  const auto scene_at = [&](const std::string& date) {
    folder.put("t.oem", test::oem_of(ellipse, *read_instant(date, TimeSystem::Utc), 60.0, 20));
    return folder.read("format = 1\n[moon]\n[orbit]\ntrajectory = \"t.oem\"\n");
  };
  const auto share = [&](const std::string& date) {
    const Scene scene = scene_at(date);
    const Instant t = *read_instant(date, TimeSystem::Utc);
    const Vec3 moon = moon_position_m(t), sun = sun_direction(t) * sun_distance_m(t);
    const Vec3 away = moon - mission_of(scene)->trajectory->at(t).position_m;
    return scene.moon->illuminance_lx.g /
           moon_illuminance_lx(Sun().illuminance_lx, scene.moon->phase_deg, glm::length(away),
                               glm::length(sun - moon))
               .g;
  };
  for (const char* bright : {"2026-03-03T08:40:00", "2026-03-03T14:27:00", "2026-05-31T08:45:00"}) {
    EXPECT_NEAR(share(bright), 1.0, 1e-9) << bright;
  }
  for (const char* dark : {"2026-03-03T11:04:00", "2026-03-03T11:34:00", "2026-03-03T12:03:00"}) {
    EXPECT_EQ(share(dark), 0.0) << dark;
  }
  const double before = share("2026-03-03T10:00:00");
  EXPECT_GT(before, 0.05);
  EXPECT_LT(before, 0.95);
  EXPECT_NEAR(share("2026-03-03T13:07:30"), before, 0.05);
  const Scene eclipsed = scene_at("2026-03-03T11:34:00");
  for (const EffectRow& row : describe_effects(eclipsed, find_light_groups(eclipsed), {})) {
    if (row.effect != "distant lamps") continue;
    EXPECT_FALSE(row.runs);
    EXPECT_TRUE(test::holds(row.reason, {"0 of 1", "Earth's shadow"})) << row.reason;
  }
}

// 2026: perihelion January 3, 0.98330 au; aphelion July 6, 1.01664 au (US Naval Observatory). In
// low orbit the distance differs by up to 4.5e-5 of it.
TEST(Sunlight, FollowsItsDistanceByDateUnlessTheSceneGivesIt) {
  const test::SceneFolder folder;
  for (const auto& [date, units] :
       {std::pair("2026-01-03T17:16:00", 0.98330), {"2026-07-06T17:30:00", 1.01664}}) {
    folder.put("t.oem",
               test::oem_of(test::Ellipse(), *read_instant(date, TimeSystem::Utc), 60.0, 20));
    const std::string orbit = "[orbit]\ntrajectory = \"t.oem\"\n";
    const Sun open = *folder.read("format = 1\n" + orbit).sun;
    EXPECT_NEAR(open.illuminance_lx.g * units * units / 133100.0, 1.0, 1.2e-4);
    EXPECT_NEAR(open.angular_radius_deg * units / 0.2666, 1.0, 6e-5);
    const Sun bright = *folder.read("format = 1\n[sun]\nilluminance = 1000\n" + orbit).sun;
    EXPECT_EQ(bright.illuminance_lx, Rgb(1000.0));
    EXPECT_EQ(bright.angular_radius_deg, open.angular_radius_deg);
    const Sun wide = *folder.read("format = 1\n[sun]\nangular_radius_deg = 0.3\n" + orbit).sun;
    EXPECT_EQ(wide.illuminance_lx, open.illuminance_lx);
    EXPECT_EQ(wide.angular_radius_deg, 0.3);
  }
}

// A Lambert Earth by moonlight alone: at the point below the spacecraft, the Moon in the zenith and
// the Sun on the other side, L = albedo E / pi.
TEST(Moonlight, LightsTheEarthAsTheSunDoes) {
  const test::SceneFolder folder;
  const Scene scene = folder.read(
      "format = 1\n[sun]\ndirection = [0, 0, -1]\n[moon]\ndirection = [0, 0, 1]\nphase_deg = 10\n"
      "[earth]\ndirection = [0, 0, -1]\naltitude_km = 400\nalbedo = 0.3\n");
  ASSERT_EQ(scene.lamps.size(), 1U);
  EXPECT_EQ(scene.lamps[0].group, "moon");
  EXPECT_TRUE(earth_is_lit(scene));
  const Rgb radiance = earth_radiance(scene, {0, 0, -1});
  EXPECT_NEAR(radiance.g, 0.3 * scene.moon->illuminance_lx.g / base::pi, 1e-12);
}

TEST(AlbedoGridFile, IsBilinearAndPeriodicInLongitude) {
  const test::SceneFolder folder;
  folder.put("g.csv",
             "latitude_deg, -180, -90, 0, 90\n-30, 0.1, 0.2, 0.3, 0.4\n30, 0.5, 0.6, 0.7, 0.8\n");
  const AlbedoGrid grid = read_albedo_grid(folder.path() / "g.csv", {});
  const auto at = [&](double latitude, double longitude) {
    const double b = base::radians(latitude), l = base::radians(longitude);
    return grid.at({std::cos(b) * std::cos(l), std::cos(b) * std::sin(l), std::sin(b)});
  };
  EXPECT_NEAR(at(-30, 0), 0.3, 1e-12);
  EXPECT_NEAR(at(0, 45), 0.5 * (0.35 + 0.75), 1e-12);
  EXPECT_NEAR(at(-30, 135), 0.25, 1e-12);  // half way from 0.4 at 90 to 0.1 at 180
  EXPECT_NEAR(at(89, 0), 0.7, 1e-12);      // as the northernmost row
  folder.put("z.csv", "latitude_deg, albedo\n-90, 0.6\n0, 0.2\n");
  EXPECT_NEAR(read_albedo_grid(folder.path() / "z.csv", {}).at({1, 0, 0}), 0.2, 1e-12);
}

// The grid turns with the ground: below the spacecraft it has the point that inspect names.
TEST(AlbedoGridFile, IsTurnedUnderTheSpacecraft) {
  const test::SceneFolder folder;
  const Instant t = *read_instant("2026-03-01T12:00:00", TimeSystem::Utc);
  folder.put("t.oem", test::oem_of(test::Ellipse(), t, 60.0, 20));
  folder.put("g.csv",
             "latitude_deg, -180, -90, 0, 90\n-90, 0, 0.1, 0.2, 0.3\n90, 0, 0.1, 0.2, 0.3\n");
  const Scene scene = folder.read(
      "format = 1\n[orbit]\ntrajectory = \"t.oem\"\n[earth]\nalbedo_by = \"grid\"\n"
      "albedo_grid = \"g.csv\"\n[time]\nstart = \"2026-03-01T12:07:00\"\n");
  const MissionState state = mission_state(*mission_of(scene), mission_of(scene)->moment);
  const double longitude = state.below.longitude_deg;
  const Vec3 up = scene.earth->to_ground * -scene.earth->direction;
  EXPECT_NEAR(std::remainder(base::degrees(std::atan2(up.y, up.x)) - longitude, 360.0), 0.0, 1e-6);
  // Geocentric against geodetic latitude: at most 0.2 deg.
  EXPECT_NEAR(base::degrees(std::asin(up.z)), state.below.latitude_deg, 0.2);
}

// The shipped grid is Knocke's law at its nodes, to the file's four digits.
TEST(AlbedoGridFile, ShippedGridIsKnockesLaw) {
  const AlbedoGrid grid =
      read_albedo_grid(EARTHSHINE_SOURCE_DIR "/scenes/library/earth/albedo-zonal.csv", {});
  ASSERT_EQ(grid.latitudes().size(), 19U);
  for (std::size_t k = 0; k < grid.latitudes().size(); ++k) {
    const double s = std::sin(base::radians(grid.latitudes()[k]));
    EXPECT_NEAR(grid.values()[k], albedo_at(LatitudeAlbedo{}, s), 5e-5);
  }
}

TEST(AlbedoGridFile, BadFilesAreRefused) {
  const test::SceneFolder folder;
  const struct {
    const char* text;
    std::vector<std::string> says;
  } bad[] = {{"lat, 0\n0, 0.3\n", {"g.csv:1", "latitude_deg"}},
             {"latitude_deg, albedo\n0, 1.3\n", {"g.csv:2:4", "1.3", "from 0 to 1"}},
             {"latitude_deg, albedo\n10, 0.3\n-10, 0.3\n", {"g.csv:3:1", "-10 after 10"}},
             {"latitude_deg, 0, 90\n0, 0.3\n", {"g.csv:2", "2 columns", "names 3"}},
             {"latitude_deg, 0, 370\n", {"370"}},
             {"latitude_deg, albedo\n", {"no rows"}}};
  for (const auto& one : bad) {
    folder.put("g.csv", one.text);
    try {
      (void)read_albedo_grid(folder.path() / "g.csv", {});
      ADD_FAILURE() << one.text;
    } catch (const base::Error& error) {
      EXPECT_TRUE(test::holds(error.what(), one.says)) << error.what();
    }
  }
}

// A map of 4 x 2 pixels: rows from the north, columns from -180 deg, middles at 45 and 135 deg.
TEST(AlbedoGridFile, MapsOfPngAndExrAreTheGridOfTheirPixels) {
  const test::SceneFolder folder;
  const std::vector<std::uint8_t> bytes = {0, 51, 102, 153, 204, 255, 25, 75};
  std::vector<std::uint16_t> words;
  base::Image image{4, 2, {}};
  std::vector<float>& y = image.add("Y");
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    words.push_back(static_cast<std::uint16_t>(257 * bytes[k]));  // 65535 = 257 * 255
    y[k] = static_cast<float>(bytes[k] / 255.0);
  }
  base::write_png(folder.path() / "8.png", 4, 2, 1, bytes);
  base::write_png16(folder.path() / "16.png", 4, 2, words);
  base::write_exr(folder.path() / "y.exr", image);
  image.channels.clear();
  for (const char* name : {"R", "G", "B"}) {
    std::vector<float>& channel = image.add(name);
    for (std::size_t k = 0; k < bytes.size(); ++k)
      channel[k] = static_cast<float>(bytes[k] / 255.0);
  }
  base::write_exr(folder.path() / "rgb.exr", image);
  for (const char* name : {"8.png", "16.png", "y.exr", "rgb.exr"}) {
    const AlbedoGrid grid = read_albedo_grid(folder.path() / name, {});
    EXPECT_EQ(grid.latitudes(), (std::vector<double>{-45.0, 45.0})) << name;
    EXPECT_EQ(grid.longitudes(), (std::vector<double>{-135.0, -45.0, 45.0, 135.0})) << name;
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(grid.values()[4 + k], bytes[k] / 255.0, 1e-7) << name;  // north
      EXPECT_NEAR(grid.values()[k], bytes[4 + k] / 255.0, 1e-7) << name;
    }
  }
  // 16 bits are not rounded to 8.
  words.assign(8, 12345);
  base::write_png16(folder.path() / "16.png", 4, 2, words);
  EXPECT_NEAR(read_albedo_grid(folder.path() / "16.png", {}).values()[0], 12345 / 65535.0, 1e-15);
}

TEST(AlbedoGridFile, BadMapsAreRefused) {
  const test::SceneFolder folder;
  base::write_png(folder.path() / "rgb.png", 1, 1, 3, std::vector<std::uint8_t>{1, 2, 3});
  base::write_png(folder.path() / "cut.png", 64, 64, 1, std::vector<std::uint8_t>(4096, 7));
  std::filesystem::resize_file(folder.path() / "cut.png", 60);
  folder.put("text.png", "latitude_deg, albedo\n");
  base::Image image{2, 1, {}};
  image.add("Y") = {0.5F, 1.5F};
  base::write_exr(folder.path() / "high.exr", image);
  image.channels.clear();
  for (const char* name : {"R", "G", "B"}) image.add(name)[0] = name[0] == 'R' ? 1.0F : 0.5F;
  base::write_exr(folder.path() / "red.exr", image);
  base::ExrHeader part;
  part.whole = {image.width, image.height + 1, 0, 0};
  base::write_exr(folder.path() / "part.exr", image, part);
  const struct {
    const char* file;
    std::vector<std::string> says;
  } bad[] = {{"rgb.png", {"rgb.png", "no plain grey", "8 or 16 bits"}},
             {"cut.png", {"cut.png", "broken PNG"}},
             {"text.png", {"text.png", "broken PNG"}},
             {"high.exr", {"high.exr", "1.5 at column 1, row 0", "from 0 to 1"}},
             {"red.exr", {"red.exr", "channels", "equal"}},
             {"part.exr", {"part.exr", "whole Earth"}},
             {"none.exr", {"none.exr"}}};
  for (const auto& one : bad) {
    try {
      (void)read_albedo_grid(folder.path() / one.file, {});
      ADD_FAILURE() << one.file;
    } catch (const base::Error& error) {
      EXPECT_TRUE(test::holds(error.what(), one.says)) << error.what();
    }
  }
}

// An even disc of radiance L and half angle a gives pi L sin^2 a on a plate that faces it.
TEST(Airglow, LightsAPlateAsAnEvenDiscAndIsOffByDay) {
  const test::SceneFolder folder;
  const auto scene = [&](const char* sun) {
    return folder.read(std::string("format = 1\n[earth]\ndirection = [0.6, 0, 0.8]\n"
                                   "altitude_km = 425\n[airglow]\nradiance = 0.001\n[sun]\n") +
                       sun);
  };
  const Scene dark = scene("direction = [0.6, 0, 0.8]\n");
  const Scene day = scene("direction = [-0.6, 0, -0.8]\n");
  Rgb on_plate(0.0);
  for (const Lamp& lamp : dark.lamps) {
    EXPECT_EQ(lamp.group, "airglow");
    on_plate += -glm::dot(lamp.axis, dark.earth->direction) * lamp.illuminance_lx;
  }
  const double sine = std::sin(base::radians(dark.earth->half_angle_deg));
  EXPECT_NEAR(on_plate.g, base::pi * 0.001 * sine * sine, 1e-12);
  for (const Lamp& lamp : day.lamps) EXPECT_EQ(lamp.illuminance_lx, Rgb(0.0));
  EXPECT_TRUE(test::holds(folder.refusal("format = 1\n[airglow]\n"), {"[airglow]", "[earth]"}));
  const auto reason = [](const Scene& of) {
    for (const EffectRow& row : describe_effects(of, find_light_groups(of), {})) {
      if (row.effect == "distant lamps") return row.reason;
    }
    return std::string();
  };
  EXPECT_TRUE(test::holds(reason(day), {"0 of 16", "airglow is off", "the Sun lights"}));
  EXPECT_EQ(reason(dark), "16 of 16 with type = \"distant\" are lit");
}

}  // namespace
}  // namespace earthshine::scenes
