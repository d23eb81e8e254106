// SPDX-License-Identifier: Apache-2.0
// Valid input that is almost certainly a mistake gives one warning with a remedy; similar intended
// input gives none.
#include "scenes/plausible/plausible.h"

#include <fmt/format.h>

#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

const std::string materials =
    "format = 1\n[[material]]\nname = \"w\"\ndiffuse = 0.5\n"
    "[[material]]\nname = \"sheet\"\ndiffuse = 0.5\ntwo_sided = true\n";

std::string body_of(const std::string& name, const std::string& low, const std::string& high,
                    const std::string& more = "material = \"w\"\n") {
  return fmt::format("[[object]]\nname = \"{}\"\nshape = \"box\"\nmin = {}\nmax = {}\n{}", name,
                     low, high, more);
}

// A square of this half edge about the z axis, its front up.
std::string plate(const std::string& name, double half, double z,
                  const std::string& more = "material = \"w\"\n") {
  return fmt::format(
      "[[object]]\nname = \"{0}\"\nshape = \"quad\"\ncorners = [[-{1}, -{1}, {2}], [{1}, -{1}, "
      "{2}], "
      "[{1}, {1}, {2}], [-{1}, {1}, {2}]]\n{3}",
      name, half, z, more);
}

std::string point_lamp(const std::string& position) {
  return "[[light]]\nname = \"L\"\ntype = \"point\"\nposition = " + position +
         "\nintensity = 100\n";
}

std::string camera_at(const std::string& position, const std::string& look_at,
                      const std::string& more = "") {
  return "[[camera]]\nname = \"A\"\nposition = " + position + "\nlook_at = " + look_at + "\n" +
         more;
}

const std::string from_above = camera_at("[0.4, 0.3, 3]", "[0, 0, 0]");

std::vector<std::string> found_in(const std::string& text, const SceneUse& use = {}) {
  const Scene scene = test::SceneFolder().read(text);
  return implausible_input(scene, RayQuery(scene), use);
}

void expect_one(const std::string& text, const std::vector<std::string>& parts,
                const SceneUse& use = {}) {
  const std::vector<std::string> found = found_in(text, use);
  ASSERT_EQ(found.size(), 1U) << fmt::format("{}", fmt::join(found, "\n"));
  EXPECT_TRUE(holds(found.front(), parts)) << found.front();
}

void expect_none(const std::string& text, const SceneUse& use = {}) {
  const std::vector<std::string> found = found_in(text, use);
  EXPECT_TRUE(found.empty()) << text << fmt::format("{}", fmt::join(found, "\n"));
}

// The housing has winding number 1 about the lamp: every ray from it first hits a back.
TEST(Plausible, ALampInAClosedHousingIsNamed) {
  const std::string lit = materials + plate("floor", 2, 0) + from_above;
  for (const char* lamp :
       {"type = \"point\"\nposition = [0, 0, 2]\nintensity = 100\n",
        "type = \"spot\"\nposition = [0, 0, 2]\naim = [0, 0, 0]\nbeam_deg = 20\nfield_deg = 60\n"
        "flux = 100\n",
        "type = \"disk\"\ncenter = [0, 0, 2]\nnormal = [0, 0, -1]\nradius = 0.05\nexitance = 10\n",
        "type = \"rectangle\"\ncenter = [0, 0, 2]\nedge_u = [0.1, 0, 0]\nedge_v = [0, -0.1, 0]\n"
        "flux = 10\n"}) {
    const std::string text = lit + "[[light]]\nname = \"L\"\n" + lamp;
    expect_none(text);
    expect_one(text + body_of("housing", "[-0.1, -0.1, 1.9]", "[0.1, 0.1, 2.1]"),
               {"all light of lamp \"L\"", "black back", "\"housing\"", "inward"});
    // An open luminaire, and a glass bulb.
    expect_none(text +
                "[[object]]\nname = \"shade\"\nshape = \"cylinder\"\nfrom = [0, 0, 1.9]\n"
                "to = [0, 0, 2.2]\nradius = 0.1\ncaps = false\nmaterial = \"sheet\"\n");
    expect_none(text + "[[material]]\nname = \"glass\"\ntransmit = 0.9\n" +
                body_of("bulb", "[-0.1, -0.1, 1.9]", "[0.1, 0.1, 2.1]", "material = \"glass\"\n"));
  }
}

TEST(Plausible, AnEmittingObjectInAClosedHousingIsNamed) {
  const std::string lit =
      materials + plate("floor", 2, 0) + from_above +
      "[[material]]\nname = \"glow\"\nemit = 100\n" +
      "[[object]]\nname = \"bulb\"\nshape = \"sphere\"\ncenter = [0, 0, 2]\nradius = 0.05\n"
      "material = \"glow\"\n";
  expect_none(lit);
  expect_one(lit + body_of("housing", "[-0.1, -0.1, 1.9]", "[0.1, 0.1, 2.1]"),
             {"all light of the emitting object \"bulb\"", "\"housing\""});
}

// Half of the light goes up, to the liner's back, the other half down and out: the camera above the
// liner sees none of it. A second lamp above it is not needed.
TEST(Plausible, ALampBehindALinerIsNamed) {
  const std::string lit = materials + plate("liner", 5, 0) + from_above;
  expect_none(lit + point_lamp("[0, 0, 0.3]"));
  expect_one(lit + point_lamp("[0, 0, -0.3]"), {"of the light of lamp \"L\"", "\"liner\"", "none"});
  // The hull behind the liner is lit, but no camera sees it.
  expect_one(
      lit + point_lamp("[0, 0, -0.3]") + plate("hull", 5, -1),
      {"of the light of lamp \"L\"", "\"liner\"", "none comes to a place that a camera sees"});
  // Another camera sees it.
  expect_none(lit + point_lamp("[0, 0, -0.3]") + plate("hull", 5, -1) +
              "[[camera]]\nname = \"B\"\nposition = [3, 0, -0.5]\nlook_at = [0, 0, -1]\n");
}

TEST(Plausible, AMaterialThatDoesNothingIsNamed) {
  const auto wearing = [](const std::string& keys) {
    return materials + "[[material]]\nname = \"m\"\n" + keys + plate("floor", 2, 0) +
           plate("pane", 1, 1, "material = \"m\"\n") + point_lamp("[0, 0, 2]") + from_above;
  };
  expect_one(wearing("transmit = 1\n"), {"\"m\"", "neither reflects nor stops light", "Tr 1"});
  for (const char* meant :
       {"transmit = 0.9\n", "transmit = [1, 0.5, 0]\n", "transmit = 1\nior = 1.5\n",
        "transmit = 0.9\nmirror = 0.1\n", "diffuse = 0\n"}) {
    expect_none(wearing(meant));
  }
}

// 410 km are 410000 m. The altitude of GEO is 35786 km.
TEST(Plausible, AnAltitudeInMetresIsNamed) {
  const auto at = [](const char* altitude) {
    return materials + plate("floor", 2, 0) + from_above + "[orbit]\naltitude_km = " + altitude +
           "\n";
  };
  expect_one(at("410000"), {"[orbit]", "altitude_km = 410000", "altitude_km = 410"});
  for (const char* meant : {"410", "2000", "35786"}) expect_none(at(meant));
  expect_one(materials + plate("floor", 2, 0) + from_above +
                 "[sun]\ndirection = [0, 0, 1]\n[earth]\ndirection = [0, 0, -1]\n"
                 "altitude_km = 400000\n",
             {"[earth]", "altitude_km = 400"});
}

// From 10000 km the Earth's half angle is asin(6371 / 16371) = 22.9 deg, the Sun's 0.27 deg.
TEST(Plausible, ASunBehindTheEarthIsNamed) {
  const auto at = [](double separation_deg) {
    const double angle = base::radians(separation_deg);
    return materials + plate("floor", 2, 0) + from_above + point_lamp("[0, 0, 2]") +
           fmt::format(
               "[sun]\ndirection = [0, 0, 1]\n[earth]\ndirection = [0, {}, {}]\n"
               "altitude_km = 10000\n",
               std::sin(angle), std::cos(angle));
  };
  expect_one(at(10.0), {"the Earth hides all of the Sun", "sunlight is meant"});
  expect_one(at(22.9), {"of the Sun"});
  expect_none(at(24.0));
  const std::string orbit = materials + plate("floor", 2, 0) + from_above +
                            "[orbit]\naltitude_km = 400\nposition_deg = 180\n";
  expect_one(orbit, {"the Earth hides all of the Sun", "position_deg", "109.5 to 250.5"});
  expect_none(orbit + point_lamp("[0, 0, 2]"));  // night is intended
  SceneUse along;
  along.moves_along_orbit = true;
  expect_none(orbit, along);
}

TEST(Plausible, DarknessIsNamed) {
  const std::string dark = materials + plate("floor", 2, 0) + from_above;
  expect_one(dark, {"nothing gives light", "[[light]]"});
  expect_none(dark + "[ambient]\nradiance = 1\n");
  SceneUse geometry;
  geometry.lights = false;
  expect_none(dark, geometry);
}

TEST(Plausible, AFieldInRadiansIsNamed) {
  const auto with = [](const std::string& field, double half) {
    return materials + plate("floor", half, 0) + point_lamp("[0, 0, 2]") +
           camera_at("[0.4, 0.3, 3]", "[0, 0, 0]", "fov_deg = " + field + "\n");
  };
  // 0.87 rad are 49.8 deg; 3 m away 0.87 deg are 46 mm.
  expect_one(with("0.87", 2.0), {"\"A\"", "fov_deg = 0.87", "49.8"});
  expect_one(with("1.5708", 2.0), {"90"});
  // A telephoto lens shows a plate of 20 mm completely.
  expect_none(with("0.87", 0.01));
  expect_none(with("20", 2.0));
  expect_none(with("0.1", 2.0));
}

TEST(Plausible, WidePixelsOfACctvCameraAreNamed) {
  const auto with = [](const std::string& fx, const std::string& more) {
    return materials + plate("floor", 2, 0) + point_lamp("[0, 0, 2]") +
           camera_at("[0.4, 0.3, 3]", "[0, 0, 0]", "fx = " + fx + "\nfy = 20\n" + more);
  };
  const std::string cctv = "cctv = \"plain\"\n[[cctv]]\nname = \"plain\"\n";
  expect_one(with("16", cctv), {"\"A\"", "1.25 times as wide as high", "fx = fy"});
  expect_none(with("20.1", cctv));
  expect_none(with("16", ""));
}

// A bay of 12 m whose unit is "mm".
TEST(Plausible, ABayOfMillimetresIsNamed) {
  const auto scaled = [](double scale) {
    std::string text = materials;
    text.insert(text.find("[[material]]"), scale < 1.0 ? "unit = \"mm\"\n" : "");
    return text + plate("floor", 6, 0) + point_lamp("[0, 0, 2]") + from_above;
  };
  expect_one(scaled(0.001), {"mm across", "camera \"A\"", "unit"});
  expect_none(scaled(1.0));
  // Without a camera the surfaces count; a small object in a large room is intended.
  expect_one(materials + plate("chip", 0.01, 0) + point_lamp("[0, 0, 2]"),
             {"28 mm across", "unit"});
  expect_none(materials + plate("chip", 0.01, 0) + point_lamp("[0, 0, 2]") + from_above);
}

TEST(Plausible, ACameraInOrRightBehindASurfaceIsNamed) {
  const auto at = [](const std::string& z, const std::string& material) {
    return materials + body_of("wall", "[-5, -5, -0.05]", "[5, 5, 0.05]", material) +
           plate("far", 2, 4, material) + point_lamp("[0, 0, 2]") +
           camera_at("[0.5, 0.5, " + z + "]", "[0.5, 0.3, 5]");
  };
  const std::string sheet = "material = \"sheet\"\n";
  for (const char* z : {"0", "0.04", "-0.06"}) {
    expect_one(at(z, sheet),
               {"camera \"A\" is inside, right behind or right before the object \"wall\""});
  }
  expect_none(at("0.06", sheet));
}

TEST(Plausible, AViewOfBacksIsNamedWithTheTurnThatMendsIt) {
  const auto liner = [](const std::string& more) {
    return materials +
           "[[object]]\nname = \"liner\"\nshape = \"cylinder\"\nfrom = [-3, 0, 0]\nto = [3, 0, 0]\n"
           "radius = 2\ncaps = false\nmaterial = \"w\"\n" +
           more + point_lamp("[0, 0, 0]") + camera_at("[-2.5, 0, 0.5]", "[2, 0, -1]");
  };
  // Its lamp's light ends on the backs too.
  const std::vector<std::string> found = found_in(liner(""));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_TRUE(holds(found[0], {"most of what camera \"A\" sees (100 %)", "\"liner\"",
                               "orient = \"inward\"", "two-sided"}))
      << found[0];
  for (const char* mended :
       {"orient = \"inward\"\n", "orient = \"two-sided\"\n", "inward = true\n"}) {
    expect_none(liner(mended));
  }
}

}  // namespace
}  // namespace earthshine::scenes
