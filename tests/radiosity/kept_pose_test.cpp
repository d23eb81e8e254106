// SPDX-License-Identifier: Apache-2.0
// Results that a solve reuses from the previous pose change no byte of the solution.
#include <fmt/format.h>

#include <algorithm>

#include "radiosity/near_lamps.h"
#include "radiosity/patches/posed_patches.h"
#include "radiosity/solution.h"
#include "scenes/effects/effects.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::radiosity {
namespace {

using test::SceneFolder;

// A bay with a floor, two walls, a block on the floor, a mirror, a sheet, and an arm on a joint
// with a lamp of its own; a standing spot and a disk, and the Earth above.
constexpr const char* pose_scene = R"(format = 1
[quality]
patch_edge = 0.4
[[material]]
name = "grey"
diffuse = 0.6
[[material]]
name = "mirror"
diffuse = 0.1
mirror = 0.7
[[material]]
name = "sheet"
diffuse = 0.5
two_sided = true
[[object]]
name = "floor"
shape = "quad"
material = "grey"
corners = [[0, 0, 0], [6, 0, 0], [6, 3, 0], [0, 3, 0]]
[[object]]
name = "wall"
shape = "quad"
material = "grey"
corners = [[0, 3, 0], [6, 3, 0], [6, 3, 2], [0, 3, 2]]
[[object]]
name = "glass"
shape = "quad"
material = "mirror"
corners = [[5.9, 0.5, 0.2], [5.9, 2.5, 0.2], [5.9, 2.5, 1.6], [5.9, 0.5, 1.6]]
[[object]]
name = "block"
shape = "box"
material = "grey"
min = [1, 1, -0.1]
max = [1.6, 1.8, 0.6]
[[object]]
name = "arm"
shape = "cylinder"
from = [3, 0.4, 0.9]
to = [3, 2.2, 0.9]
radius = 0.08
segments = 12
material = "grey"
joint = "shoulder"
[[object]]
name = "panel"
shape = "quad"
material = "sheet"
corners = [[2.8, 2.2, 0.7], [3.2, 2.2, 0.7], [3.2, 2.2, 1.1], [2.8, 2.2, 1.1]]
joint = "shoulder"
[[light]]
name = "spot"
type = "spot"
position = [0.5, 0.5, 1.8]
aim = [2, 1.5, 0]
beam_deg = 40
field_deg = 90
flux = 500
[[light]]
name = "disk"
type = "disk"
center = [5, 2.8, 1.5]
normal = [-0.3, -1, -0.4]
radius = 0.1
flux = 300
[[light]]
name = "wrist"
type = "point"
position = [3, 2.4, 0.9]
flux = 100
joint = "shoulder"
[sun]
direction = [0, 0, -1]
[earth]
model = "uniform"
direction = [0.2, 0.1, 1]
radiance = 900
half_angle_deg = 60
[[camera]]
name = "c"
position = [3, 1.5, 1.9]
look_at = [3, 1.6, 0]
[[joint]]
name = "shoulder"
pivot = [3, 0.4, 0.9]
axis = [0, 0, 1]
)";

struct Pose {
  scenes::Scene scene;
  scenes::LightGroups groups;
  scenes::Effects effects;
  std::unique_ptr<const scenes::RayQuery> query;

  Pose(const SceneFolder& folder, double angle_deg, std::optional<Vec3> centre)
      : scene(folder.read(pose_scene, {fmt::format("joint.shoulder.angle_deg={}", angle_deg)})),
        groups(scenes::find_light_groups(scene)),
        effects(scenes::find_effects(scene, groups)),
        query(std::make_unique<const scenes::RayQuery>(scene, centre)) {}
  [[nodiscard]] scenes::World world() const { return {scene, groups, effects, *query}; }
};

void expect_same(const Solution& a, const Solution& b, double angle_deg) {
  EXPECT_EQ(a.radiosity, b.radiosity) << angle_deg;
  EXPECT_EQ(a.indirect_radiosity, b.indirect_radiosity) << angle_deg;
  EXPECT_EQ(a.direct_lx, b.direct_lx) << angle_deg;
  EXPECT_EQ(a.indirect_lx, b.indirect_lx) << angle_deg;
  EXPECT_EQ(a.report.form_factor_rays, b.report.form_factor_rays);
  EXPECT_EQ(a.report.shadow_rays, b.report.shadow_rays);
  EXPECT_EQ(a.report.nonzeros, b.report.nonzeros);
  for (std::size_t o = 0; o < a.report.objects.size(); ++o) {
    EXPECT_EQ(a.report.objects[o].back_share, b.report.objects[o].back_share) << angle_deg;
  }
}

TEST(KeptPose, ChangesNoByteOfTheNextSolution) {
  const SceneFolder folder;
  const Pose first(folder, 0.0, std::nullopt);
  ASSERT_TRUE(first.effects.earth_by_gather);
  ASSERT_FALSE(first.query->specular_paths().mirrors().empty());
  const Patches patches = subdivide_near_lamps(first.scene, 0.4);
  SolveOptions options;
  options.form_factor_rays = 64;
  KeptPose kept;
  // Back to an earlier pose, too; at 40 deg the arm is over the block, at 215 outside.
  for (const double angle_deg : {0.0, 4.0, 40.0, 40.0, 215.0, 0.0}) {
    const Pose pose(folder, angle_deg, first.query->centre());
    const Patches posed = posed_patches(patches, pose.scene);
    const Solution fresh = solve(pose.world(), options, posed);
    SolveVariant variant;
    variant.kept = &kept;
    expect_same(solve(pose.world(), options, posed, variant), fresh, angle_deg);
  }
}

// Wrong rows and samples that were kept show in the next solution of the same pose.
TEST(KeptPose, IsRead) {
  const SceneFolder folder;
  const Pose pose(folder, 4.0, std::nullopt);
  const Patches patches = subdivide_near_lamps(pose.scene, 0.4);
  SolveOptions options;
  options.form_factor_rays = 64;
  KeptPose kept;
  SolveVariant variant;
  variant.kept = &kept;
  const auto solved = [&] { return solve(pose.world(), options, Patches(patches), variant); };
  const Solution right = solved();
  ASSERT_EQ(kept.samples.of_source.size(), 3U);  // spot, disk, wrist
  for (auto& [key, lamp] : kept.samples.of_source) {
    std::ranges::fill(lamp.sampled.illuminance_lx, Rgb(0.0));
  }
  const Solution dark = solved();
  EXPECT_NE(dark.direct_lx, right.direct_lx);
  EXPECT_EQ(dark.report.nonzeros, right.report.nonzeros);
  for (KeptRow& row : kept.rows.rows) row.column.clear(), row.hits.clear(), row.row.entries = 0;
  EXPECT_LT(solved().report.nonzeros, right.report.nonzeros);
}

// A rigid motion changes neither the number nor the area of patches, and those on standing objects
// are the same.
TEST(KeptPose, PosedPatchesLieOnTheirTriangles) {
  const SceneFolder folder;
  const Pose first(folder, 0.0, std::nullopt), later(folder, 70.0, first.query->centre());
  const Patches patches = subdivide_near_lamps(first.scene, 0.2);
  const Patches posed = posed_patches(patches, later.scene);
  ASSERT_EQ(posed.count(), patches.count());
  std::size_t moved = 0;
  for (std::uint32_t i = 0; i < posed.count(); ++i) {
    const bool on_arm = !later.scene.objects[posed.object(i)].joint.empty();
    const SurfacePoint then = patches.at(i, 0.3, 0.6), now = posed.at(i, 0.3, 0.6);
    if (!on_arm) {
      EXPECT_EQ(now.position, then.position);
      continue;
    }
    ++moved;
    // The same point of the same triangle.
    EXPECT_EQ(now.triangle, then.triangle);
    const auto& v = later.scene.triangles[now.triangle].vertex;
    const Vec3 normal =
        glm::normalize(glm::cross(later.scene.vertices[v[1]] - later.scene.vertices[v[0]],
                                  later.scene.vertices[v[2]] - later.scene.vertices[v[0]]));
    EXPECT_NEAR(glm::dot(now.position - later.scene.vertices[v[0]], normal), 0.0, 1e-12);
    const Vec3 pivot(3.0, 0.4, 0.9);
    EXPECT_NEAR(glm::length(now.position - pivot), glm::length(then.position - pivot), 1e-12);
  }
  EXPECT_GT(moved, 10U);
}

}  // namespace
}  // namespace earthshine::radiosity
