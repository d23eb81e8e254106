// SPDX-License-Identifier: Apache-2.0
// Laws of EMVA 1288 for fields with known noise.
#include "degrade/certify/photon_transfer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "degrade/parts/noise.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

constexpr int edge = 200;
constexpr double signals[] = {0.0, 0.05, 0.2, 0.5, 0.8, 1.0};

std::vector<FlatField> measured(const NoiseLaw& law, std::size_t frames, std::size_t planes = 1) {
  const std::vector<Block> blocks = cut_blocks(edge, edge, 0, 10);
  std::vector<FlatField> fields;
  std::uint64_t frame = 0;
  for (const double s : signals) {
    std::vector<Picture> pictures;
    for (std::size_t k = 0; k < frames; ++k, ++frame) {
      const NoiseKey key{9, frame, 0};
      pictures.push_back(add_read_noise(
          add_signal_noise(test::flat(edge, edge, static_cast<float>(s), planes), law, key), law,
          key));
    }
    fields.push_back(measure_flat(s, pictures, blocks));
  }
  return fields;
}

void expect_near(const Estimate& found, double law, const char* what) {
  EXPECT_NEAR(found.value, law, 4.0 * found.error + 1e-13) << what;
}

TEST(PhotonTransfer, FindsEveryPartOfTheLawWithinFourStandardErrors) {
  const NoiseLaw law{.a = 2e-4,
                     .b = 1e-3,
                     .c = 4e-4,
                     .c_is_fixed_pattern = true,
                     .dark = 5e-5,
                     .black_pattern = 1e-4};
  for (const std::size_t frames : {2U, 5U}) {
    const PhotonTransfer found = fit_photon_transfer(measured(law, frames));
    expect_near(found.a, law.a + law.dark, "a");
    expect_near(found.b, law.b, "b");
    expect_near(found.c, 0.0, "c");
    expect_near(found.fixed_a, law.black_pattern, "DSNU^2");
    expect_near(found.fixed_c, law.c, "PRNU^2");
  }
}

TEST(PhotonTransfer, NoiseThatIsNewInEachFrameLeavesNoPattern) {
  const PhotonTransfer found = fit_photon_transfer(measured({.a = 1e-4, .c = 9e-4}, 3));
  expect_near(found.a, 1e-4, "a");
  expect_near(found.b, 0.0, "b");
  expect_near(found.c, 9e-4, "c");
  expect_near(found.fixed_a, 0.0, "DSNU^2");
  expect_near(found.fixed_c, 0.0, "PRNU^2");
}

// Without the subtraction of (in time) / L the mean of two frames would have half of it as pattern.
TEST(PhotonTransfer, VarianceInSpaceIsFreeOfNoiseInTime) {
  for (const std::size_t frames : {2U, 4U}) {
    const FlatField white = measured({.a = 1e-2}, frames).back();
    const Estimate space = mean_of(white.in_space);
    EXPECT_NEAR(space.value, 0.0, 4.0 * space.error);
    EXPECT_LT(space.error, 1e-4);
    const Estimate time = mean_of(white.in_time);
    EXPECT_NEAR(time.value, 1e-2, 4.0 * time.error);
  }
}

// A sample variance of n normal values has the standard deviation sigma^2 sqrt(2 / (n - 1)).
TEST(PhotonTransfer, ErrorOfAVarianceIsThatOfNormalNoise) {
  const Estimate time = mean_of(measured({.a = 1e-2}, 2).back().in_time);
  EXPECT_NEAR(time.error, 1e-2 * std::sqrt(2.0 / (edge * edge)), 0.15 * time.error);
}

// A chart without noise: no error, and all parts of the law are zero.
TEST(PhotonTransfer, NoNoiseIsZeroNotAFault) {
  const PhotonTransfer found = fit_photon_transfer(measured({}, 2));
  for (const Estimate& part : {found.a, found.b, found.c, found.fixed_a, found.fixed_c}) {
    EXPECT_EQ(part.value, 0.0);
    EXPECT_EQ(part.error, 0.0);
  }
}

TEST(PhotonTransfer, ColoursArePooled) {
  EXPECT_EQ(measured({.a = 1e-4}, 2, 3).front().mean.size(), 3U * 400U);
}

}  // namespace
}  // namespace earthshine::degrade
