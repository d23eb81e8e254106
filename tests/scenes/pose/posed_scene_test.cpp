// SPDX-License-Identifier: Apache-2.0
// A scene that is moved in memory is the scene that is read with these values, to rounding.
#include "scenes/pose/posed_scene.h"

#include <gtest/gtest.h>

#include "scenes/time/linkage.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

// A table with a sheet that lies on it, an arm on two joints with a lamp and a camera at its end,
// and a copy of the box. Lengths in cm.
constexpr const char* arm = R"(format = 1
unit = "cm"
[[material]]
name = "grey"
diffuse = 0.5
[[material]]
name = "white"
diffuse = 0.8
[[joint]]
name = "elbow"
pivot = [100, 0, 50]
axis = [0, 1, 0]
angle_deg = 20
parent = "shoulder"
[[joint]]
name = "shoulder"
pivot = [0, 0, 50]
axis = [0, 0, 1]
angle_deg = -10
[[object]]
name = "table"
shape = "quad"
corners = [[-200, -200, 0], [200, -200, 0], [200, 200, 0], [-200, 200, 0]]
material = "grey"
[[object]]
name = "sheet"
shape = "quad"
corners = [[-10, -10, 0], [10, -10, 0], [10, 10, 0], [-10, 10, 0]]
material = "white"
translate = [5, 5, 0]
[[object]]
name = "box"
shape = "box"
min = [100, -5, 45]
max = [150, 5, 55]
material = "grey"
joint = "elbow"
translate = [1, 2, 3]
[[object]]
name = "copy"
instance_of = "box"
translate = [0, 100, 0]
rotate = [0, 0, 30]
joint = "shoulder"
[[light]]
name = "lamp"
type = "spot"
position = [150, 0, 60]
aim = [300, 0, 0]
intensity = 100
field_deg = 40
beam_deg = 20
joint = "elbow"
[[camera]]
name = "A"
position = [150, 0, 70]
look_at = [300, 0, 0]
joint = "elbow"
)";

// Coordinates are at most 4 m; each is a few sums and products of such numbers.
constexpr double rounding_m = 16.0 * 4.0 * 0x1p-52;

void expect_near(const Vec3& found, const Vec3& wanted) {
  EXPECT_LE(glm::length(found - wanted), rounding_m) << found.x << ' ' << wanted.x;
}

void expect_same(const Scene& found, const Scene& wanted) {
  ASSERT_EQ(found.vertices.size(), wanted.vertices.size());
  for (std::size_t v = 0; v < wanted.vertices.size(); ++v) {
    expect_near(found.vertices[v], wanted.vertices[v]);
  }
  for (std::size_t k = 0; k < wanted.objects.size(); ++k) {
    const auto &one = found.objects[k].instance, &other = wanted.objects[k].instance;
    ASSERT_EQ(one.has_value(), other.has_value());
    if (!one) continue;
    for (int c = 0; c < 3; ++c) expect_near(one->linear[c], other->linear[c]);
    expect_near(one->offset_m, other->offset_m);
  }
  expect_near(found.lamps[0].position, wanted.lamps[0].position);
  expect_near(found.lamps[0].axis, wanted.lamps[0].axis);
  expect_near(found.cameras[0].position, wanted.cameras[0].position);
  expect_near(found.cameras[0].look_at, wanted.cameras[0].look_at);
  expect_near(found.cameras[0].up, wanted.cameras[0].up);
  ASSERT_EQ(found.coincident.size(), wanted.coincident.size());
  for (std::size_t k = 0; k < wanted.coincident.size(); ++k) {
    EXPECT_EQ(found.coincident[k].a, wanted.coincident[k].a);
    EXPECT_EQ(found.coincident[k].b, wanted.coincident[k].b);
    EXPECT_EQ(found.coincident[k].b_before_a, wanted.coincident[k].b_before_a);
    EXPECT_EQ(found.coincident[k].a_before_b, wanted.coincident[k].a_before_b);
  }
}

TEST(PosedScene, IsTheSceneThatIsReadWithTheseValues) {
  const test::SceneFolder folder;
  const Scene scene = folder.read(arm);
  ASSERT_FALSE(scene.coincident.empty());  // of the sheet on the table
  struct Case {
    PoseChange change;
    std::vector<std::string> overrides;
  };
  const std::size_t sheet = 1, box = 2, copy = 3, elbow = 0, shoulder = 1;
  const Vec3 axis = glm::normalize(Vec3(3.0, 0.0, 0.0) - Vec3(1.4, 0.1, 0.8));
  const Case cases[] = {
      {{{{sheet, {0.2, 0.0, 0.0}}}, {}, {}}, {"object.sheet.translate=[25, 5, 0]"}},
      {{{{sheet, {0.0, 0.0, 0.5}}}, {}, {}}, {"object.sheet.translate=[5, 5, 50]"}},
      {{{{box, {0.1, 0.2, -0.3}}}, {}, {}}, {"object.box.translate=[11, 22, -27]"}},
      {{{{copy, {0.1, 0.0, 0.0}}}, {}, {}}, {"object.copy.translate=[10, 100, 0]"}},
      {{{}, {}, {{elbow, -35.0}}}, {"joint.elbow.angle_deg=-35"}},
      {{{}, {}, {{shoulder, 90.0}}}, {"joint.shoulder.angle_deg=90"}},
      {{{}, {{0, {-0.1, 0.1, 0.2}, axis}}, {}}, {"light.lamp.position=[140, 10, 80]"}},
      {{{{box, {0.1, 0.2, -0.3}}, {sheet, {0.2, 0.0, 0.0}}},
        {{0, {-0.1, 0.1, 0.2}, axis}},
        {{elbow, 5.0}, {shoulder, 45.0}}},
       {"object.box.translate=[11, 22, -27]", "object.sheet.translate=[25, 5, 0]",
        "light.lamp.position=[140, 10, 80]", "joint.elbow.angle_deg=5",
        "joint.shoulder.angle_deg=45"}},
      {{}, {}}};
  for (const auto& [change, overrides] : cases) {
    SCOPED_TRACE(overrides.empty() ? "none" : overrides.front());
    expect_same(posed_scene(scene, change), folder.read(arm, overrides));
  }
}

TEST(PosedScene, KeepsCoordinatesInRange) {
  const test::SceneFolder folder;
  const Scene scene = folder.read(arm);
  EXPECT_THROW((void)posed_scene(scene, {{{1, {2e9, 0.0, 0.0}}}, {}, {}}), base::Error);
  EXPECT_THROW((void)posed_scene(scene, {{}, {{0, {2e9, 0.0, 0.0}, {}}}, {}}), base::Error);
}

}  // namespace
}  // namespace earthshine::scenes
