// SPDX-License-Identifier: Apache-2.0
#include "raytrace/incoming/radiance_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/random_cuts.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// A square plate, 1 m: (s, t) = (x + 1/2, y + 1/2); hits (u, v) of its first triangle are (s - t,
// t).
scenes::Scene plate(bool two_sided = false) {
  tests::SceneBuilder builder;
  scenes::Material material = tests::grey(0.5);
  material.two_sided = two_sided;
  builder.plate(builder.material(material), 1.0, 0.0, true);
  return builder.scene;
}

scenes::Hit hit_at(double s, double t, bool front = true) {
  scenes::Hit hit;
  hit.triangle = s >= t ? 0 : 1;
  hit.u = s >= t ? s - t : s;
  hit.v = s >= t ? t : t - s;
  hit.front = front;
  return hit;
}

using Field = std::function<double(double s, double t)>;

// One light group whose radiance at each patch's centre is the field's value.
radiosity::Solution filled(const radiosity::Patches& patches, const Field& front,
                           const Field& back = {}) {
  radiosity::Solution solution;
  solution.patches = patches;
  solution.columns = 3;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    const radiosity::Rectangle r = patches.rectangle(i);
    const Field& field = patches.is_back[i] != 0 ? back : front;
    const double value = base::pi * field(0.5 * (r.s0 + r.s1), 0.5 * (r.t0 + r.t1));
    for (int c = 0; c < 3; ++c) solution.radiosity.push_back(static_cast<float>(value));
  }
  return solution;
}

const LeakMask nothing_stands_there;

double read(const RadianceTable& table, const scenes::Hit& hit) {
  std::vector<Rgb> out{Rgb(0.0)};
  table.add(hit, Rgb(1.0), out);
  return out[0].g;
}

double linear(double s, double t) { return 2.0 + s - 0.7 * t; }

TEST(RadianceTable, ALinearFieldIsReadExactlyAcrossCellsOfAnySize) {
  // Away from the plate's edge, where cells have neighbours on both sides.
  for (const bool graded : {true, false}) {
    const radiosity::Patches patches =
        tests::random_cuts(radiosity::subdivide(plate(), 1.0 / 16), graded ? 6 : 1, 0.3, 1, graded);
    const radiosity::Solution solution = filled(patches, linear);
    const RadianceTable table(solution, solution.radiosity, false, nothing_stands_there);
    base::Rng rng(base::Key(1, base::Stream::Test, 0));
    for (int k = 0; k < 5000; ++k) {
      const double s = 0.125 + 0.75 * rng.next(), t = 0.125 + 0.75 * rng.next();
      ASSERT_NEAR(read(table, hit_at(s, t)), linear(s, t), 2e-6) << s << " " << t;
    }
  }
}

TEST(RadianceTable, TheRadianceHasNoStepsBetweenCellsOfDifferentSizes) {
  // White noise at the centres, ungraded trees: across each side of a cell the value changes by no
  // more than the slope (values of 0 to 1 over a quarter of a cell) over 2e-9.
  base::Rng values(base::Key(1, base::Stream::Test, 9));
  const radiosity::Patches patches =
      tests::random_cuts(radiosity::subdivide(plate(), 0.5), 12, 0.25, 3);
  const radiosity::Solution solution =
      filled(patches, [&](double, double) { return values.next(); });
  const RadianceTable table(solution, solution.radiosity, false, nothing_stands_there);
  base::Rng rng(base::Key(1, base::Stream::Test, 1));
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    const radiosity::Rectangle r = patches.rectangle(i);
    for (int k = 0; k < 8; ++k) {
      const double t = r.t0 + rng.next() * (r.t1 - r.t0), s = r.s0 + rng.next() * (r.s1 - r.s0);
      if (r.s1 < 1.0) {
        ASSERT_NEAR(read(table, hit_at(r.s1 - 1e-9, t)), read(table, hit_at(r.s1 + 1e-9, t)), 2e-5);
      }
      if (r.t1 < 1.0) {
        ASSERT_NEAR(read(table, hit_at(s, r.t1 - 1e-9)), read(table, hit_at(s, r.t1 + 1e-9)), 2e-5);
      }
    }
  }
}

TEST(RadianceTable, AnEvenTreeReadsLikeTheGridOfItsCells) {
  const Field wavy = [](double s, double t) { return 2.0 + std::sin(9.0 * s) * std::cos(7.0 * t); };
  const radiosity::Patches cut =
      tests::all_in_four(tests::all_in_four(radiosity::subdivide(plate(), 0.2)));
  const radiosity::Patches grid = radiosity::subdivide(plate(), 0.05);
  ASSERT_EQ(cut.count(), grid.count());
  ASSERT_NE(cut.facets[0].tree, radiosity::no_tree);
  const radiosity::Solution a = filled(cut, wavy), b = filled(grid, wavy);
  const RadianceTable one(a, a.radiosity, false, nothing_stands_there),
      other(b, b.radiosity, false, nothing_stands_there);
  base::Rng rng(base::Key(1, base::Stream::Test, 2));
  for (int k = 0; k < 5000; ++k) {
    const scenes::Hit hit = hit_at(rng.next(), rng.next());
    ASSERT_NEAR(read(one, hit), read(other, hit), 2e-6);
  }
}

TEST(RadianceTable, TheErrorOnUnevenCellsFallsWithTheSquareOfTheEdge) {
  // All cells halved: a quarter of the error, except at the plate's edge, which is excluded, and in
  // the strips between cells of different sizes, whose share of the area is halved, too.
  const Field bump = [](double s, double t) { return 1.0 + s * s * t - 0.5 * t * t; };
  const auto error = [&](int more) {
    radiosity::Patches patches =
        tests::random_cuts(radiosity::subdivide(plate(), 0.125), 3, 0.3, 5, true);
    for (int k = 0; k < more; ++k) patches = tests::all_in_four(std::move(patches));
    const radiosity::Solution solution = filled(patches, bump);
    const RadianceTable table(solution, solution.radiosity, false, nothing_stands_there);
    base::Rng rng(base::Key(1, base::Stream::Test, 3));
    double sum = 0.0;
    for (int k = 0; k < 4000; ++k) {
      const double s = 0.2 + 0.6 * rng.next(), t = 0.2 + 0.6 * rng.next();
      sum += std::pow(read(table, hit_at(s, t)) - bump(s, t), 2);
    }
    return std::sqrt(sum / 4000.0);
  };
  const double before = error(2), after = error(3), last = error(4);
  EXPECT_NEAR(before / after, 4.0, 0.4);
  EXPECT_NEAR(after / last, 4.0, 0.2);
}

TEST(RadianceTable, EachSideOfAnUnevenSheetHasItsOwnLight) {
  const radiosity::Patches patches =
      tests::random_cuts(radiosity::subdivide(plate(true), 0.25), 5, 0.3, 1);
  const radiosity::Solution solution = filled(
      patches, [](double, double) { return 3.0; }, [](double, double) { return 5.0; });
  const RadianceTable table(solution, solution.radiosity, false, nothing_stands_there);
  EXPECT_NEAR(read(table, hit_at(0.3, 0.6, true)), 3.0, 1e-5);
  EXPECT_NEAR(read(table, hit_at(0.3, 0.6, false)), 5.0, 1e-5);
}

}  // namespace
}  // namespace earthshine::raytrace
