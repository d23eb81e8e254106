// SPDX-License-Identifier: Apache-2.0
#include "raytrace/incoming/leak_mask.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "raytrace/incoming/radiance_table.h"
#include "tests/support/random_cuts.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// A sheet, 1 m, (s, t) = (x + 1/2, y + 1/2), and an oblique wall on its front, so that no division
// of the facet follows it: from (-1, -0.35) to (1, 0.25), 1 m high.
constexpr double rise = 0.3, middle = -0.05;

scenes::Scene walled_plate() {
  tests::SceneBuilder builder;
  scenes::Material material = tests::grey(0.5);
  material.two_sided = true;
  builder.plate(builder.material(material), 1.0, 0.0, true);
  builder.quad(0, {-1, middle - rise, 0}, {1, middle + rise, 0}, {1, middle + rise, 1},
               {-1, middle - rise, 1});
  return builder.scene;
}

bool beyond(double s, double t) { return t - 0.5 > middle + rise * (s - 0.5); }

using Field = std::function<double(double s, double t)>;

radiosity::Solution solution_of(const radiosity::Patches& patches, const Field& field) {
  radiosity::Solution solution;
  solution.patches = patches;
  solution.columns = 3;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    const radiosity::Rectangle r = patches.rectangle(i);
    const double value = base::pi * field(0.5 * (r.s0 + r.s1), 0.5 * (r.t0 + r.t1));
    for (int c = 0; c < 3; ++c) solution.radiosity.push_back(static_cast<float>(value));
  }
  return solution;
}

double read(const RadianceTable& table, double s, double t, bool front) {
  scenes::Hit hit;
  hit.triangle = s >= t ? 0 : 1;
  hit.u = s >= t ? s - t : s;
  hit.v = s >= t ? t : t - s;
  hit.front = front;
  std::vector<Rgb> out{Rgb(0.0)};
  table.add(hit, Rgb(1.0), out);
  return out[0].g;
}

std::vector<radiosity::Patches> even_and_uneven(const scenes::Scene& scene) {
  return {radiosity::subdivide(scene, 1.0 / 16),
          tests::random_cuts(radiosity::subdivide(scene, 1.0 / 8), 5, 0.3, 1)};
}

TEST(LeakMask, NoLightIsReadAcrossAWall) {
  // 1 on one side, a million on the other, by the cells' centres: a cell that sees only cells on
  // its own side reads its own value at each of its points, to rounding. The back of the sheet has
  // no wall: there the radiance is interpolated between both.
  const scenes::Scene scene = walled_plate();
  const scenes::RayQuery query(scene);
  for (const radiosity::Patches& patches : even_and_uneven(scene)) {
    const radiosity::Solution solution =
        solution_of(patches, [](double s, double t) { return beyond(s, t) ? 1e6 : 1.0; });
    const LeakMask sight(query, patches);
    const RadianceTable table(solution, solution.radiosity, false, sight);
    base::Rng rng(base::Key(1, base::Stream::Test, 0));
    int between = 0;
    for (int k = 0; k < 5000; ++k) {
      const double s = rng.next(), t = rng.next();
      const std::uint32_t leaf = patches.leaf(patches.facets[0], {s, t});
      const radiosity::Rectangle r = patches.rectangle(leaf);
      const double own = beyond(0.5 * (r.s0 + r.s1), 0.5 * (r.t0 + r.t1)) ? 1e6 : 1.0;
      ASSERT_NEAR(read(table, s, t, true) / own, 1.0, 1e-5) << s << " " << t;
      const double behind = read(table, s, t, false);
      if (behind > 2.0 && behind < 0.9e6) ++between;
    }
    EXPECT_GT(between, 100);
  }
}

TEST(LeakMask, ALinearFieldIsReadExactlyAwayFromTheWall) {
  const scenes::Scene scene = walled_plate();
  const scenes::RayQuery query(scene);
  const Field linear = [](double s, double t) { return 2.0 + s - 0.7 * t; };
  for (const radiosity::Patches& patches : even_and_uneven(scene)) {
    const radiosity::Solution solution = solution_of(patches, linear);
    const LeakMask sight(query, patches);
    const RadianceTable table(solution, solution.radiosity, false, sight);
    base::Rng rng(base::Key(1, base::Stream::Test, 1));
    for (int k = 0; k < 5000; ++k) {
      const double s = 0.125 + 0.75 * rng.next(), t = 0.125 + 0.75 * rng.next();
      // The centre of a cell at the wall is within half a cell's diagonal, 0.09, of it; cells that
      // read such a cell are within another 0.18.
      if (std::abs(t - 0.5 - middle - rise * (s - 0.5)) < 0.28) continue;
      ASSERT_NEAR(read(table, s, t, true), linear(s, t), 2e-6) << s << " " << t;
    }
  }
}

TEST(LeakMask, WeightsAddUpToOneBesideTheWall) {
  const scenes::Scene scene = walled_plate();
  const scenes::RayQuery query(scene);
  for (const radiosity::Patches& patches : even_and_uneven(scene)) {
    const radiosity::Solution solution = solution_of(patches, [](double, double) { return 3.0; });
    const LeakMask sight(query, patches);
    const RadianceTable table(solution, solution.radiosity, false, sight);
    base::Rng rng(base::Key(1, base::Stream::Test, 2));
    for (int k = 0; k < 5000; ++k) {
      const double s = rng.next(), t = rng.next();
      ASSERT_NEAR(read(table, s, t, true), 3.0, 1e-5);
    }
  }
}

TEST(LeakMask, OnlyTheSideOnWhichTheWallStandsIsParted) {
  const scenes::Scene scene = walled_plate();
  const scenes::RayQuery query(scene);
  const radiosity::Patches patches = radiosity::subdivide(scene, 1.0 / 16);
  const LeakMask sight(query, patches);
  const radiosity::Facet& plate = patches.facets[0];
  int parted = 0;
  for (std::uint32_t leaf = 0; leaf + 1 < plate.leaves; ++leaf) {
    if (leaf % plate.t_count + 1 == plate.t_count) continue;
    const radiosity::Rectangle a = patches.rectangle(leaf), b = patches.rectangle(leaf + 1);
    const bool apart = beyond(0.5 * (a.s0 + a.s1), 0.5 * (a.t0 + a.t1)) !=
                       beyond(0.5 * (b.s0 + b.s1), 0.5 * (b.t0 + b.t1));
    EXPECT_EQ(sight.parted(plate.first_front + leaf, plate.first_front + leaf + 1), apart);
    EXPECT_FALSE(sight.parted(plate.first_back + leaf, plate.first_back + leaf + 1));
    parted += apart ? 1 : 0;
  }
  EXPECT_EQ(parted, 16);  // one per column
}

}  // namespace
}  // namespace earthshine::raytrace
