// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"
#include "scenes/light/ies_file.h"
#include "scenes/light/lamp_light.h"
#include "tests/support/ies_text.h"

namespace earthshine::scenes {
namespace {

Vec3 random_point(base::Rng& rng, double size) {
  const double x = rng.next(), y = rng.next(), z = rng.next();
  return size * Vec3(x - 0.5, y - 0.5, z - 0.5);
}

Vec3 random_direction(base::Rng& rng) { return glm::normalize(random_point(rng, 1.0) + 1e-3); }

// Lamps of every kind at random positions in a cube of 20 m.
std::vector<Lamp> strewn_lamps(std::size_t count) {
  base::Rng rng(base::Key(1, base::Stream::Test, 70));
  tests::IesText downward, upward;
  upward.vertical = {90.0, 120.0, 180.0};
  std::vector<Lamp> lamps(count);
  for (std::size_t k = 0; k < count; ++k) {
    Lamp& lamp = lamps[k];
    lamp.kind = static_cast<LampKind>(k % 5);
    lamp.position = random_point(rng, 20.0);
    lamp.axis = random_direction(rng);
    lamp.intensity_cd = lamp.exitance = Rgb(std::exp(4.0 * rng.next()));
    lamp.beam_deg = 40.0 * rng.next();
    lamp.field_deg = lamp.beam_deg + 130.0 * rng.next();
    lamp.radius_m = rng.next();
    const base::Frame3 frame = base::frame_around(lamp.axis);
    lamp.edge_u = frame.tangent * rng.next();
    lamp.edge_v = frame.bitangent * rng.next();
    lamp.c0 = frame.tangent;
    if (lamp.kind == LampKind::Measured) {
      lamp.photometry = parse_ies((k % 2 == 0 ? downward : upward).text(), "a").light;
    }
  }
  return lamps;
}

LightTree tree_of(const std::vector<Lamp>& lamps) {
  std::vector<LightBounds> bounds;
  for (const Lamp& lamp : lamps) bounds.push_back(bounds_of(lamp));
  return LightTree(bounds);
}

// Unoccluded light of a lamp on a glossy plate.
double contribution(const Lamp& lamp, const Receiver& receiver, double u = 0.5, double v = 0.5) {
  const LightSample sample = sample_lamp(lamp, receiver.point, u, v);
  const double alpha = std::max(0.0, glm::dot(sample.direction, receiver.mirrored));
  return sample.normal_illuminance_lx.g *
         std::max(0.0, glm::dot(sample.direction, receiver.normal)) *
         (receiver.diffuse + receiver.specular * std::pow(alpha, receiver.shininess));
}

std::vector<Receiver> random_receivers(std::size_t count) {
  base::Rng rng(base::Key(1, base::Stream::Test, 71));
  std::vector<Receiver> receivers(count);
  for (std::size_t k = 0; k < count; ++k) {
    receivers[k].point = random_point(rng, 22.0);
    receivers[k].normal = random_direction(rng);
    receivers[k].mirrored = random_direction(rng);
    if (k % 2 == 1) receivers[k].specular = 3.0;
    receivers[k].shininess = 1.0 + 100.0 * rng.next();
  }
  return receivers;
}

TEST(LightTree, ExpectedLightIsThatOfAllLampsWhateverHidesSome) {
  // A third of the lamps is occluded. Independent draws: four standard errors of their mean.
  const std::vector<Lamp> lamps = strewn_lamps(300);
  const LightTree tree = tree_of(lamps);
  base::Rng rng(base::Key(1, base::Stream::Test, 72));
  std::vector<LightChoice> chosen;
  for (const Receiver& receiver : random_receivers(20)) {
    double exact = 0.0;
    std::vector<double> value(lamps.size());
    for (std::size_t k = 0; k < lamps.size(); ++k) {
      value[k] = k % 3 == 0 ? 0.0 : contribution(lamps[k], receiver);
      exact += value[k];
    }
    const int draws = 3000;
    double mean = 0.0, square = 0.0;
    for (int n = 0; n < draws; ++n) {
      chosen.clear();
      tree.choose(receiver, rng.next(), 1.0 / 8.0, chosen);
      double sum = 0.0;
      for (const LightChoice& choice : chosen) sum += choice.weight * value[choice.light];
      mean += sum / draws;
      square += sum * sum / draws;
    }
    const double std_error = std::sqrt(std::max(0.0, square - mean * mean) / draws);
    EXPECT_NEAR(mean, exact, 4.0 * std_error + 1e-12 * exact);
    EXPECT_LE(std_error * std::sqrt(double(draws)), exact);  // a single choice is informative
  }
}

TEST(LightTree, LightsThatMatterAreAlwaysChosenWhole) {
  const std::vector<Lamp> lamps = strewn_lamps(300);
  const LightTree tree = tree_of(lamps);
  const double share = 1.0 / 16.0;
  std::vector<LightChoice> chosen;
  int mattering = 0;
  for (const Receiver& receiver : random_receivers(200)) {
    double all = 0.0;
    for (const Lamp& lamp : lamps) all += contribution(lamp, receiver);
    chosen.clear();
    tree.choose(receiver, 0.3, share, chosen);
    for (std::size_t k = 0; k < lamps.size(); ++k) {
      // The tree's total comes from its bounds, which are too large by a factor of a few: lights
      // four times above the share must always be chosen.
      if (contribution(lamps[k], receiver) < 4.0 * share * all || all <= 0.0) continue;
      ++mattering;
      const auto found = std::find_if(chosen.begin(), chosen.end(),
                                      [&](const LightChoice& c) { return c.light == k; });
      ASSERT_NE(found, chosen.end());
      EXPECT_EQ(found->weight, 1.0);
    }
  }
  EXPECT_GT(mattering, 100);
}

TEST(LightTree, NoLightThatReachesThePointIsLeftOut) {
  // Each lamp as its own tree: chosen if any point of it gives light.
  base::Rng rng(base::Key(1, base::Stream::Test, 73));
  std::vector<LightChoice> chosen;
  const std::vector<Receiver> receivers = random_receivers(200);
  int lit = 0, left_out = 0;
  for (const Lamp& lamp : strewn_lamps(50)) {
    const LightTree tree = tree_of({lamp});
    for (Receiver receiver : receivers) {
      receiver.point = lamp.position + 0.1 * receiver.point;  // near, where the extent matters
      chosen.clear();
      tree.choose(receiver, 0.5, 1.0 / 16.0, chosen);
      left_out += chosen.empty() ? 1 : 0;
      if (contribution(lamp, receiver, rng.next(), rng.next()) <= 0.0) continue;
      ++lit;
      ASSERT_EQ(chosen.size(), 1U);
      EXPECT_EQ(chosen[0].weight, 1.0);
    }
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(left_out, 1000);
}

TEST(LightTree, ChosenLightsStayFewAsLampsGrowMany) {
  std::vector<LightChoice> chosen;
  for (const std::size_t count : {16U, 256U, 4096U}) {
    const LightTree tree = tree_of(strewn_lamps(count));
    EXPECT_EQ(tree.count(), count);
    std::size_t most = 0;
    for (const Receiver& receiver : random_receivers(200)) {
      chosen.clear();
      tree.choose(receiver, 0.7, 1.0 / 16.0, chosen);
      most = std::max(most, chosen.size());
    }
    EXPECT_LE(most, 40U) << count;
  }
}

TEST(LightTree, LampsInOnePlaceAndNoneAtAll) {
  std::vector<LightChoice> chosen;
  LightTree({}).choose({}, 0.5, 0.1, chosen);
  EXPECT_TRUE(chosen.empty());
  Lamp lamp;
  lamp.intensity_cd = Rgb(1.0);
  const LightTree tree = tree_of(std::vector<Lamp>(100, lamp));
  Receiver receiver;
  receiver.point = Vec3(0, 0, -1);
  tree.choose(receiver, 0.999999, 0.1, chosen);
  double weight = 0.0;
  for (const LightChoice& choice : chosen) weight += choice.weight;
  EXPECT_NEAR(weight, 100.0, 1e-9);
  chosen.clear();
  receiver.point = lamp.position;
  tree.choose(receiver, 0.0, 0.1, chosen);  // amid the lights: finite, any value
  for (const LightChoice& choice : chosen) EXPECT_TRUE(std::isfinite(choice.weight));
}

}  // namespace
}  // namespace earthshine::scenes
