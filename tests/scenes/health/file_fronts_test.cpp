// SPDX-License-Identifier: Apache-2.0
// If a file's vertex normals agree on one side, this side is the front.
#include "scenes/health/file_fronts.h"

#include <fmt/format.h>

#include <cmath>

#include "scenes/ray_query.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

enum class Winding { In, Out, Mixed };
enum class Normals { In, Out, Apart, Faulty, None };

// Half a pipe along x, open upward: radius 2 m, 12 faces. Apart: normals of neighbouring corners
// point to different sides.
std::string trough(Winding winding, Normals normals, bool ply) {
  std::string points, vn, faces;
  constexpr int count = 12;
  for (int k = 0; k <= count; ++k) {
    const double angle = base::pi * (1.0 + double(k) / count);
    const double y = std::cos(angle), z = std::sin(angle);
    const double side =
        normals == Normals::In || (normals == Normals::Apart && k % 2 == 0) ? -1.0 : 1.0;
    for (const int x : {-3, 3}) {
      const std::string normal = normals == Normals::Faulty
                                     ? "nan nan nan"
                                     : fmt::format("0 {:.9f} {:.9f}", side * y, side * z);
      points += fmt::format("{}{} {:.9f} {:.9f}", ply ? "" : "v ", x, 2 * y, 2 * z);
      if (ply && normals != Normals::None) points += " " + normal;
      points += "\n";
      vn += "vn " + normal + "\n";
    }
  }
  for (int k = 0; k < count; ++k) {
    std::array<int, 4> corner{2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2};  // outward
    const bool in = winding == Winding::In || (winding == Winding::Mixed && k % 3 == 0);
    if (!in) std::swap(corner[1], corner[3]);
    faces += ply ? "4" : "f";
    for (const int c : corner) {
      faces += ply                        ? fmt::format(" {}", c)
               : normals == Normals::None ? fmt::format(" {}", c + 1)
                                          : fmt::format(" {0}//{0}", c + 1);
    }
    faces += "\n";
  }
  if (!ply) return points + (normals == Normals::None ? "" : vn) + faces;
  const char* const more =
      normals == Normals::None ? "" : "property float nx\nproperty float ny\nproperty float nz\n";
  return fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty "
      "float "
      "z\n{}element face {}\nproperty list uchar int vertex_indices\nend_header\n{}{}",
      2 * (count + 1), more, count, points, faces);
}

struct TroughScene {
  Scene scene;
  std::string warnings;
  int inward = 0, outward = 0;  // triangles with their front toward the axis, and away from it
};

TroughScene read_trough(const std::string& mesh, const std::string& name,
                        const std::string& keys = "") {
  const test::SceneFolder folder;
  folder.put(name, mesh);
  TroughScene found;
  found.scene = folder.read(
      "format = 1\n[[material]]\nname = \"w\"\ndiffuse = 0.5\n[[object]]\nname = \"liner\"\nmesh = "
      "\"" +
      name + "\"\nmaterial = \"w\"\n" + keys +
      "[[camera]]\nname = \"A\"\nposition = [-2.5, 0, 0.5]\nlook_at = [2, 0, -1.5]\n");
  for (const std::string& warning : found.scene.warnings) found.warnings += warning + "\n";
  for (std::uint32_t t = 0; t < found.scene.triangles.size(); ++t) {
    const Vec3 normal = triangle_normal(found.scene, t);
    const Vec3& corner = found.scene.vertices[found.scene.triangles[t].vertex[0]];
    const double away = normal.y * corner.y + normal.z * corner.z;
    ++(away > 0.0 ? found.outward : found.inward);
  }
  return found;
}

TEST(FileFronts, NormalsSayWhichSideIsTheFront) {
  for (const bool ply : {false, true}) {
    const std::string name = ply ? "m.ply" : "m.obj";
    for (const Winding winding : {Winding::In, Winding::Out, Winding::Mixed}) {
      const TroughScene in = read_trough(trough(winding, Normals::In, ply), name);
      EXPECT_EQ(in.inward, 24) << name;
      EXPECT_EQ(holds(in.warnings, {"vertex normals", "turned"}), winding != Winding::In)
          << in.warnings;
      const TroughScene out = read_trough(trough(winding, Normals::Out, ply), name);
      EXPECT_EQ(out.outward, 24) << name;
      EXPECT_EQ(out.warnings.empty(), winding == Winding::Out) << out.warnings;
    }
  }
}

// Missing, invalid or contradictory normals have no effect.
TEST(FileFronts, NormalsThatSayNothingChangeNothing) {
  for (const bool ply : {false, true}) {
    const std::string name = ply ? "m.ply" : "m.obj";
    for (const Normals normals : {Normals::Apart, Normals::Faulty, Normals::None}) {
      if (ply && normals == Normals::Faulty) continue;  // nan is a valid number in PLY files
      EXPECT_EQ(read_trough(trough(Winding::Out, normals, ply), name).outward, 24);
      EXPECT_EQ(read_trough(trough(Winding::In, normals, ply), name).inward, 24);
      const TroughScene mixed = read_trough(trough(Winding::Mixed, normals, ply), name);
      EXPECT_TRUE(mixed.inward == 8 && mixed.outward == 16) << mixed.inward;
      // The front should face the cameras.
      EXPECT_TRUE(holds(mixed.warnings, {"wound against each other", "orient = \"inward\""}))
          << mixed.warnings;
    }
  }
}

TEST(FileFronts, ASceneThatSaysWhichSideIsObeyed) {
  const std::string mesh = trough(Winding::Mixed, Normals::In, false);
  EXPECT_EQ(read_trough(mesh, "m.obj", "orient = \"outward\"\n").outward, 24);
  EXPECT_EQ(read_trough(mesh, "m.obj", "orient = \"inward\"\n").inward, 24);
  EXPECT_EQ(read_trough(mesh, "m.obj", "orient = \"as-is\"\n").inward, 8);
  EXPECT_EQ(
      read_trough(trough(Winding::Mixed, Normals::None, false), "m.obj", "orient = \"inward\"\n")
          .inward,
      24);
  // inward = true reverses all faces, independent of normals.
  EXPECT_EQ(
      read_trough(trough(Winding::Out, Normals::Out, false), "m.obj", "inward = true\n").inward,
      24);
}

// After rounding each face has 24 triangles or more, all on the same side.
TEST(FileFronts, RoundedMeshesKeepTheirSide) {
  for (const Winding winding : {Winding::In, Winding::Out, Winding::Mixed}) {
    const TroughScene in =
        read_trough(trough(winding, Normals::In, false), "m.obj", "round_deg = 5\n");
    EXPECT_EQ(in.outward, 0);
    EXPECT_GT(in.inward, 24);
  }
}

TEST(FileFronts, NormalsThatAreNotUsedPointToRoundDeg) {
  const std::string mesh = trough(Winding::In, Normals::In, false);
  EXPECT_EQ(read_trough(mesh, "m.obj").scene.objects[0].unused,
            "26 vn; round_deg rounds the surface by the normals");
  EXPECT_EQ(read_trough(mesh, "m.obj", "round_deg = 5\n").scene.objects[0].unused, "");
}

}  // namespace
}  // namespace earthshine::scenes
