// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "raytrace/camera/camera.h"
#include "tests/support/boxes.h"

namespace earthshine::raytrace {
namespace {

enum class Faces { Outward, Inward };

class Place {
 public:
  tests::SceneBuilder builder;

  // An axis-parallel box as one object; without its top it is open.
  void box(const std::string& name, const Vec3& low, const Vec3& high, std::uint32_t material,
           Faces faces = Faces::Outward, bool closed = true) {
    scenes::Scene& scene = builder.scene;
    const auto object = static_cast<std::uint32_t>(scene.objects.size());
    const auto first = static_cast<std::uint32_t>(scene.triangles.size());
    tests::add_box(builder, material, low, high);
    if (!closed) scene.triangles.resize(scene.triangles.size() - 2);
    if (faces == Faces::Inward) {
      for (auto t = first; t < scene.triangles.size(); ++t) {
        std::swap(scene.triangles[t].vertex[1], scene.triangles[t].vertex[2]);
      }
    }
    scene.objects.resize(object);
    scenes::Object record;
    record.name = name;
    record.first_triangle = first;
    record.triangle_count = static_cast<std::uint32_t>(scene.triangles.size()) - first;
    for (std::uint32_t t = first; t < scene.triangles.size(); ++t)
      scene.triangles[t].object = object;
    scene.objects.push_back(record);
  }

  [[nodiscard]] std::string verdict(const Vec3& position) const {
    scenes::Camera camera;
    camera.name = "A";
    camera.position = position;
    camera.where = {"scene.toml", 7, 3};
    try {
      check_camera(builder.scene, scenes::RayQuery(builder.scene), camera);
    } catch (const base::Error& error) {
      EXPECT_EQ(error.blame(), base::Blame::Input);
      return error.what();
    }
    return "";
  }
};

TEST(CameraCheck, WindingNumberIsOneInsideZeroOutsideAndMinusOneInARoom) {
  Place place;
  const std::uint32_t m = place.builder.material(tests::grey(0.5));
  place.box("body", {0, 0, 0}, {1, 2, 3}, m);
  place.box("room", {0, 0, 0}, {1, 2, 3}, m, Faces::Inward);
  for (const Vec3& inside : {Vec3(0.5, 1, 1.5), Vec3(0.001, 0.001, 2.999), Vec3(0.3, 1.9, 0.1)}) {
    EXPECT_NEAR(winding_number(place.builder.scene, 0, inside), 1.0, 1e-12);
    EXPECT_NEAR(winding_number(place.builder.scene, 1, inside), -1.0, 1e-12);
  }
  EXPECT_NEAR(winding_number(place.builder.scene, 0, {1.001, 1, 1}), 0.0, 1e-12);
}

TEST(CameraCheck, OpenSurfaceWindsByItsSolidAngle) {
  // From the centre of a cube each face takes a sixth of the sphere.
  Place place;
  place.box("tub", Vec3(0), Vec3(1), place.builder.material(tests::grey(0.5)), Faces::Outward,
            false);
  EXPECT_NEAR(winding_number(place.builder.scene, 0, Vec3(0.5)), 5.0 / 6.0, 1e-12);
}

TEST(CameraCheck, CameraInsideABodyIsRefusedByTheBodysName) {
  Place place;
  place.box("tank", Vec3(0), Vec3(1), place.builder.material(tests::grey(0.5)));
  const std::string message = place.verdict({0.2, 0.7, 0.4});
  for (const char* part : {"scene.toml:7:3", "camera \"A\"", "\"tank\"", "inward = true"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  EXPECT_EQ(place.verdict({1.2, 0.7, 0.4}), "");
}

TEST(CameraCheck, CameraInsideABodyThatHoldsSomethingIsStillRefused) {
  // Some rays meet the inner box's front; most meet the tank's backs.
  Place place;
  const std::uint32_t m = place.builder.material(tests::grey(0.5));
  place.box("tank", Vec3(0), Vec3(1), m);
  place.box("pump", Vec3(0.4), Vec3(0.6), m);
  EXPECT_NE(place.verdict({0.2, 0.2, 0.2}).find("\"tank\""), std::string::npos);
}

TEST(CameraCheck, BodyInPiecesIsRefusedWhenNothingElseIsInSight) {
  // Six objects, none of them closed.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  for (scenes::Triangle& t : builder.scene.triangles) std::swap(t.vertex[1], t.vertex[2]);
  scenes::Camera camera;
  camera.name = "A";
  camera.position = Vec3(0.4);
  EXPECT_THROW(check_camera(builder.scene, scenes::RayQuery(builder.scene), camera), base::Error);
}

TEST(CameraCheck, RoomsHullsBaysGlassAndOpenSkyArePlacesToLookFrom) {
  const Vec3 eye(0.3, 0.6, 0.4);
  scenes::Material sheet = tests::grey(0.5), glass = tests::grey(0.0);
  sheet.two_sided = true;
  glass.transmit = Rgb(0.9);
  glass.ior = 1.5;
  {
    Place inward;
    inward.box("room", Vec3(0), Vec3(1), inward.builder.material(tests::grey(0.5)), Faces::Inward);
    EXPECT_EQ(inward.verdict(eye), "");
  }
  for (const scenes::Material& material : {sheet, glass}) {
    Place walls;
    walls.box("walls", Vec3(0), Vec3(1), walls.builder.material(material));
    EXPECT_EQ(walls.verdict(eye), "");
  }
  {
    // The hull winds once around the camera, but only the lining is visible.
    Place hull;
    const std::uint32_t m = hull.builder.material(tests::grey(0.5));
    hull.box("hull", Vec3(-0.1), Vec3(1.1), m);
    hull.box("lining", Vec3(0), Vec3(1), m, Faces::Inward);
    EXPECT_EQ(hull.verdict(eye), "");
  }
  {
    Place bay;
    const std::uint32_t m = bay.builder.material(tests::grey(0.5));
    bay.box("bay", Vec3(0), Vec3(1), m, Faces::Inward, false);
    EXPECT_EQ(bay.verdict(eye), "");
    bay.box("tub from behind", Vec3(2, 0, 0), Vec3(3, 1, 1), m, Faces::Outward, false);
    EXPECT_EQ(bay.verdict({2.5, 0.5, 0.9}), "");  // five of six sides are black, the sky is not
  }
  EXPECT_EQ(Place().verdict(eye), "");
}

TEST(CameraCheck, BodyFarFromTheOriginIsStillFound) {
  Place place;
  const Vec3 far(4e6, -3e6, 2e6);
  place.box("tank", far, far + Vec3(1), place.builder.material(tests::grey(0.5)));
  EXPECT_NE(place.verdict(far + Vec3(0.3)), "");
  EXPECT_EQ(place.verdict(far + Vec3(0.3, 0.3, 1.3)), "");
}

}  // namespace
}  // namespace earthshine::raytrace
