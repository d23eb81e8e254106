// SPDX-License-Identifier: Apache-2.0
// Coplanar faces: which pairs are found, and which face rays hit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/numbers/random.h"
#include "scenes/health/box_join.h"
#include "scenes/ray_query.h"
#include "scenes/triangle_point.h"
#include "tests/scenes/cube_scenes.h"

namespace earthshine::scenes {
namespace {

using test::holds;
using test::warnings;

constexpr const char* head =
    "format = 1\n[[material]]\nname = \"white\"\ndiffuse = 0.5\n[[material]]\nname = \"paper\"\n"
    "diffuse = 0.5\ntwo_sided = true\n[[material]]\nname = \"grey\"\ndiffuse = "
    "0.3\n[[material]]\nname = \"lamp\"\nemit = 10\n";

// A square about (x, 0) with the edge 2 h in the plane z, facing up or down.
std::string square(const char* name, double x, double h, double z, bool up,
                   const char* material = "white") {
  const double y = up ? h : -h;
  return fmt::format(
      "[[object]]\nname = \"{}\"\nshape = \"quad\"\ncorners = [[{}, {}, {}], [{}, {}, {}], [{}, "
      "{}, {}], [{}, {}, {}]]\nmaterial = \"{}\"\n",
      name, x - h, -y, z, x + h, -y, z, x + h, y, z, x - h, y, z, material);
}

std::string box(const char* name, const Vec3& low, const Vec3& high) {
  return fmt::format(
      "[[object]]\nname = \"{}\"\nshape = \"box\"\nmin = [{}, {}, {}]\nmax = [{}, {}, {}]\n"
      "material = \"white\"\n",
      name, low.x, low.y, low.z, high.x, high.y, high.z);
}

Scene read_scene(const std::string& objects) { return test::SceneFolder().read(head + objects); }

// The object hit by a ray down, or up, through (x, y, 0); "back of ..." for a black back, "" for no
// hit.
std::string met(const Scene& scene, double x, double y, bool down) {
  const RayQuery query(scene);
  const Hit hit = query.closest({x, y, down ? 5.0 : -5.0}, {0, 0, down ? -1.0 : 1.0});
  if (hit.missed()) return "";
  const Triangle& triangle = scene.triangles[hit.triangle];
  const Vec3 at = hit_position(scene, hit);
  EXPECT_NEAR(at.x, x, 1e-6);
  EXPECT_NEAR(at.y, y, 1e-6);
  const bool black = !hit.front && !scene.materials[triangle.material].two_sided;
  return (black ? "back of " : "") + scene.objects[triangle.object].name;
}

// Barycentric coordinates of (0.2, 0.1, 0) on a triangle.
Barycentric barycentric(const Scene& scene, std::uint32_t t) {
  const auto& v = scene.triangles[t].vertex;
  const Vec3 a = scene.vertices[v[0]];
  return scenes::barycentric({0.2, 0.1, 0.0}, a, scene.vertices[v[1]] - a,
                             scene.vertices[v[2]] - a);
}

TEST(CoincidentFaces, TheLaterOfTwoOpenOnesIsOver) {
  const Scene scene =
      read_scene(square("plate", 0, 2, 0, true) + square("decal", 1, 0.5, 0, true, "paper"));
  // The decal's two triangles against the plate's two; their diagonals are parallel.
  EXPECT_EQ(scene.coincident.size(), 2U);
  EXPECT_TRUE(holds(warnings(scene), {"\"plate\" and \"decal\": 1 m2", "those of \"decal\""}))
      << warnings(scene);
  base::Rng random(base::Key(1, base::Stream::Test, 0));
  for (int k = 0; k < 200; ++k) {
    const double x = 4.0 * random.next() - 2.0, y = 4.0 * random.next() - 2.0;
    const bool on = std::abs(x - 1.0) < 0.5 && std::abs(y) < 0.5;
    EXPECT_EQ(met(scene, x, y, true), on ? "decal" : "plate");
    EXPECT_EQ(met(scene, x, y, false), "back of plate");
  }
}

TEST(CoincidentFaces, WhatIsNearerBySomeOffsetIsOverWhateverItsPlace) {
  // At the extent of 5.7 m the ray offset is 23 um.
  for (const double lift : {4e-6, 1e-5}) {
    const Scene scene =
        read_scene(square("decal", 1, 0.5, lift, true) + square("plate", 0, 2, 0, true));
    EXPECT_EQ(scene.coincident.size(), 2U);
    EXPECT_EQ(warnings(scene), "");
    EXPECT_EQ(met(scene, 1.0, 0.1, true), "decal");
  }
  EXPECT_TRUE(read_scene(square("decal", 1, 0.5, 1e-4, true) + square("plate", 0, 2, 0, true))
                  .coincident.empty());
}

TEST(CoincidentFaces, WhatShinesIsOverWhatDoesNot) {
  const Scene scene =
      read_scene(square("lamp", 1, 0.5, 0, true, "lamp") + square("plate", 0, 2, 0, true));
  EXPECT_EQ(met(scene, 1.0, 0.1, true), "lamp");
  EXPECT_EQ(warnings(scene), "");
}

TEST(CoincidentFaces, ASheetIsOverABody) {
  for (const bool up : {true, false}) {
    const Scene scene = read_scene(square("sheet", 0, 0.4, 1, up, "paper") +
                                   box("box", Vec3(-0.5, -0.5, 0), Vec3(0.5, 0.5, 1)));
    EXPECT_EQ(met(scene, 0.1, 0.2, true), "sheet");
    EXPECT_EQ(met(scene, 0.45, 0.2, true), "box");
    EXPECT_EQ(warnings(scene), "");
  }
}

TEST(CoincidentFaces, OpenOnesBackToBackAreTheSidesOfASheet) {
  const Scene scene =
      read_scene(square("front", 0, 1, 0, true) + square("rear", 0.5, 1, 0, false, "grey"));
  EXPECT_EQ(met(scene, 0.2, 0.1, true), "front");
  EXPECT_EQ(met(scene, 0.2, 0.1, false), "rear");
  EXPECT_EQ(met(scene, -0.7, 0.1, false), "back of front");
  EXPECT_TRUE(holds(warnings(scene), {"3 m2", "back to back"})) << warnings(scene);
}

// In either order in the scene, and nearer than the ray offset: a ray continuing from the glass
// would start beyond the plate.
TEST(CoincidentFaces, WhatIsOpaqueIsMetWhereGlassLiesOnIt) {
  const std::string glass = "[[material]]\nname = \"glass\"\ntransmit = 0.8\n";
  const std::string plate = square("plate", 0, 2, 0, true);
  for (const bool is_sheet : {true, false}) {
    for (const double lift : {0.0, 1e-5, -1e-5}) {
      const std::string pane = square("pane", 1, 0.5, lift, true, "glass");
      for (const std::string& both : {plate + pane, pane + plate}) {
        const Scene scene =
            read_scene(glass + (is_sheet ? "two_sided = true\n" : "ior = 1.5\n") + both);
        EXPECT_EQ(met(scene, 1.0, 0.1, true), "plate");
        EXPECT_EQ(met(scene, 1.0, 0.1, false), "back of plate");
        EXPECT_EQ(warnings(scene), "");
        const CoincidentFaces faces(scene);
        for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
          const bool is_pane = scene.objects[scene.triangles[t].object].name == "pane";
          for (const bool front : {true, false}) EXPECT_EQ(faces.is_covered(t, front), is_pane);
        }
      }
    }
  }
  EXPECT_TRUE(read_scene(glass + square("a", 0, 1, 0, true, "glass") +
                         square("b", 0.5, 1, 0, true, "glass"))
                  .coincident.empty());
}

// Whether the front of the box's bottom face at x = 0.2, and of the other object's face there, are
// covered.
std::pair<bool, bool> covered(const Scene& scene) {
  const CoincidentFaces faces(scene);
  std::pair<bool, bool> found;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const bool is_box = scene.objects[scene.triangles[t].object].name == "box";
    (is_box ? found.first : found.second) |= faces.covers(t, true, {0.2, 0.1, 0.0});
  }
  return found;
}

TEST(CoincidentFaces, ABodyAndWhatItStandsOnHideEachOther) {
  const std::string body = box("box", Vec3(-0.5, -0.5, 0), Vec3(0.5, 0.5, 1));
  const Scene on_plate = read_scene(square("plate", 0, 2, 0, true) + body);
  EXPECT_EQ(covered(on_plate), std::pair(true, true));
  EXPECT_EQ(met(on_plate, 0.2, 0.1, false), "back of plate");
  EXPECT_EQ(warnings(on_plate), "");
  const std::string walls = "inward = true\n";
  const Scene in_room = read_scene(box("room", Vec3(-2, -2, 0), Vec3(2, 2, 3)) + walls + body);
  EXPECT_EQ(covered(in_room), std::pair(true, true));
  EXPECT_EQ(warnings(in_room), "");
}

TEST(CoincidentFaces, TheWallsOfAHouseAreSeenFromBothSides) {
  const std::string body = box("box", Vec3(-0.5, -0.5, 0), Vec3(0.5, 0.5, 1));
  const Scene house =
      read_scene(body + box("room", Vec3(-0.5, -0.5, 0), Vec3(0.5, 0.5, 1)) + "inward = true\n");
  EXPECT_EQ(covered(house), std::pair(false, false));
  EXPECT_EQ(met(house, 0.2, 0.1, true), "box");
}

// As written by another program: the room is a millionth larger. Or six squares that form no closed
// room.
TEST(CoincidentFaces, WhatIsInAHouseIsSeenHoweverItsWallsWereMade) {
  const std::string body = box("box", Vec3(-0.5, -0.5, 0), Vec3(0.5, 0.5, 1));
  const double h = 0.5 * (1.0 + 1e-6);
  const Scene rounded =
      read_scene(body + box("room", Vec3(-h, -h, -1e-6), Vec3(h, h, 1 + 1e-6)) + "inward = true\n");
  EXPECT_FALSE(rounded.coincident.empty());
  EXPECT_EQ(covered(rounded), std::pair(false, false));
  EXPECT_EQ(covered(read_scene(body + square("floor", 0, 0.5, 0, true))), std::pair(false, false));
}

// A body beside a room, wall on wall, is not visible inside it, in either order in the scene.
TEST(CoincidentFaces, ARoomsWallIsOverTheBodyBehindIt) {
  const std::string room = box("room", Vec3(-1, -1, 0), Vec3(1, 1, 1)) + "inward = true\n";
  const std::string under = box("under", Vec3(-1, -1, -1), Vec3(1, 1, 0));
  for (const std::string& both : {room + under, under + room}) {
    const Scene scene = read_scene(both);
    const RayQuery query(scene);
    const Hit hit = query.closest({0.2, 0.1, 0.5}, {0, 0, -1});
    EXPECT_EQ(scene.objects[scene.triangles[hit.triangle].object].name, "room");
  }
}

// The two sides of a sheet and a third face over both: one of them receives the light on each side.
TEST(CoincidentFaces, SomethingIsAlwaysSeen) {
  const Scene scene = read_scene(square("up", 0, 1, 0, true) + square("down", 0, 1, 0, false) +
                                 square("sheet", 0, 1, 0, true, "paper"));
  EXPECT_EQ(met(scene, 0.2, 0.1, true), "sheet");
  EXPECT_EQ(met(scene, 0.2, 0.1, false), "sheet");
  const CoincidentFaces faces(scene);
  bool open[2] = {false, false};  // open sides, by direction up
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    for (const bool front : {true, false}) {
      const bool sheet = scene.materials[scene.triangles[t].material].two_sided;
      const auto [u, v] = barycentric(scene, t);
      if (!(u > 0.0 && v > 0.0 && u + v < 1.0) || (!front && !sheet)) continue;
      const bool up = (triangle_normal(scene, t).z > 0.0) == front;
      if (!faces.covers(t, front, {0.2, 0.1, 0.0})) open[up ? 0 : 1] = true;
    }
  }
  EXPECT_TRUE(open[0] && open[1]);
}

// At coordinates where single precision has steps of 3 cm.
TEST(CoincidentFaces, AreFoundFarFromTheOrigin) {
  const std::string sphere =
      "shape = \"sphere\"\nradius = 0.5\nsegments = 100\nmaterial = \"white\"\n";
  const Scene scene =
      read_scene("[[object]]\nname = \"a\"\ncenter = [400000, 400000, 0]\n" + sphere +
                 "[[object]]\nname = \"b\"\ncenter = [400000.3, 400000, 0]\n" + sphere);
  EXPECT_EQ(scene.objects.size(), 2U);
}

// Pairs found by comparing each of the first `few` boxes with all later ones.
void expect_pairs_of_comparison(const std::vector<LabelledBox>& boxes, std::size_t few) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> expected, found;
  for (std::uint32_t a = 0; a < few; ++a) {
    for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
      if (boxes[a].label != boxes[b].label &&
          glm::all(glm::lessThanEqual(boxes[a].low, boxes[b].high)) &&
          glm::all(glm::lessThanEqual(boxes[b].low, boxes[a].high))) {
        expected.emplace_back(a, b);
      }
    }
  }
  join_boxes(boxes, [&](std::uint32_t a, std::uint32_t b) {
    found.emplace_back(std::min(a, b), std::max(a, b));
  });
  std::sort(found.begin(), found.end());
  EXPECT_GT(expected.size(), 200U);
  EXPECT_EQ(found, expected);
}

// 300 random boxes with 40 labels: the same pairs as by comparing all with all, once each.
TEST(BoxJoin, FindsEachPairThatMeetsOnce) {
  base::Rng random(base::Key(3, base::Stream::Test, 0));
  const auto number = [&](double most) { return static_cast<float>(most * random.next()); };
  std::vector<LabelledBox> boxes;
  for (std::uint32_t k = 0; k < 300; ++k) {
    const glm::vec3 low(number(1.0), number(1.0), k % 3 == 0 ? 0.5F : number(1.0));
    const float size = k % 50 == 0 ? 1.0F : 0.1F;
    boxes.push_back(
        {low, low + size * glm::vec3(number(1.0), number(1.0), number(1.0)), k % 40, k});
  }
  expect_pairs_of_comparison(boxes, boxes.size());
}

// 40 random boxes over a sheet of 90 000 adjacent boxes: the same pairs as by comparing each of the
// 40 with all.
TEST(BoxJoin, FindsTheFewThatMeetAmongMany) {
  base::Rng random(base::Key(4, base::Stream::Test, 0));
  const auto number = [&](double most) { return static_cast<float>(most * random.next()); };
  std::vector<LabelledBox> boxes;
  constexpr std::uint32_t edge = 300, few = 40;
  for (std::uint32_t k = 0; k < few; ++k) {
    const glm::vec3 low(number(1.0), number(1.0), -number(0.02));
    boxes.push_back({low, low + glm::vec3(number(0.02), number(0.02), number(0.02)), 1 + k / 2, k});
  }
  for (std::uint32_t k = 0; k < edge * edge; ++k) {
    const glm::vec3 low(static_cast<float>(k % edge) / edge, static_cast<float>(k / edge) / edge,
                        0.0F);
    boxes.push_back({low, low + glm::vec3(1.0F / edge, 1.0F / edge, 1e-3F), 0, few + k});
  }
  expect_pairs_of_comparison(boxes, few);
}

}  // namespace
}  // namespace earthshine::scenes
