// SPDX-License-Identifier: Apache-2.0
// Joints, tracks and mirror images.
#include "scenes/time/linkage.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/time/mission.h"
#include "tests/scenes/scene_text.h"
#include "tests/scenes/time/oem_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;
using test::SceneFolder;

constexpr const char* material = "[[material]]\nname = \"m\"\ndiffuse = 0.5\n";
const Instant linkage_epoch = *read_instant("2026-03-01T12:00:00", TimeSystem::Utc);

std::string quad_on(const std::string& joint) {
  return fmt::format(
      "[[object]]\nname = \"o\"\nshape = \"quad\"\nmaterial = \"m\"\njoint = \"{}\"\n"
      "corners = [[1, 2, 3], [2, 2, 3], [2, 3, 3], [1, 3, 3]]\n",
      joint);
}

std::string joint_of(const std::string& name, const std::string& more) {
  return fmt::format("[[joint]]\nname = \"{}\"\npivot = [0, 0, 0]\naxis = [0, 0, 1]\n{}", name,
                     more);
}

glm::dmat4 about(const Vec3& pivot, const Vec3& axis, double angle_deg) {
  const glm::dmat4 there = glm::translate(glm::dmat4(1.0), pivot);
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), base::radians(angle_deg), axis);
  return there * turn * glm::translate(glm::dmat4(1.0), -pivot);
}

double off(const Vec3& a, const Vec3& b) { return glm::length(a - b); }

// An arm of six joints with an object, a lamp and a camera at its wrist: shoulder yaw and pitch,
// elbow pitch, wrist pitch, yaw and roll. Their places are the product of six matrices.
TEST(Linkage, SixJointArmMatchesMatricesMultiplied) {
  const struct {
    Vec3 pivot, axis;
    double angle_deg;
  } arm[] = {{{0, 0, 1}, {0, 0, 1}, 31.0},       {{0, 0, 1.3}, {0, 1, 0}, -48.0},
             {{6.4, 0, 1.3}, {0, 1, 0}, 77.0},   {{13.4, 0, 1.3}, {0, 1, 0}, -12.5},
             {{13.9, 0, 1.3}, {0, 0, 1}, 140.0}, {{14.6, 0, 1.3}, {1, 0, 0}, -95.0}};
  const SceneFolder folder;
  std::string joints;
  glm::dmat4 all(1.0);
  // In the file from the wrist to the shoulder: a parent may come after its child.
  for (int k = 5; k >= 0; --k) {
    const auto& [pivot, axis, angle] = arm[k];
    joints += fmt::format(
        "[[joint]]\nname = \"j{}\"\npivot = [{}, {}, {}]\naxis = [{}, {}, {}]\nangle_deg = {}\n{}",
        k, pivot.x, pivot.y, pivot.z, axis.x, axis.y, axis.z, angle,
        k > 0 ? fmt::format("parent = \"j{}\"\n", k - 1) : "");
  }
  for (const auto& [pivot, axis, angle] : arm) all = all * about(pivot, axis, angle);
  const auto moved = [&](const Vec3& p) { return Vec3(all * glm::dvec4(p, 1.0)); };
  const auto turned = [&](const Vec3& d) { return Vec3(all * glm::dvec4(d, 0.0)); };
  const std::string rest =
      "[[light]]\nname = \"l\"\ntype = \"rectangle\"\ncenter = [15, 0, 1]\nedge_u = [0.1, 0, 0]\n"
      "edge_v = [0, 0.2, 0]\nflux = 10\njoint = \"j5\"\n[[camera]]\nname = \"c\"\njoint = \"j5\"\n"
      "position = [15, 0, 2]\nlook_at = [20, 1, 2]\n";
  const std::string text = std::string("format = 1\n") + material + joints + quad_on("j5") + rest;
  const Scene scene = folder.read(text);
  const Vec3 corners[] = {{1, 2, 3}, {2, 2, 3}, {2, 3, 3}, {1, 3, 3}};
  ASSERT_EQ(scene.vertices.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_LT(off(scene.vertices[k], moved(corners[k])), 1e-12);
  const Lamp& lamp = scene.lamps.front();
  EXPECT_LT(off(lamp.position, moved({15, 0, 1})), 1e-12);
  EXPECT_LT(off(lamp.axis, turned({0, 0, 1})), 1e-12);
  EXPECT_LT(off(lamp.edge_v, turned({0, 0.2, 0})), 1e-12);
  const Camera& camera = scene.cameras.front();
  EXPECT_LT(off(camera.position, moved({15, 0, 2})), 1e-12);
  EXPECT_LT(off(camera.look_at, moved({20, 1, 2})), 1e-12);
  EXPECT_LT(off(camera.up, turned({0, 0, 1})), 1e-12);

  // --set moves a joint: the elbow straight is the chain without its matrix.
  const Scene straight = folder.read(text, {"joint.j2.angle_deg=0"});
  all = glm::dmat4(1.0);
  for (const int k : {0, 1, 3, 4, 5})
    all = all * about(arm[k].pivot, arm[k].axis, arm[k].angle_deg);
  EXPECT_LT(off(straight.vertices[0], moved(corners[0])), 1e-12);
}

// The joint moves what scale, rotate and translate have placed, in any unit.
TEST(Linkage, JointMovesAfterThePlacement) {
  const SceneFolder folder;
  const Scene scene = folder.read(
      std::string("format = 1\nunit = \"cm\"\n") + material +
      "[[joint]]\nname = \"j\"\npivot = [100, 0, 0]\naxis = [0, 0, 1]\nangle_deg = 90\n" +
      quad_on("j") + "translate = [200, 0, 0]\nscale = 2\n");
  // Corner (1, 2, 3) cm is placed at (2, 4, 6) + (200, 0, 0); the quarter turn about (100, 0)
  // takes (202, 4) to (100 - 4, 102).
  EXPECT_LT(off(scene.vertices[0], Vec3(0.96, 1.02, 0.06)), 1e-12);
}

// An instance on a joint is the original moved.
TEST(Linkage, InstancesHangOnJoints) {
  const SceneFolder folder;
  const Scene scene = folder.read(
      std::string("format = 1\n") + material + joint_of("j", "angle_deg = 90\n") + quad_on("j") +
      "[[object]]\nname = \"i\"\ninstance_of = \"o\"\ntranslate = [0, 0, 5]\n");
  // The original's corner (1, 2, 3) is at (-2, 1, 3); the instance hangs on nothing.
  EXPECT_LT(off(scene.vertices[0], Vec3(-2, 1, 3)), 1e-12);
  EXPECT_LT(off(scene.vertices[4], Vec3(1, 2, 8)), 1e-12);
  EXPECT_EQ(scene.objects[0].joint, "j");
  EXPECT_EQ(scene.objects[1].joint, "");
}

double signed_volume(const Scene& scene) {
  double volume = 0.0;
  for (const Triangle& triangle : scene.triangles) {
    const auto corner = [&](int k) { return scene.vertices[triangle.vertex[k]]; };
    volume += glm::dot(corner(0), glm::cross(corner(1), corner(2))) / 6.0;
  }
  return volume;
}

// A box that no mending touches: by the divergence theorem the volume within triangles wound
// outward is positive.
TEST(Linkage, MirrorImagesKeepTheirFronts) {
  const SceneFolder folder;
  const auto volume = [&](const std::string& scale, const std::string& more) {
    return signed_volume(
        folder.read(std::string("format = 1\n") + material +
                    "[[object]]\nname = \"o\"\nshape = \"box\"\nmaterial = \"m\"\nmin = [1, 1, 1]\n"
                    "max = [2, 3, 4]\norient = \"as-is\"\nscale = " +
                    scale + "\n" + more));
  };
  EXPECT_NEAR(volume("[1, -1, 1]", ""), 6.0, 1e-12);
  EXPECT_NEAR(volume("-1", ""), 6.0, 1e-12);
  EXPECT_NEAR(volume("[-1, -2, 1]", ""), 12.0, 1e-12);
}

// A flat sheet whose normals point along z from the back of its winding: its mirror image in y has
// the same fronts.
TEST(Linkage, VertexNormalsOfMirrorImagesDecideTheFront) {
  const SceneFolder folder;
  folder.put("sheet.obj", "v 0 1 0\nv 0 2 0\nv 1 2 0\nv 1 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\n");
  for (const char* scale : {"1", "[1, -1, 1]"}) {
    const Scene scene = folder.read(
        std::string("format = 1\n") + material +
        "[[object]]\nname = \"o\"\nmesh = \"sheet.obj\"\nmaterial = \"m\"\nscale = " + scale +
        "\n");
    const Triangle& triangle = scene.triangles.front();
    const auto corner = [&](int k) { return scene.vertices[triangle.vertex[k]]; };
    EXPECT_GT(glm::cross(corner(1) - corner(0), corner(2) - corner(0)).z, 0.0) << scale;
  }
}

class MovingScene : public ::testing::Test {
 protected:
  MovingScene() { folder.put("t.oem", test::oem_of(circle, linkage_epoch, 60.0, 100)); }
  [[nodiscard]] Scene read(const std::string& text, const std::string& start) const {
    return folder.read("format = 1\n" + head(start) + material + text);
  }
  static std::string head(const std::string& start) {
    return "[orbit]\ntrajectory = \"t.oem\"\n[time]\nstart = \"" + start + "\"\n";
  }

  static constexpr double apart_rad = 30.0 / 6771e3;
  const test::Ellipse circle{.semi_major_m = 6771e3, .node_deg = 40.0};
  SceneFolder folder;
};

TEST_F(MovingScene, AnglesFollowTheirTableBetweenRows) {
  folder.put("arm.csv",
             "# an arm\nutc, j, other\n2026-03-01T12:00:00, 10, 1\n2026-03-01T12:10:00, 40, 2\n");
  const std::string text = joint_of("j", "angle_deg = \"arm.csv\"\n") + quad_on("j");
  // 200 s of 600: 10 + 30/3 = 20 deg.
  const double angle = base::radians(20.0);
  const Scene scene = read(text, "2026-03-01T12:03:20");
  EXPECT_LT(off(scene.vertices[0], Vec3(std::cos(angle) - 2 * std::sin(angle),
                                        std::sin(angle) + 2 * std::cos(angle), 3)),
            1e-9);
  // By seconds after an epoch.
  folder.put("arm.csv", "time_s, angle_deg\n-100, 0\n500, 30\n");
  const Scene later = read(
      joint_of("j", "angle_deg = \"arm.csv\"\nepoch = \"2026-03-01T12:00:00\"\n") + quad_on("j"),
      "2026-03-01T12:05:00");
  EXPECT_LT(off(later.vertices[0], scene.vertices[0]), 1e-9);
}

TEST_F(MovingScene, TracksMoveAndTurnBetweenRows) {
  folder.put("v.csv",
             "utc,x,y,z,rotate_x,rotate_y,rotate_z\n2026-03-01T12:00:00,0,0,0,0,0,0\n"
             "2026-03-01T12:10:00,10,0,0,0,0,90\n");
  const Scene scene =
      read("[[track]]\nname = \"v\"\nposes = \"v.csv\"\n" + quad_on("v"), "2026-03-01T12:05:00");
  // Half of the way: turned by 45 deg and moved by 5.
  const double h = std::sqrt(0.5);
  EXPECT_LT(off(scene.vertices[0], Vec3(5 + h - 2 * h, h + 2 * h, 3)), 1e-9);
}

// Between rows a turn is the shorter way: 0 to 360 deg stands, 0 to 180 deg is even.
TEST_F(MovingScene, TracksThatTurnByMoreThanHalfATurnBetweenRowsAreNamed) {
  const auto warnings = [&](const std::string& rows) {
    folder.put("v.csv", "utc,x,y,z,rotate_x,rotate_y,rotate_z\n" + rows);
    return read("[[track]]\nname = \"v\"\nposes = \"v.csv\"\n" + quad_on("v"),
                "2026-03-01T12:05:00")
        .warnings;
  };
  EXPECT_TRUE(
      warnings("2026-03-01T12:00:00,0,0,0,0,0,-90\n2026-03-01T12:10:00,0,0,0,0,0,90\n").empty());
  const auto named = warnings(
      "2026-03-01T12:00:00,0,0,0,0,0,0\n2026-03-01T12:10:00,0,0,0,0,0,360\n"
      "2026-03-01T12:20:00,0,0,0,200,0,360\n2026-03-01T12:30:00,0,0,0,200,90,360\n");
  ASSERT_EQ(named.size(), 1U);
  EXPECT_TRUE(holds(named[0], {"v.csv:3: ", "360 deg", "1 more such", "shorter way"})) << named[0];
}

// A visitor on the spacecraft's own circle, d ahead by the angle a: R sin a along the motion, which
// is -x of bay-to-earth, and R (1 - cos a) toward the Earth, its z.
TEST_F(MovingScene, VisitorIsPlacedRelativeToTheSceneByItsTrajectory) {
  const double earlier = apart_rad / circle.mean_motion_rad_s();
  std::string rows, last;
  for (int k = 0; k < 100; ++k) {
    last = utc_text(linkage_epoch + 60.0 * k);
    rows += test::oem_row(last, circle.at(60.0 * k + earlier));
  }
  folder.put("cargo.oem",
             test::oem_head + test::oem_meta(utc_text(linkage_epoch), last, "GCRF") + rows);
  const Scene scene = read(
      "[[track]]\nname = \"v\"\ntrajectory = \"cargo.oem\"\norigin = [0, 0, 4]\n" + quad_on("v"),
      "2026-03-01T12:31:17");
  const Vec3 there(-6771e3 * std::sin(apart_rad), 0.0, 6771e3 * (1.0 - std::cos(apart_rad)));
  // The file's positions have micrometres.
  EXPECT_LT(off(scene.vertices[0], Vec3(1, 2, 7) + there), 1e-4);
}

TEST_F(MovingScene, BadLinkagesAreRefused) {
  folder.put("short.csv", "utc, j\n2026-03-01T12:00:00, 0\n2026-03-01T12:01:00, 9\n");
  folder.put("back.csv", "utc, j\n2026-03-01T12:01:00, 0\n2026-03-01T12:00:00, 9\n");
  folder.put("nan.csv", "utc, j\n2026-03-01T12:00:00, nan\n");
  folder.put("none.csv", "utc, elbow\n2026-03-01T12:00:00, 1\n");
  const std::string moment = "\n2026-03-01T12:02:00, 0, 0, 0, 1\n";
  folder.put("turn.csv", "utc, x, y, z, rotate_z" + moment);
  folder.put("half.csv", "utc, x, y, z, qx" + moment);
  folder.put("other.csv", "utc, x, y, z, yaw" + moment);
  folder.put("twice.csv", "utc, x, y, z, x" + moment);
  folder.put("cut.csv", "utc, j\n2026-03-01T12:00:00\n");
  const struct {
    std::string text;
    std::vector<std::string> says;
  } bad[] = {
      {joint_of("j", "parent = \"j\"\n"), {"scene.toml:", "its own ancestor", "j on j"}},
      {joint_of("a", "parent = \"b\"\n") + joint_of("b", "parent = \"a\"\n"), {"a on b on a"}},
      {joint_of("j", "parent = \"k\"\n"), {"\"parent\"", "\"k\"", "allowed are"}},
      {quad_on("arm"), {"\"joint\"", "\"arm\"", "no [[joint]]"}},
      {joint_of("j", "") + quad_on("jj"), {"\"jj\"", "allowed are joints and tracks: j"}},
      {joint_of("j", "angle_deg = \"short.csv\"\n") + quad_on("j"),
       {"short.csv:3", "ends at 2026-03-01T12:01:00Z", "2026-03-01T12:02:00Z is asked for",
        "allowed are moments from 2026-03-01T12:00:00Z"}},
      {joint_of("j", "angle_deg = \"back.csv\"\n"), {"back.csv:3", "rise"}},
      {joint_of("j", "angle_deg = \"nan.csv\"\n"), {"nan.csv:2:22", "\"nan\""}},
      {joint_of("j", "angle_deg = \"none.csv\"\n"), {"none.csv:1", "named j or angle_deg"}},
      {joint_of("j", "angle_deg = \"cut.csv\"\n"), {"cut.csv:2", "1 columns"}},
      {joint_of("j", "") + joint_of("j", ""), {"\"j\""}},
      {"[[track]]\nname = \"t\"\nposes = \"turn.csv\"\n", {"turn.csv:1", "no column rotate_x"}},
      {"[[track]]\nname = \"t\"\nposes = \"half.csv\"\n", {"half.csv:1", "no column qw"}},
      {"[[track]]\nname = \"t\"\nposes = \"other.csv\"\n",
       {"other.csv:1", "column \"yaw\"", "rotate_x"}},
      {"[[track]]\nname = \"t\"\nposes = \"twice.csv\"\n", {"twice.csv:1", "two columns \"x\""}},
      {"[[track]]\nname = \"t\"\n", {"poses = \"FILE.csv\" or trajectory"}},
  };
  for (const auto& one : bad) {
    const std::string said =
        folder.refusal("format = 1\n" + head("2026-03-01T12:02:00") + material + one.text);
    EXPECT_TRUE(holds(said, one.says)) << said;
  }
  const std::string dateless = folder.refusal(std::string("format = 1\n") + material +
                                              joint_of("j", "angle_deg = \"short.csv\"\n"));
  EXPECT_TRUE(holds(dateless, {"no dates", "Write [time]"})) << dateless;
  const std::string mirrored =
      folder.refusal(std::string("format = 1\n") + material + joint_of("j", "") + quad_on("j") +
                     "[[object]]\nname = \"i\"\ninstance_of = \"o\"\nscale = [1, -1, 1]\n");
  EXPECT_TRUE(holds(mirrored, {"mirror image"})) << mirrored;
}

// Of all angles within the limits, in steps of 0.1 deg, none gives the normal a larger cosine with
// the Sun; a joint on a turned parent follows in the parent's axes.
TEST(Linkage, ArraysFollowTheSunToTheLargestCosineThatAxisAndLimitsAllow) {
  const SceneFolder folder;
  const struct {
    Vec3 sun;
    double low_deg, high_deg;
  } cases[] = {{{0.3, -0.8, 0.2}, -180.0, 180.0}, {{-0.5, 0.1, -0.9}, -180.0, 180.0},
               {{-0.5, 0.1, -0.9}, -60.0, 75.0},  {{0.1, 0.9, -0.2}, 20.0, 330.0},
               {{0.2, 0.3, -0.9}, -30.0, -10.0},  {{0.7, -0.1, 0.1}, 0.0, 0.0}};
  const Vec3 axis = glm::normalize(Vec3(0.2, 1.0, -0.1)), normal = glm::normalize(Vec3(1, 0.2, 2));
  const glm::dmat3 parent(about({0, 0, 0}, {0, 0, 1}, 50.0));
  for (const auto& one : cases) {
    const Scene scene = folder.read(fmt::format(
        "format = 1\n[sun]\ndirection = [{}, {}, {}]\n{}{}[[joint]]\nname = \"array\"\n"
        "parent = \"mast\"\npivot = [1, 2, 3]\naxis = [0.2, 1.0, -0.1]\nfollows = \"sun\"\n"
        "normal = [1, 0.2, 2]\nlimits_deg = [{}, {}]\n",
        one.sun.x, one.sun.y, one.sun.z, material, joint_of("mast", "angle_deg = 50\n"),
        one.low_deg, one.high_deg));
    const JointState found = joints_now(scene)[1];
    const Vec3 sun = glm::normalize(one.sun);
    EXPECT_GE(*found.angle_deg, one.low_deg);
    EXPECT_LE(*found.angle_deg, one.high_deg);
    const double cosine = glm::dot(found.pose.rotation * normal, sun);
    double largest = -1.0;
    const int steps = static_cast<int>(10.0 * (one.high_deg - one.low_deg));
    for (int k = 0; k <= steps; ++k) {
      const glm::dmat3 turn(about({0, 0, 0}, axis, one.low_deg + 0.1 * k));
      largest = std::max(largest, glm::dot(parent * (turn * normal), sun));
    }
    EXPECT_GE(cosine, largest - 1e-12);
    EXPECT_LE(cosine, largest + 2e-6);  // half a step: 1 - cos(0.05 deg) = 4e-7
    EXPECT_LT(off(found.pose.point(Vec3(parent * Vec3(0.0))), found.pose.offset_m), 1e-12);
  }
}

// Along a trajectory: at every moment the array of a spacecraft that keeps the bay to the Earth.
TEST(Linkage, ArraysFollowTheSunAlongATrajectory) {
  const SceneFolder folder;
  folder.put("t.oem", test::oem_of(test::Ellipse(), linkage_epoch, 60.0, 95));
  const std::string text =
      std::string("format = 1\n[orbit]\ntrajectory = \"t.oem\"\n") + material +
      "[[joint]]\nname = \"array\"\npivot = [0, 0, 0]\naxis = [0, 1, 0]\nfollows = \"sun\"\n"
      "normal = [0, 0, 1]\n";
  for (int minute = 0; minute < 94; minute += 13) {
    const std::string at = utc_text(linkage_epoch + 60.0 * minute);
    const Scene scene = folder.read(text + "[time]\nstart = \"" + at + "\"\n");
    const Vec3 sun = scene.sun->direction;
    const double cosine = glm::dot(joints_now(scene)[0].pose.rotation * Vec3(0, 0, 1), sun);
    EXPECT_NEAR(cosine, std::hypot(sun.x, sun.z), 1e-12) << at;  // all but the part along the axis
    EXPECT_TRUE(scene.linkage->moves());
  }
}

TEST(Linkage, BadFollowersAreRefused) {
  const SceneFolder folder;
  const std::string follows = "follows = \"sun\"\n", sun = "[sun]\ndirection = [0, 0, 1]\n";
  const struct {
    std::string sky, joint;
    std::vector<std::string> says;
  } bad[] = {
      {"", follows + "normal = [1, 0, 0]\n", {"\"follows\"", "no [sun]"}},
      {sun, follows, {"normal"}},
      {sun, follows + "normal = [0, 0, 2]\n", {"\"normal\"", "along the axis"}},
      {sun, follows + "normal = [1, 0, 0]\nangle_deg = 3\n", {"\"angle_deg\"", "follows"}},
      {sun, follows + "normal = [1, 0, 0]\nlimits_deg = [10, -10]\n", {"\"limits_deg\"", "rising"}},
      {sun, follows + "normal = [1, 0, 0]\nlimits_deg = 10\n", {"\"limits_deg\"", "two angles"}},
      {sun, "normal = [1, 0, 0]\n", {"\"normal\"", "follows = \"sun\""}},
      {sun, "follows = \"moon\"\nnormal = [1, 0, 0]\n", {"\"follows\"", "sun"}},
  };
  for (const auto& one : bad) {
    const std::string said =
        folder.refusal("format = 1\n" + one.sky + material + joint_of("j", one.joint));
    EXPECT_TRUE(holds(said, one.says)) << said;
  }
}

}  // namespace
}  // namespace earthshine::scenes
