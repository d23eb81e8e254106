// SPDX-License-Identifier: Apache-2.0
// Deliberate mesh faults: which are repaired, which are named, which are left.
#include "scenes/health/mend.h"

#include <array>
#include <cmath>

#include "scenes/health/topology.h"
#include "tests/scenes/cube_scenes.h"

namespace earthshine::scenes {
namespace {

using test::all;
using test::corners;
using test::cube;
using test::cube_obj;
using test::face;
using test::holds;
using test::none;
using test::read;
using test::scene_of;
using test::volume;
using test::warnings;

TEST(Mend, ASoundCubeIsLeftAlone) {
  const Scene scene = read(cube_obj(none));
  EXPECT_EQ(warnings(scene), "");
  EXPECT_EQ(scene.triangles.size(), 12U);
  EXPECT_NEAR(volume(scene), 1.0, 1e-15);
  const SurfaceHealth health = scene.objects.front().surface;
  EXPECT_EQ(health.parts, 1U);
  EXPECT_EQ(health.closed_parts, 1U);
  EXPECT_EQ(
      health.inward_parts + health.open_edges + health.non_manifold_edges + health.mixed_edges, 0U);
}

TEST(Mend, ABodyInsideOutIsTurnedOutwardAndSaysSo) {
  const Scene scene = read(cube_obj(all));
  EXPECT_NEAR(volume(scene), 1.0, 1e-15);
  EXPECT_TRUE(holds(warnings(scene), {"\"body\"", "inside out", "as-is"})) << warnings(scene);
  // Parallelograms stay (0,1,2), (0,2,3) of their corners: the diagonal is the first triangle's
  // last edge and the second's first.
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
    EXPECT_EQ(scene.objects.front().surface.mixed_edges, 0U);
  }
}

TEST(Mend, ARoomStaysARoom) {
  // With a camera, a lamp or another object inside, the faces are oriented inward.
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
  EXPECT_EQ(scene.objects.front().surface.inward_parts, 1U);
}

TEST(Mend, ACavityStaysACavity) {
  // A cube with a hollow cube of half the edge inside it, faces toward the cavity: 1 - 1/8.
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
  // Explicitly outward, even for a room.
  EXPECT_NEAR(volume(read(cube_obj(all), scene_of("orient = \"outward\"\n", "[0.2, 0.3, 0.6]"))),
              1.0, 1e-15);
  const Scene sheets = read(cube_obj(all), scene_of("orient = \"two-sided\"\n"));
  EXPECT_NEAR(volume(sheets), -1.0, 1e-15);
  for (const Triangle& triangle : sheets.triangles) {
    EXPECT_TRUE(sheets.materials[triangle.material].two_sided);
  }
  // An open box with one reversed face: named, and reoriented on request.
  const std::array<bool, 6> one = {true};
  const Scene open = read(cube_obj(one, 5));
  EXPECT_TRUE(
      holds(warnings(open), {"wound against each other", "orient = \"inward\"", "two-sided"}))
      << warnings(open);  // the camera sees its inside through the opening, x = 1
  const std::string behind = warnings(read(cube_obj(one, 5), scene_of("", "[-5, 0.5, 0.5]")));
  EXPECT_TRUE(holds(behind, {"wound against each other", "orient = \"outward\""})) << behind;
  EXPECT_GT(open.objects.front().surface.mixed_edges, 0U);
  const Scene told = read(cube_obj(one, 5), scene_of("orient = \"outward\"\n"));
  EXPECT_EQ(told.objects.front().surface.mixed_edges, 0U);
  // Five outward faces give 5 of the cube's 6 pyramids about the middle; the sixth is the
  // opening's, x = 1. About the corner at 0 its a (b x c) / 6 is a third: 1 - 1/3.
  EXPECT_NEAR(volume(told), 1.0 - 1.0 / 3.0, 1e-15);
  const test::SceneFolder folder;
  folder.put("a.obj", cube_obj(none));
  EXPECT_TRUE(holds(folder.refusal(scene_of("inward = true\norient = \"outward\"\n")),
                    {"scene.toml:", "orient", "inward = true"}));
}

TEST(Mend, ARoomWithAWindowOrALampOnItsCeilingIsARoom) {
  std::string obj = cube_obj(all, 5) + "usemtl pane\n" + face(cube[5], true);
  std::string text = scene_of();
  text.insert(text.find("[[camera]]"),
              "[[material]]\nname = \"pane\"\ndiffuse = 0\ntransmit = 0.9\n");
  text.erase(text.find("material = \"white\"\n"), 19);
  obj.insert(obj.find("f "), "usemtl white\n");
  EXPECT_NEAR(volume(read(obj, text)), -1.0, 1e-15);
  const std::string lamp =
      "[[light]]\nname = \"l\"\ntype = \"point\"\nposition = [0.5, 0.5, 1]\nflux = 1\n";
  EXPECT_NEAR(volume(read(cube_obj(all), scene_of(lamp))), -1.0, 1e-15);
  // A box standing on the floor, its underside on it.
  const std::string box =
      "[[object]]\nname = \"box\"\nshape = \"box\"\nmin = [0.3, 0.3, 0]\n"
      "max = [0.6, 0.6, 0.4]\nmaterial = \"white\"\n";
  EXPECT_EQ(warnings(read(cube_obj(all), scene_of(box))), "");
}

// With a camera inside, all faces are oriented toward it, whatever the majority was.
TEST(Mend, AMixedRoomIsTurnedToItsCamera) {
  for (const std::array<bool, 6>& turned :
       {std::array<bool, 6>{true, true}, {true, true, true, true, false, false}}) {
    EXPECT_NEAR(volume(read(cube_obj(turned), scene_of("", "[0.2, 0.3, 0.6]"))), -1.0, 1e-15);
  }
}

// A strip of three quadrilaterals closed with a half twist.
TEST(Mend, ASurfaceWithoutTwoSidesIsNamed) {
  const std::string strip =
      "v 0 0 0\nv 0 0 1\nv 2 0 0\nv 2 0 1\nv 1 2 0\nv 1 2 1\nf 1 3 4 2\nf 3 5 6\nf 3 6 4\nf 5 2 "
      "1\nf 5 "
      "1 6\n";
  EXPECT_TRUE(holds(warnings(read(strip)), {"without two sides", "two-sided"}))
      << warnings(read(strip));
}

// Small scenes: tests/scenes/plausible.
TEST(Mend, AForgottenUnitIsSuspected) {
  EXPECT_TRUE(
      holds(warnings(read(cube_obj(none), scene_of("scale = 1000\n"))), {"unit", "m across"}));
}

TEST(SolidAngleOf, IsAllInsideAndNothingOutside) {
  const Scene scene = read(cube_obj(none));
  const SurfacePart part = surface_parts(scene, scene.objects[0], welded(scene.vertices)).front();
  EXPECT_NEAR(solid_angle_of(scene, part, {0.01, 0.5, 0.99}), 4.0 * base::pi, 1e-12);
  EXPECT_NEAR(solid_angle_of(scene, part, {-0.01, 0.5, 0.5}), 0.0, 1e-12);
  EXPECT_NEAR(solid_angle_of(scene, part, {5.0, 0.5, 0.5}), 0.0, 1e-12);
  // On a face half of the sphere, on an edge a quarter.
  EXPECT_NEAR(solid_angle_of(scene, part, {1.0, 0.5, 0.5}), 2.0 * base::pi, 1e-9);
}

// For each vertex the first one at its position: zeros of both signs are equal, adjacent
// floating-point numbers differ, and a thousand positions stay distinct.
TEST(Topology, WeldedVerticesAreTheFirstAtTheirPlace) {
  std::vector<Vec3> vertices{{0.0, 1.0, 2.0}, {-0.0, 1.0, 2.0}, {std::nextafter(0.0, 1.0), 1, 2}};
  for (int k = 0; k < 1000; ++k) vertices.emplace_back(k % 10, k / 10 % 10, k / 100 + 3.0);
  for (int k = 0; k < 1000; ++k) vertices.push_back(vertices[3 + (7 * k) % 1000]);
  const std::vector<std::uint32_t> id = welded(vertices);
  EXPECT_EQ(id[0], 0U);
  EXPECT_EQ(id[1], 0U);
  EXPECT_EQ(id[2], 2U);
  for (std::uint32_t k = 0; k < 1000; ++k) {
    EXPECT_EQ(id[3 + k], 3 + k);
    EXPECT_EQ(id[1003 + k], 3 + (7 * k) % 1000);
  }
}

}  // namespace
}  // namespace earthshine::scenes
