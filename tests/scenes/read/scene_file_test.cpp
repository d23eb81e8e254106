// SPDX-License-Identifier: Apache-2.0
#include "scenes/read/scene_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/sky/orbit.h"
#include "scenes/sky/sky.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

TEST(SceneFile, SmallestSceneIsItsFormat) {
  const test::SceneFolder folder;
  const Scene scene = folder.read("format = 1\n");
  EXPECT_EQ(scene.name, "scene");  // the file's
  EXPECT_TRUE(scene.objects.empty());
  EXPECT_FALSE(scene.sun || scene.earth || scene.monitor || scene.quality.error);
}

TEST(SceneFile, EveryKeyOfTheFormatIsReadAndUsed) {
  const test::SceneFolder folder;
  const Scene scene = folder.read(R"(format = 1
name = "everything"
unit = "cm"
[[material]]
name = "m"
diffuse = [0.1, 0.2, 0.3]
specular = 0.9
shininess = 40
mirror = 0.05
transmit = [0.1, 0.1, 0.2]
ior = 1.5
emit = 7
light = "panels"
two_sided = true
[[object]]
name = "box"
shape = "box"
min = [0, 0, 0]
max = [100, 200, 300]
material = "m"
translate = [0, 0, 50]
rotate = [0, 0, 90]
scale = 2.0
target = true
[[light]]
name = "spot"
group = "bay"
type = "spot"
position = [50, 0, 100]
aim = [50, 0, 0]
intensity = 9000
beam_deg = 60
field_deg = 120
[sun]
direction = [0, 3, 4]
illuminance = 1000
angular_radius_deg = 0.1
[earth]
direction = [0, 0, 2]
altitude_km = 425
albedo = [0.1, 0.2, 0.3]
model = "lambert"
[ambient]
radiance = 2
[[camera]]
name = "A"
position = [100, 0, 0]
look_at = [0, 0, 0]
up = [0, 0, 2]
fov_deg = 30
resolution = [640, 480]
focus = 8.0
aperture = 0.012
cctv = "sit"
[[cctv]]
name = "sit"
gamma = 2.2
auto = true
levels = [1, 2.5]
kind = "tube"
[monitor]
rows = 300
spread = "gaussian"
[quality]
error = 0.05
patch_edge = 0.5
form_factor_rays = 512
gather_rays = 1e2
solver_tolerance = 1e-6
)");
  EXPECT_EQ(scene.name, "everything");
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.diffuse, Rgb(0.1, 0.2, 0.3));
  EXPECT_EQ(m.specular, Rgb(0.9));
  EXPECT_EQ(m.shininess, 40.0);
  EXPECT_EQ(m.transmit, Rgb(0.1, 0.1, 0.2));
  EXPECT_EQ(m.ior, 1.5);
  EXPECT_EQ(m.light_group, "panels");
  EXPECT_TRUE(m.two_sided);
  const Object& box = scene.objects.at(0);
  EXPECT_TRUE(box.target);
  EXPECT_EQ(box.source, "box");
  EXPECT_EQ(box.polygon_count, 6U);
  EXPECT_EQ(box.triangle_count, 12U);
  EXPECT_NEAR(box.area_m2, 4 * 22.0, 1e-12);
  Vec3 low(1e9), high(-1e9);
  for (const Vec3& v : scene.vertices) {
    low = glm::min(low, v);
    high = glm::max(high, v);
  }
  // (1, 2, 3) m doubled, a quarter turn about z, half a metre up.
  EXPECT_LT(glm::length(low - Vec3(-4, 0, 0.5)), 1e-12);
  EXPECT_LT(glm::length(high - Vec3(0, 2, 6.5)), 1e-12);
  const Lamp& lamp = scene.lamps.at(0);
  EXPECT_EQ(lamp.kind, LampKind::Spot);
  EXPECT_EQ(lamp.group, "bay");
  EXPECT_EQ(lamp.position, Vec3(0.5, 0, 1));
  EXPECT_EQ(lamp.axis, Vec3(0, 0, -1));
  EXPECT_EQ(lamp.field_deg, 120.0);
  EXPECT_LT(glm::length(scene.sun->direction - Vec3(0, 0.6, 0.8)), 1e-15);
  EXPECT_EQ(scene.sun->illuminance_lx, Rgb(1000));
  EXPECT_NEAR(scene.earth->half_angle_deg, 69.62, 0.01);
  EXPECT_EQ(scene.earth->altitude_m, 425e3);
  EXPECT_EQ(scene.earth->albedo, Rgb(0.1, 0.2, 0.3));
  EXPECT_EQ(scene.ambient_radiance, Rgb(2.0));
  const Camera& camera = scene.cameras.at(0);
  EXPECT_EQ(camera.position, Vec3(1, 0, 0));
  EXPECT_EQ(camera.up, Vec3(0, 0, 1));
  EXPECT_EQ(camera.columns, 640);
  EXPECT_EQ(camera.rows, 480);
  EXPECT_EQ(camera.focus_m, 8.0);  // metres in any unit
  EXPECT_EQ(camera.cctv, "sit");
  const SettingTable& cctv = scene.cctv.at(0);
  EXPECT_EQ(cctv.name, "sit");
  ASSERT_EQ(cctv.settings.size(), 4U);
  EXPECT_EQ(cctv.settings[0].key, "gamma");
  EXPECT_EQ(std::get<double>(cctv.settings[0].value), 2.2);
  EXPECT_TRUE(std::get<bool>(cctv.settings[1].value));
  EXPECT_EQ(std::get<std::vector<double>>(cctv.settings[2].value), (std::vector<double>{1, 2.5}));
  EXPECT_EQ(std::get<std::string>(cctv.settings[3].value), "tube");
  EXPECT_EQ(cctv.settings[3].where.line, 60);
  EXPECT_EQ(scene.monitor->name, "monitor");
  EXPECT_EQ(scene.monitor->settings.size(), 2U);
  EXPECT_EQ(scene.quality.error, 0.05);
  EXPECT_EQ(scene.quality.patch_edge_m, 0.5);
  EXPECT_EQ(scene.quality.form_factor_rays, 512);
  EXPECT_EQ(scene.quality.gather_rays, 100);
  EXPECT_EQ(scene.quality.solver_tolerance, 1e-6);
}

TEST(SceneFile, ObjectsTurnAboutXThenYThenZ) {
  const test::SceneFolder folder;
  const Scene scene = folder.read(R"(format = 1
[[material]]
name = "m"
[[object]]
name = "o"
shape = "quad"
corners = [[1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0]]
material = "m"
rotate = [90, 0, 90]
)");
  // (x, y, z) -> about x: (x, -z, y) -> about z: (z, x, y)
  EXPECT_LT(glm::length(scene.vertices.at(0) - Vec3(0, 1, 0)), 1e-15);
  EXPECT_LT(glm::length(scene.vertices.at(1) - Vec3(0, 1, 1)), 1e-15);
}

TEST(SceneFile, InwardTurnsTheFrontsAndKeepsParallelogramsInOrder) {
  const test::SceneFolder folder;
  const std::string head =
      "format = 1\n[[material]]\nname = \"m\"\n[[object]]\nname = \"o\"\nshape = \"box\"\n"
      "min = [0, 0, 0]\nmax = [1, 2, 3]\nmaterial = \"m\"\n";
  const auto volume = [](const Scene& scene) {
    double sum = 0.0;
    for (const Triangle& t : scene.triangles) {
      const auto& v = scene.vertices;
      sum += glm::dot(v[t.vertex[0]], glm::cross(v[t.vertex[1]], v[t.vertex[2]])) / 6.0;
    }
    return sum;
  };
  EXPECT_NEAR(volume(folder.read(head)), 6.0, 1e-12);
  const Scene room = folder.read(head + "inward = true\n");
  EXPECT_NEAR(volume(room), -6.0, 1e-12);
  for (std::size_t i = 0; i < room.triangles.size(); i += 2) {
    const Triangle& a = room.triangles[i];
    const Triangle& b = room.triangles[i + 1];
    EXPECT_EQ(a.polygon, b.polygon);
    EXPECT_EQ(a.vertex[0], b.vertex[0]);
    EXPECT_EQ(a.vertex[2], b.vertex[1]);
  }
}

TEST(SceneFile, FluxBecomesIntensityOrExitance) {
  const test::SceneFolder folder;
  const Scene scene = folder.read(R"(format = 1
[[light]]
name = "point"
type = "point"
position = [0, 0, 0]
flux = 100
[[light]]
name = "spot"
type = "spot"
position = [0, 0, 0]
aim = [1, 0, 0]
beam_deg = 60
field_deg = 180
flux = [100, 50, 0]
[[light]]
name = "rectangle"
type = "rectangle"
center = [0, 0, 0]
edge_u = [2, 0, 0]
edge_v = [0, 3, 0]
flux = 12
[[light]]
name = "disk"
type = "disk"
center = [0, 0, 0]
normal = [0, 0, -5]
radius = 2
exitance = 3
)");
  EXPECT_NEAR(scene.lamps[0].intensity_cd.r, 100 / (4 * base::pi), 1e-12);
  EXPECT_EQ(scene.lamps[0].group, "point");
  // Phi = 2 pi (1 - (cos 30 + cos 90) / 2) I
  EXPECT_NEAR(scene.lamps[1].intensity_cd.r, 100 / (2 * base::pi * (1 - std::sqrt(3.0) / 4)),
              1e-12);
  EXPECT_EQ(scene.lamps[1].intensity_cd.b, 0.0);
  EXPECT_EQ(scene.lamps[2].exitance, Rgb(2.0));
  EXPECT_EQ(scene.lamps[2].axis, Vec3(0, 0, 1));
  EXPECT_EQ(scene.lamps[3].exitance, Rgb(3.0));
  EXPECT_EQ(scene.lamps[3].axis, Vec3(0, 0, -1));
}

TEST(SceneFile, OrbitGivesSunAndEarthWithTheirDefaults) {
  const test::SceneFolder folder;
  const Scene scene = folder.read(
      "format = 1\n[orbit]\naltitude_km = 425\nbeta_deg = 20\nposition_deg = 50\n"
      "attitude = \"bay-to-space\"\n[earth]\nalbedo = 0.4\n");
  Orbit orbit;
  orbit.beta_deg = 20.0;
  orbit.attitude = "bay-to-space";
  const OrbitState expected = orbit_state(orbit, 50.0);
  EXPECT_EQ(scene.sun->direction, expected.sun);
  EXPECT_EQ(scene.sun->illuminance_lx, Rgb(133100));
  EXPECT_EQ(scene.earth->direction, expected.earth);
  EXPECT_EQ(scene.earth->altitude_m, 425e3);
  EXPECT_EQ(scene.earth->albedo, Rgb(0.4));
}

TEST(SceneFile, UniformEarthIsGivenByItsHalfAngle) {
  const test::SceneFolder folder;
  const Scene scene = folder.read(
      "format = 1\n[earth]\ndirection = [0, 0, 1]\nmodel = \"uniform\"\nradiance = "
      "9\nhalf_angle_deg = 70\n");
  EXPECT_EQ(scene.earth->model, EarthModel::Uniform);
  EXPECT_EQ(scene.earth->half_angle_deg, 70.0);
  EXPECT_EQ(scene.earth->altitude_m, 0.0);
  EXPECT_EQ(scene.earth->radiance, Rgb(9.0));
}

TEST(SceneFile, TextOutsideAsciiStandsInStringsAndComments) {
  const test::SceneFolder folder;
  EXPECT_EQ(folder.read("format = 1 # Größe\nname = \"Nutzlastraum – Tür\"\n").name,
            "Nutzlastraum – Tür");
}

}  // namespace
}  // namespace earthshine::scenes
