// SPDX-License-Identifier: Apache-2.0
#include "studies/orbit/condition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "degrade/settings/presets.h"
#include "tests/studies/basis_scenes.h"

namespace earthshine::studies {
namespace {

using scenes::EarthModel;

// A camera's view of a scene at some places, with its lamps on and off.
struct Judge {
  scenes::Scene scene;
  scenes::Camera camera = tests::above(3.0, 2.0);
  LightBasis basis;
  scenes::RayQuery query{scene};
  BasisView view;

  Judge(scenes::Scene of, std::vector<SkyPlace> places)
      : scene(std::move(of)),
        basis(scene, std::move(places), {{"on", false, {}}, {"off", true, {}}}),
        view(make_basis_view(basis, query, camera, tests::basis_picture(basis, camera).image)) {}

  [[nodiscard]] Outcome at(std::size_t place, std::size_t setting,
                           const std::optional<degrade::Setup>& cctv = {},
                           bool explain = false) const {
    ConditionOptions options;
    using Explain = ConditionOptions::Explain;
    options.explain = explain ? Explain::NotIdentified : Explain::None;
    return judge_conditions(basis, query, view, {{place, setting}}, cctv, options).front();
  }
};

// A plate on ground, a lamp above it.
tests::SceneBuilder plate_and_lamp() {
  auto builder = tests::plate_on_ground(0.3, 0.6);
  builder.scene.lamps = {tests::point_lamp("lamp", "lamp", {0.2, 0.1, 6.0}, Rgb(4e5))};
  return builder;
}

// Noon with the Sun overhead, for a spacecraft whose bay faces away from the Earth; and midnight.
std::vector<SkyPlace> noon_and_midnight() {
  return tests::orbit_places({0, 180}, EarthModel::Lambert, "bay-to-space");
}

SourceOnTarget source_of(const TargetOutcome& target, const std::string& group) {
  const auto found = std::find_if(target.sources.begin(), target.sources.end(),
                                  [&](const SourceOnTarget& s) { return s.group == group; });
  EXPECT_NE(found, target.sources.end()) << group;
  return found == target.sources.end() ? SourceOnTarget{} : *found;
}

TEST(Condition, LuminanceByGroupAddsUpToTheTargets) {
  auto builder = plate_and_lamp();
  builder.quad(1, {0.7, -0.5, 0}, {0.7, -0.5, 0.5}, {0.7, 0.5, 0.5},
               {0.7, 0.5, 0});  // adds reflected light
  // At 260 deg the Sun is above the limb, on the side of the Earth.
  const Judge judge(builder.scene, tests::orbit_places({60, 260, 180}, EarthModel::Lambert));
  const Judge still(builder.scene, {judge.basis.places()[1]});
  for (const auto& [of, place, setting] :
       {std::tuple{&judge, 0, 0}, {&judge, 1, 0}, {&judge, 1, 1}, {&judge, 2, 0}, {&still, 0, 0}}) {
    const Outcome outcome =
        of->at(static_cast<std::size_t>(place), static_cast<std::size_t>(setting));
    double sum = 0.0;
    for (const SourceOnTarget& source : outcome.targets[0].sources) sum += source.luminance;
    ASSERT_TRUE(outcome.sight.targets[0].luminance);
    if (of == &judge && place == 1) {
      EXPECT_GT(source_of(outcome.targets[0], "sun").luminance, 0.1 * sum);
      EXPECT_GT(source_of(outcome.targets[0], "earth").luminance, 1e-4 * sum);
    }
    // Weighted floats against weighted means of floats: a rounding for each of some 60 groups.
    EXPECT_NEAR(sum / *outcome.sight.targets[0].luminance, 1.0, 60 * 0x1p-24) << place << setting;
  }
}

TEST(Condition, ASourceThatIsOffSaysWhy) {
  const Judge judge(plate_and_lamp().scene, noon_and_midnight());
  const TargetOutcome noon = judge.at(0, 1).targets[0], night = judge.at(1, 0).targets[0];
  EXPECT_EQ(source_of(noon, "sun").off, "");
  EXPECT_EQ(source_of(noon, "lamp").off, "switched off");
  EXPECT_EQ(source_of(noon, "lamp").luminance, 0.0);
  EXPECT_EQ(source_of(noon, "lamp").lit, 0.0);
  EXPECT_EQ(source_of(night, "sun").off, "in the Earth's shadow");
  EXPECT_EQ(source_of(night, "sun").luminance, 0.0);
  EXPECT_EQ(source_of(night, "earth").off, "has its night side below");
  EXPECT_EQ(source_of(night, "lamp").off, "");
  EXPECT_EQ(judge.at(0, 0).sun_share, 1.0);
  EXPECT_EQ(judge.at(1, 0).sun_share, 0.0);
}

// E of the Sun overhead on rho 0.6, and I cos^3 / d^2 of the lamp: there is only direct light.
TEST(Condition, SourcesHaveTheirDirectLight) {
  const Judge judge(plate_and_lamp().scene, noon_and_midnight());
  const TargetOutcome noon = judge.at(0, 0).targets[0];
  const SourceOnTarget sun = source_of(noon, "sun"), lamp = source_of(noon, "lamp");
  EXPECT_NEAR(sun.direct, 0.6 / base::pi * 133100.0, 1e-3 * sun.direct);
  EXPECT_NEAR(sun.luminance, sun.direct, 1e-3 * sun.direct);
  EXPECT_NEAR(lamp.luminance, lamp.direct, 0.01 * lamp.direct);  // without the edge
  EXPECT_GT(lamp.direct, 0.0);
  EXPECT_EQ(sun.lit, 1.0);
  EXPECT_EQ(sun.facing, 1.0);
  EXPECT_EQ(noon.lit_fraction, 1.0);
}

TEST(Condition, BehindAWallNothingIsLit) {
  // A roof above the plate and above the camera: no Sun, no lamp.
  auto builder = plate_and_lamp();
  builder.plate(1, 9.0, 1.0, true);
  builder.scene.objects[2].name = "roof";
  Judge judge(builder.scene, noon_and_midnight());
  judge.camera = tests::above(0.9, 2.0);
  judge.view = make_basis_view(judge.basis, judge.query, judge.camera,
                               tests::basis_picture(judge.basis, judge.camera).image);
  const TargetOutcome day = judge.at(0, 0).targets[0];
  EXPECT_EQ(day.lit_fraction, 0.0);
  for (const char* group : {"sun", "lamp"}) {
    const SourceOnTarget source = source_of(day, group);
    EXPECT_EQ(source.lit, 0.0) << group;
    EXPECT_EQ(source.facing, 1.0) << group;
    EXPECT_EQ(source.shadow_of, std::vector<std::string>{"roof"}) << group;
    EXPECT_EQ(source.direct, 0.0) << group;
    EXPECT_GT(source.unshadowed, 0.0) << group;
  }
}

// The unshadowed light of the Earth's night side is its light at noon, with the Sun behind the
// spacecraft.
TEST(Condition, NightSideSaysWhatTheDaySideWouldGive) {
  const Judge judge(plate_and_lamp().scene, tests::orbit_places({0, 180}, EarthModel::Lambert));
  const SourceOnTarget noon = source_of(judge.at(0, 0).targets[0], "earth"),
                       night = source_of(judge.at(1, 0).targets[0], "earth");
  EXPECT_GT(noon.direct, 0.0);
  EXPECT_EQ(night.direct, 0.0);
  EXPECT_NEAR(night.unshadowed, noon.unshadowed, 1e-6 * noon.unshadowed);
}

TEST(Condition, LampsKnowHowFarTheTargetIs) {
  // The plate's centre is at x = 0.3, a lamp 6 m above (0.2, 0.1).
  auto builder = plate_and_lamp();
  for (std::size_t k = 4; k < 8; ++k) builder.scene.vertices[k].x += 0.3;
  const Judge judge(builder.scene, noon_and_midnight());
  const TargetOutcome noon = judge.at(0, 0).targets[0];
  EXPECT_NEAR(source_of(noon, "lamp").distance_m, std::sqrt(0.01 + 0.01 + 36.0), 0.005);
  EXPECT_EQ(source_of(noon, "sun").distance_m, 0.0);
}

// Half of the plate under a roof: the points are pixels' centres, 1 of 16 rows at the edge.
TEST(Condition, HalfAShadowIsHalfLit) {
  auto builder = tests::plate_on_ground(0.3, 0.6);
  builder.quad(1, {0, -3, 9}, {3, -3, 9}, {3, 3, 9}, {0, 3, 9});
  const Judge judge(builder.scene, noon_and_midnight());
  EXPECT_NEAR(*judge.at(0, 0).targets[0].lit_fraction, 0.5, 1.0 / 8.0);
  EXPECT_EQ(judge.at(1, 0).targets[0].lit_fraction, 0.0);
}

TEST(Condition, IrisAndMonitorBelongToACctv) {
  const Judge judge(plate_and_lamp().scene, noon_and_midnight());
  const degrade::Setup cctv{degrade::presets().front().camera, {}, {}};
  const Outcome with = judge.at(0, 0, cctv), without = judge.at(0, 0);
  EXPECT_TRUE(with.sight.exposure);
  EXPECT_TRUE(with.sight.targets[0].monitor && with.sight.targets[0].signal);
  EXPECT_TRUE(with.sight.targets[0].saturated);
  EXPECT_FALSE(without.sight.exposure);
  EXPECT_FALSE(without.sight.targets[0].monitor || without.sight.targets[0].signal ||
               without.sight.targets[0].saturated);
  EXPECT_TRUE(without.sight.targets[0].eye);
}

TEST(Condition, InTheDarkThereIsNoErrorToState) {
  const Judge judge(plate_and_lamp().scene, noon_and_midnight());
  const TargetOutcome dark = judge.at(1, 1).targets[0];
  EXPECT_FALSE(dark.basis_error);
  EXPECT_EQ(dark.lit_fraction, 0.0);
  const auto by_lamp = judge.at(1, 0).targets[0].basis_error;
  ASSERT_TRUE(by_lamp);
  EXPECT_EQ(by_lamp->bound, 0.0);
  const base::Image night =
      weighted_sum(judge.view.layers, judge.basis.groups().names, judge.basis.weights(1, 1));
  for (const float value : night.find("G")->values) EXPECT_EQ(value, 0.0F);
}

TEST(Condition, OutOfViewNothingIsSaid) {
  auto builder = plate_and_lamp();
  builder.quad(0, {50, 50, 0}, {51, 50, 0}, {51, 51, 0}, {50, 51, 0});
  builder.scene.objects[2].target = true;
  const Judge judge(builder.scene, noon_and_midnight());
  const Outcome outcome = judge.at(0, 0, {}, true);
  ASSERT_EQ(outcome.targets.size(), 2U);
  EXPECT_EQ(outcome.sight.targets[1].verdict, Verdict::OutOfView);
  EXPECT_FALSE(outcome.targets[1].lit_fraction || outcome.targets[1].basis_error);
  EXPECT_FALSE(outcome.targets[1].why.text.empty());
  for (const SourceOnTarget& source : outcome.targets[1].sources) {
    EXPECT_EQ(source.lit, 0.0);
    EXPECT_EQ(source.luminance, 0.0);
  }
}

// Midnight with the lamps off is identical at two places. With very weak lamps it is identical,
// too, but the target is brighter than without, and has its own reasons. At noon it is identified.
TEST(Condition, ReasonsAreWorkedOutOncePerRunOfLikeConditions) {
  const Judge judge(plate_and_lamp().scene,
                    tests::orbit_places({180, 181, 0}, EarthModel::Lambert, "bay-to-space"));
  ConditionOptions options;
  options.lamps = 1e-11;
  const std::vector<ConditionAt> conditions = {{0, 1}, {1, 1}, {2, 1}, {0, 0}, {1, 0}};
  const std::optional<degrade::Setup> eye;
  const auto found =
      judge_conditions(judge.basis, judge.query, judge.view, conditions, eye, options);
  ASSERT_EQ(found.size(), conditions.size());
  const std::vector<std::optional<std::size_t>> of = {{}, 0, {}, {}, 3};
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    const TargetOutcome& target = found[k].targets[0];
    const Outcome alone =
        judge_conditions(judge.basis, judge.query, judge.view, {conditions[k]}, eye, options)
            .front();
    EXPECT_EQ(target.why_of, of[k]) << k;
    EXPECT_EQ(target.why.text, alone.targets[0].why.text) << k;
    EXPECT_EQ(found[k].sight.targets[0].luminance, alone.sight.targets[0].luminance) << k;
    EXPECT_EQ(target.why.text.empty(), k == 2) << k;
  }
  options.before_each = [] { throw std::domain_error("enough"); };
  EXPECT_THROW(
      (void)judge_conditions(judge.basis, judge.query, judge.view, conditions, eye, options),
      std::domain_error);
}

}  // namespace
}  // namespace earthshine::studies
