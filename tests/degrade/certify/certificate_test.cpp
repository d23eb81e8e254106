// SPDX-License-Identifier: Apache-2.0
// Correct cameras pass. certificate_defects_test.cpp tests that wrong ones fail.
#include "degrade/certify/certificate.h"

#include <gtest/gtest.h>

#include <set>

#include "base/error.h"
#include "degrade/settings/presets.h"
#include "tests/degrade/certified.h"

namespace earthshine::degrade {
namespace {

using test::busy_camera;
using test::find_row;
using test::small_screen;

// The seed is fixed; over all seeds a row of four standard errors fails once in 16000.
void expect_passes(const CctvCamera& camera, const Monitor& monitor, std::string_view what) {
  const Certificate certificate = certify(camera, monitor, {.seed = 3});
  for (const CertificateRow& row : certificate.rows) {
    EXPECT_TRUE(row.verdict != Verdict::Fail)
        << what << ": " << row.group << ": " << row.name << ": measured " << row.measured << " +- "
        << row.tolerance << ", law " << row.expected;
  }
  EXPECT_TRUE(certificate.passed());
  EXPECT_EQ(certificate.failures(), "");
}

TEST(Certificate, EveryCameraThatShipsPasses) {
  for (const Preset& preset : presets()) expect_passes(preset.camera, small_screen(), preset.name);
}

TEST(Certificate, CameraWithEveryPartAtWorkPassesEveryRow) {
  expect_passes(busy_camera(), small_screen(), "busy");
  // All rows except the mean of black, which does not apply to dark counts.
  const Certificate certificate = certify(busy_camera(), small_screen());
  EXPECT_EQ(certificate.count(Verdict::DoesNotApply), 1);
}

// A halo wider than the screen, a tube with long lag, noise below single precision, a fixed iris.
TEST(Certificate, CamerasAtTheEndsOfTheirRangesPass) {
  CctvCamera wide;
  wide.saturation = 4.0;
  wide.bloom = 1.0;
  wide.bloom_radius = 60.0;
  expect_passes(wide, small_screen(), "wide bloom");
  CctvCamera slow;
  slow.noise = NoiseMode::Photon;
  slow.lag = 0.95;
  slow.electrons_at_white = 5.0;
  expect_passes(slow, small_screen(), "lag, whole frames");
  slow.interlace = true;
  expect_passes(slow, small_screen(), "lag, fields");
  for (const NoiseMode mode : {NoiseMode::Report, NoiseMode::Spec}) {
    for (const double snr : {130.0, 150.0, 200.0}) {
      CctvCamera quiet;
      quiet.noise = mode;
      quiet.snr_db = snr;
      expect_passes(quiet, small_screen(), "next to no noise");
    }
  }
  CctvCamera stuck;
  stuck.f_number_min = stuck.f_number_max = 2.0;
  expect_passes(stuck, small_screen(), "iris of one stop");
}

TEST(Certificate, BlurWiderThanTheBenchIsRefused) {
  CctvCamera camera;
  camera.bandwidth_mhz = 0.01;
  EXPECT_THROW(static_cast<void>(certify(camera, small_screen())), base::Error);
}

TEST(Certificate, NoiseOfEveryModePasses) {
  CctvCamera camera;
  camera.noise = NoiseMode::Spec;
  camera.snr_db = 30.0;
  camera.black_clamp = false;
  camera.gamma = 1.0;
  expect_passes(camera, small_screen(), "spec");
  camera = busy_camera();
  camera.noise = NoiseMode::Law;
  camera.noise_a = 1e-3;
  camera.noise_b = 2e-3;
  camera.noise_c = 5e-3;
  expect_passes(camera, small_screen(), "law");
  camera.interlace = false;
  camera.colour = true;
  expect_passes(camera, small_screen(), "law, whole frames, colour");
  camera = busy_camera();
  camera.electrons_at_white = 2.0;  // single photons
  camera.excess_noise = 1.5;
  camera.lag = 0.0;
  expect_passes(camera, small_screen(), "single photons");
}

TEST(Certificate, EveryShapeOfPhosphorAndOddScreensPass) {
  for (const Spread spread : {Spread::None, Spread::Triangle, Spread::Sinc}) {
    Monitor monitor = small_screen();
    monitor.spread = spread;
    monitor.spread_width = 1.3;
    monitor.rows = 81;
    monitor.columns = 97;
    monitor.pixels_per_resel = 3;
    monitor.black_luminance = 0.0;
    monitor.room_illuminance = 0.0;
    expect_passes(CctvCamera{}, monitor, word_of(spread));
  }
}

TEST(Certificate, FixedIrisAndStrongBlurPass) {
  CctvCamera camera = busy_camera();
  camera.iris = IrisMode::Fixed;
  camera.f_number = 8.0;
  camera.blur_h = 2.5;
  camera.blur_v = 1.5;
  camera.saturation = 0.6;  // less than white
  camera.white_clip = 0.9;
  camera.bits = 3;
  expect_passes(camera, small_screen(), "fixed");
  const Certificate certificate = certify(camera, small_screen());
  EXPECT_EQ(find_row(certificate.rows, "all tests of the iris")->why, "it is fixed");
}

TEST(Certificate, SameSeedSameNumbersAnotherSeedOthers) {
  const CctvCamera camera = find_preset("sit-monochrome")->camera;
  const auto numbers = [&](std::uint64_t seed) {
    std::vector<double> found;
    for (const CertificateRow& row : certify(camera, small_screen(), {.seed = seed}).rows) {
      found.push_back(row.measured);
    }
    return found;
  };
  EXPECT_EQ(numbers(1), numbers(1));
  EXPECT_NE(numbers(1), numbers(2));
}

TEST(Certificate, RowsHaveNamesOfTheirOwnLawsAndReasons) {
  const Certificate certificate = certify(busy_camera(), small_screen());
  std::set<std::string> names;
  for (const CertificateRow& row : certificate.rows) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    if (row.verdict == Verdict::DoesNotApply) {
      EXPECT_FALSE(row.why.empty()) << row.name;
    } else {
      EXPECT_FALSE(row.law.empty()) << row.name;
    }
  }
  EXPECT_EQ(certificate.photon_transfer.size(), 12U);
  EXPECT_EQ(certificate.sharpness.size(), 21U);
  EXPECT_NEAR(certificate.sharpness.front().along, 1.0, 1e-3);
}

TEST(Certificate, ScreenTooSmallToMeasureIsRefused) {
  Monitor monitor;
  monitor.rows = least_certified_resels - 1;
  try {
    (void)certify(CctvCamera{}, monitor);
    FAIL() << "a certificate came out";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.blame(), base::Blame::Input);
    EXPECT_NE(std::string(error.what()).find("63 rows"), std::string::npos) << error.what();
  }
  monitor.rows = least_certified_resels;
  monitor.columns = least_certified_resels;
  expect_passes(find_preset("ccd-colour")->camera, monitor, "smallest");
}

}  // namespace
}  // namespace earthshine::degrade
