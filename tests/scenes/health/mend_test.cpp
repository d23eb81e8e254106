// SPDX-License-Identifier: Apache-2.0
// Faults of meshes, put in by hand: what is mended, what is named, what is left alone.
#include "scenes/health/mend.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "scenes/health/topology.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

// The unit cube's corners and its faces, outward.
constexpr const char* corners =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";
constexpr std::array<std::array<int, 4>, 6> cube = {
    {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}}};

std::string face(const std::array<int, 4>& f, bool turned = false, int start = 0) {
  std::string text = "f";
  for (int k = 0; k < 4; ++k) {
    const int at = ((turned ? 3 - k : k) + start) % 4;
    text += fmt::format(" {}", f[static_cast<std::size_t>(at)]);
  }
  return text + "\n";
}

// turned: by face.
std::string cube_obj(const std::array<bool, 6>& turned, std::size_t faces = 6) {
  std::string text = corners;
  for (std::size_t k = 0; k < faces; ++k) text += face(cube[k], turned[k]);
  return text;
}
constexpr std::array<bool, 6> none{}, all = {true, true, true, true, true, true};

std::string scene_of(const std::string& more = "", const std::string& camera = "[5, 5, 5]") {
  return "format = 1\n[[material]]\nname = \"white\"\ndiffuse = 0.5\n[[material]]\nname = \"red\"\n"
         "diffuse = [0.5, 0.1, 0.1]\n[[camera]]\nname = \"A\"\nposition = " +
         camera +
         "\nlook_at = [0.5, 0.5, 0.4]\n[[object]]\nname = \"body\"\nmesh = \"a.obj\"\n"
         "material = \"white\"\n" +
         more;
}

Scene read(const std::string& obj, const std::string& toml = scene_of(),
           const std::string& second = "") {
  const test::SceneFolder folder;
  folder.put("a.obj", obj);
  if (!second.empty()) folder.put("b.obj", second);
  return folder.read(toml);
}

// By the divergence theorem, a sixth of the sum of a (b x c): 1 for the cube outward.
double volume(const Scene& scene) {
  double sum = 0.0;
  for (const Triangle& t : scene.triangles) {
    const Vec3 &a = scene.vertices[t.vertex[0]], &b = scene.vertices[t.vertex[1]],
               &c = scene.vertices[t.vertex[2]];
    sum += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return sum;
}

std::string warnings(const Scene& scene) {
  std::string text;
  for (const std::string& warning : scene.warnings) text += warning + "\n";
  return text;
}

TEST(Mend, ASoundCubeIsLeftAlone) {
  const Scene scene = read(cube_obj(none));
  EXPECT_EQ(warnings(scene), "");
  EXPECT_EQ(scene.triangles.size(), 12U);
  EXPECT_NEAR(volume(scene), 1.0, 1e-15);
  const SurfaceHealth health = surface_health(scene).front();
  EXPECT_EQ(health.parts, 1U);
  EXPECT_EQ(health.closed_parts, 1U);
  EXPECT_EQ(
      health.inward_parts + health.open_edges + health.non_manifold_edges + health.mixed_edges, 0U);
}

TEST(Mend, ABodyInsideOutIsTurnedOutwardAndSaysSo) {
  const Scene scene = read(cube_obj(all));
  EXPECT_NEAR(volume(scene), 1.0, 1e-15);
  EXPECT_TRUE(holds(warnings(scene), {"\"body\"", "inside out", "as-is"})) << warnings(scene);
  // Parallelograms stay (0,1,2), (0,2,3) of their corners: the diagonal is the first's last edge
  // and the second's first.
  for (std::size_t t = 0; t < scene.triangles.size(); t += 2) {
    EXPECT_EQ(scene.triangles[t].vertex[0], scene.triangles[t + 1].vertex[0]);
    EXPECT_EQ(scene.triangles[t].vertex[2], scene.triangles[t + 1].vertex[1]);
  }
}

TEST(Mend, FacesWoundAgainstTheirNeighboursAreTurned) {
  for (const std::array<bool, 6>& turned : {std::array<bool, 6>{true},
                                            {false, true, false, false, true},
                                            {true, true, true, true, true}}) {
    const Scene scene = read(cube_obj(turned));
    EXPECT_NEAR(volume(scene), 1.0, 1e-15);
    EXPECT_TRUE(holds(warnings(scene), {"wound against their neighbours"})) << warnings(scene);
    EXPECT_EQ(surface_health(scene).front().mixed_edges, 0U);
  }
}

TEST(Mend, ARoomStaysARoom) {
  // A camera, a lamp or another object inside: the inside is what is looked at.
  EXPECT_NEAR(volume(read(cube_obj(all), scene_of("", "[0.2, 0.3, 0.6]"))), -1.0, 1e-15);
  const std::string lamp =
      "[[light]]\nname = \"l\"\ntype = \"point\"\nposition = [0.5, 0.5, 0.5]\nflux = 1\n";
  EXPECT_NEAR(volume(read(cube_obj(all), scene_of(lamp))), -1.0, 1e-15);
  const std::string ball =
      "[[object]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = [0.5, 0.5, 0.5]\nradius = 0.1\n"
      "material = \"white\"\n";
  const Scene scene = read(cube_obj(all), scene_of(ball));
  EXPECT_LT(volume(scene), -0.99);
  EXPECT_EQ(warnings(scene), "");
  EXPECT_EQ(surface_health(scene).front().inward_parts, 1U);
}

TEST(Mend, ACavityStaysACavity) {
  // A cube with a cube of half the edge inside it, whose faces look into the hole: 1 - 1/8.
  std::string obj = cube_obj(none) +
                    "v 0.25 0.25 0.25\nv 0.75 0.25 0.25\nv 0.25 0.75 0.25\nv 0.75 "
                    "0.75 0.25\nv 0.25 0.25 0.75\nv 0.75 0.25 0.75\nv 0.25 0.75 "
                    "0.75\nv 0.75 0.75 0.75\n";
  for (std::array<int, 4> f : cube) {
    for (int& corner : f) corner += 8;
    obj += face(f, true);
  }
  const Scene scene = read(obj);
  EXPECT_NEAR(volume(scene), 0.875, 1e-15);
  EXPECT_EQ(warnings(scene), "");
}

TEST(Mend, OrientDecidesWhereTheFileDoesNot) {
  EXPECT_NEAR(volume(read(cube_obj(all), scene_of("orient = \"as-is\"\n"))), -1.0, 1e-15);
  EXPECT_NEAR(volume(read(cube_obj(all), scene_of("inward = true\n"))), 1.0, 1e-15);
  // Told to be outward, also a room.
  EXPECT_NEAR(volume(read(cube_obj(all), scene_of("orient = \"outward\"\n", "[0.2, 0.3, 0.6]"))),
              1.0, 1e-15);
  const Scene sheets = read(cube_obj(all), scene_of("orient = \"two-sided\"\n"));
  EXPECT_NEAR(volume(sheets), -1.0, 1e-15);
  for (const Triangle& triangle : sheets.triangles) {
    EXPECT_TRUE(sheets.materials[triangle.material].two_sided);
  }
  // An open box with one face wound against the others: named, and turned when told to.
  const std::array<bool, 6> one = {true};
  const Scene open = read(cube_obj(one, 5));
  EXPECT_TRUE(holds(warnings(open), {"open surfaces", "orient = \"outward\"", "two-sided"}))
      << warnings(open);
  EXPECT_GT(surface_health(open).front().mixed_edges, 0U);
  const Scene told = read(cube_obj(one, 5), scene_of("orient = \"outward\"\n"));
  EXPECT_EQ(surface_health(told).front().mixed_edges, 0U);
  // Five outward faces about the middle have 5 of the cube's 6 pyramids; the sixth is the
  // opening's, x = 1, whose a (b x c) / 6 about the corner at 0 is a third: 1 - 1/3.
  EXPECT_NEAR(volume(told), 1.0 - 1.0 / 3.0, 1e-15);
  const test::SceneFolder folder;
  folder.put("a.obj", cube_obj(none));
  EXPECT_TRUE(holds(folder.refusal(scene_of("inward = true\norient = \"outward\"\n")),
                    {"scene.toml:", "orient", "inward = true"}));
}

TEST(Mend, FacesThatStandTwiceAreKeptOnce) {
  // The same corners from another one on; as quadrilateral and as the same once more.
  const std::string quad = std::string(corners) + face(cube[0]);
  for (const int start : {0, 1, 2, 3}) {
    const Scene scene = read(quad + face(cube[0], false, start));
    EXPECT_EQ(scene.triangles.size(), 2U);
    EXPECT_EQ(scene.objects.front().polygon_count, 1U);
    EXPECT_NEAR(scene.objects.front().area_m2, 1.0, 1e-15);
    EXPECT_TRUE(holds(warnings(scene), {"\"body\"", "stood twice"})) << warnings(scene);
  }
}

TEST(Mend, BackToBackFacesAreOneSheet) {
  for (const int start : {0, 1, 2, 3}) {
    const Scene scene =
        read(std::string(corners) + face(cube[0]) + face(cube[0], true, start) + face(cube[1]));
    ASSERT_EQ(scene.triangles.size(), 4U);
    EXPECT_NEAR(scene.objects.front().area_m2, 2.0, 1e-15);
    EXPECT_TRUE(scene.materials[scene.triangles[0].material].two_sided);
    EXPECT_TRUE(scene.materials[scene.triangles[1].material].two_sided);
    EXPECT_FALSE(scene.materials[scene.triangles[2].material].two_sided);
    EXPECT_EQ(scene.materials[scene.triangles[0].material].diffuse, Rgb(0.5));
    EXPECT_TRUE(holds(warnings(scene), {"back to back", "two-sided"})) << warnings(scene);
  }
}

TEST(Mend, FacesOfOtherMaterialsOnEachOtherAreNamedAndLeft) {
  const std::string red =
      "[[object]]\nname = \"paint\"\nmesh = \"b.obj\"\nmaterial = \"red\"\norient = \"as-is\"\n";
  const std::string quad = std::string(corners) + face(cube[0]);
  const Scene scene = read(quad, scene_of(red), quad);
  EXPECT_EQ(scene.triangles.size(), 4U);
  EXPECT_TRUE(holds(warnings(scene), {"\"body\"", "\"paint\"", "another material"}))
      << warnings(scene);
}

// Two cubes side by side have a face each at x = 1, against each other: 2 of volume, nothing to
// say.
TEST(Mend, BodiesMayTouch) {
  for (const char* material : {"white", "red"}) {
    const std::string beside = fmt::format(
        "[[object]]\nname = \"beside\"\nmesh = \"b.obj\"\ntranslate = [1, 0, 0]\n"
        "material = \"{}\"\n",
        material);
    const Scene scene = read(cube_obj(none), scene_of(beside), cube_obj(none));
    EXPECT_EQ(warnings(scene), "");
    EXPECT_EQ(scene.triangles.size(), 24U);
    EXPECT_NEAR(volume(scene), 2.0, 1e-15);
  }
}

// A body each of whose faces stands there with both windings has no inside: six sheets.
TEST(Mend, ABodyWithBothWindingsIsOfSheets) {
  std::string obj = cube_obj(none);
  for (const auto& f : cube) obj += face(f, true, 1);
  const Scene scene = read(obj);
  EXPECT_EQ(scene.triangles.size(), 12U);
  for (const Triangle& triangle : scene.triangles) {
    EXPECT_TRUE(scene.materials[triangle.material].two_sided);
  }
  EXPECT_TRUE(holds(warnings(scene), {"6 faces stood back to back"})) << warnings(scene);
}

TEST(Mend, AnObjectThatStandsTwiceIsRefused) {
  const std::string again =
      "[[object]]\nname = \"again\"\nmesh = \"b.obj\"\nmaterial = \"white\"\n";
  const test::SceneFolder folder;
  folder.put("a.obj", cube_obj(none));
  folder.put("b.obj", cube_obj(none));
  EXPECT_TRUE(holds(folder.refusal(scene_of(again)), {"\"again\"", "same place", "Remove"}));
}

// Four corners in another order enclose another area: a bow tie's halves are no quadrilateral.
TEST(Mend, TheSameCornersAreNotYetTheSameFace) {
  const std::string fan = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 0.5 0\n";
  const Scene scene = read(fan + "f 1 2 3 4 5\nf 1 5 2 3 4\n");
  EXPECT_EQ(scene.objects.front().polygon_count, 2U);
  EXPECT_EQ(warnings(scene).find("stood"), std::string::npos) << warnings(scene);
}

// A strip of three quadrilaterals closed with half a turn.
TEST(Mend, ASurfaceWithoutTwoSidesIsNamed) {
  const std::string strip =
      "v 0 0 0\nv 0 0 1\nv 2 0 0\nv 2 0 1\nv 1 2 0\nv 1 2 1\nf 1 3 4 2\nf 3 5 6\nf 3 6 4\nf 5 2 "
      "1\nf 5 "
      "1 6\n";
  EXPECT_TRUE(holds(warnings(read(strip)), {"no two sides", "two-sided"})) << warnings(read(strip));
}

TEST(Mend, AForgottenUnitIsSuspected) {
  EXPECT_TRUE(
      holds(warnings(read(cube_obj(none), scene_of("scale = 1000\n"))), {"unit", "m across"}));
  EXPECT_TRUE(
      holds(warnings(read(cube_obj(none), scene_of("scale = 0.001\n"))), {"unit", "m across"}));
}

TEST(Surrounds, TheSolidAnglesSayIt) {
  const Scene scene = read(cube_obj(none));
  const SurfacePart part = surface_parts(scene, scene.objects[0], welded(scene.vertices)).front();
  EXPECT_TRUE(surrounds(scene, part, {0.01, 0.5, 0.99}));
  EXPECT_FALSE(surrounds(scene, part, {-0.01, 0.5, 0.5}));
  EXPECT_FALSE(surrounds(scene, part, {5.0, 0.5, 0.5}));
}

}  // namespace
}  // namespace earthshine::scenes
