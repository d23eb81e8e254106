// SPDX-License-Identifier: Apache-2.0
// The certificate must detect errors. Each case wraps the chain in one error, most of them found in
// published camera simulators, and names the row that must fail. All rows pass for the correct
// chain (certificate_test.cpp).
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "degrade/certify/certificate.h"
#include "degrade/certify/test_bench.h"
#include "tests/degrade/certified.h"
#include "tests/degrade/chain_defects.h"

namespace earthshine::degrade {
namespace {

using test::Call;
using test::chain_of;
using test::changed;
using test::Defect;
using test::linear;
using test::steps;

std::vector<Defect> defects() {
  using Names = std::vector<std::string>;
  const auto off = [](const Names& names) {
    return [names](Call& call) {
      for (const std::string& name : names) {
        if (!call.leaves_out(name)) call.options.off.push_back(name);
      }
    };
  };
  return {
      // Signal and noise.
      linear("NoiseAddedToASecondSignal", "mean signal of white",
             [](double s, std::size_t) { return 2.0 * s; }),
      {"PictureDividedByItsBrightest", "linearity: worst level's distance from the line",
       test::divided_by_brightest},
      linear("DimSignalsSetToZero", "linearity: worst level's distance from the line",
             [](double s, std::size_t) { return s < 0.1 ? 0.0 : s; }),
      linear("SensitivityPatternOfMeanTwo", "mean signal of white",
             [](double s, std::size_t i) { return s * (1.0 + std::exp(0.01 * test::uniform(i))); }),
      linear("SensitivityPatternTwice", "PRNU, fixed pattern of white",
             [](double s, std::size_t i) { return s * (1.0 + 0.1 * (test::uniform(i) - 0.5)); }),
      linear("PatternOfBlack", "DSNU, fixed pattern of black",
             [](double s, std::size_t i) { return s + 0.05 * (test::uniform(i) - 0.5); }),
      changed("TwiceTheDeviation", "b, noise of the light",
              [](Call& call) { call.camera.excess_noise *= 4.0; }),
      changed(
          "DeviationTakenForVariance", "b, noise of the light",
          [](Call& call) { call.camera.excess_noise = std::sqrt(call.camera.electrons_at_white); }),
      changed("DarkCountsTimesTimeSquared", "a, noise of black",
              [](Call& call) { call.camera.dark_electrons *= 0.01; }),
      changed("DarkCountsWithoutNoise", "dynamic range on the line",
              [](Call& call) { call.camera.dark_electrons = 0.0; }),
      changed("LagWithoutEffectOnNoise", "b, noise of the light", off({"lag"})),
      changed("EachPhotonCountedFourTimes", "electrons at white",
              [](Call& call) { call.camera.electrons_at_white *= 4.0; }),
      changed("NoiseLeftOut", "SNR on the line, at white", off({"signal-noise", "read-noise"})),
      // Optics.
      changed("LightFallsAsTheFNumber", "signal at twice the f-number",
              [](Call& call) { call.camera.f_number = std::sqrt(call.camera.f_number * 1.4); }),
      changed("GlareAddedTwice", "glare: veil on black",
              [](Call& call) { call.camera.glare *= 2.0; }),
      changed("FallOffOfThirdPower", "fall-off: corner over centre",
              [](Call& call) { call.camera.fall_off = 3.0; }),
      changed("NoShading", "shading: corner over centre", off({"shading"})),
      changed("SmearOfPower", "smear under a patch of a tenth of the height",
              [](Call& call) { call.camera.smear_db /= 2.0; }),
      changed("AllOfTheExcessBlooms", "bloom: halo beside an overloaded square",
              [](Call& call) { call.camera.bloom = 1.0; }),
      // Electronics.
      {"NoClampBeforeThePower", "gamma: largest distance of the line signal from its law",
       test::power_of_negative},
      steps("DitherAndRounding", "step: variance over q^2",
            [](double v, std::size_t i) { return std::round(v + test::uniform(i) - 0.5); }),
      steps("StepsCutOff", "step: mean over q",
            [](double v, std::size_t) { return std::floor(v); }),
      changed("NoWhiteClip", "white clip of the line", off({"white-clip"})),
      changed("NoSaturation", "saturation of the sensor", off({"saturation"})),
      changed("GainInPower", "gain of 6.02 dB: largest difference from twice the signal",
              [](Call& call) { call.camera.gain_db /= 2.0; }),
      // Sharpness.
      changed("BlurDropped", "along the line: MTF at Nyquist", off({"blur"})),
      changed("BlurTurned", "across lines: MTF at Nyquist",
              [](Call& call) { std::swap(call.camera.blur_h, call.camera.blur_v); }),
      changed("LensSpreadDropped", "across lines: MTF, worst difference up to Nyquist",
              [](Call& call) { call.camera.lens_blur = 0.0; }),
      changed("BandwidthNotTiedToTheLine", "along the line: MTF50",
              [](Call& call) { call.camera.bandwidth_mhz *= 2.0; }),
      changed("NoApertureCorrection", "along the line: RER",
              [](Call& call) { call.camera.aperture_correction = 0.0; }),
      {"NearestPixelForTheMean", "along the line: MTF at Nyquist", test::nearest_pixel},
      // Iris.
      changed("IrisAtAnotherTarget", "metered signal over its target, less 1: worst of its range",
              [](Call& call) { call.camera.iris_target = 0.55; }),
      changed("IrisWithoutItsLastStop", "range of the iris",
              [](Call& call) { call.camera.f_number_max /= 1.4; }),
      changed("GainLimitedTooSoon", "darkest flat scene not underexposed",
              [](Call& call) { call.camera.gain_max_db -= 1.0; }),
      changed("EveryMeterIsTheMean", "f-numbers, normal over average",
              [](Call& call) {
                if (call.camera.iris == IrisMode::Normal) call.camera.iris = IrisMode::Average;
              }),
      // Monitor.
      {"SpreadBeforeGamma", "mean luminance of a checkerboard of resels",
       test::spread_before_gamma},
      changed("WiderSpot", "phosphor along the line: worst of an edge's profile",
              [](Call& call) { call.monitor.spread_width *= 1.2; }),
      changed("NoRoom", "luminance of black",
              [](Call& call) { call.monitor.room_illuminance = 0.0; }),
      changed("AnotherGamma", "luminance of half drive",
              [](Call& call) { call.monitor.gamma = 2.0; }),
      // Repeatability.
      changed("SeedIgnored", "correlation with another seed",
              [](Call& call) { call.options.seed = 1; }),
      changed("FrameIgnored", "correlation with another frame",
              [](Call& call) { call.options.frame = 0; }),
      changed("ViewIgnored", "correlation with another view",
              [](Call& call) { call.options.view = 0; }),
      changed("BothFieldsAlike", "correlation with the next line", off({"interlace"})),
      {"NoiseAfterBlur", "correlation with the next resel", test::noise_after_blur},
      changed("NoiseCannotBeLeftOut", "differing values, noise left out against a camera without",
              [](Call& call) { std::erase(call.options.off, "signal-noise"); }),
      test::never_the_same_twice(),
      linear("NoiseGrowsFromLeftToRight", "z of sixteen tiles' variances",
             [](double s, std::size_t i) {
               const std::size_t columns = static_cast<std::size_t>(test::small_screen().columns);
               const double x = static_cast<double>(i % columns) / static_cast<double>(columns);
               return 0.5 + (s - 0.5) * (0.8 + 0.4 * x);
             }),
  };
}

// Rows of the group of `row`, measured through the chain.
Rows measured_group(const std::string& row, const CertifyOptions& options) {
  static const std::vector<CertificateRow> right =
      certify(test::busy_camera(), test::small_screen()).rows;
  const CertificateRow* found = test::find_row(right, row);
  if (found == nullptr) return {};
  const Bench bench(test::busy_camera(), test::small_screen(), options);
  std::vector<TransferPoint> transfer;
  std::vector<SharpnessPoint> sharpness;
  if (found->group == "photon transfer") return photon_transfer_rows(bench, transfer);
  if (found->group == "optics") return optics_rows(bench);
  if (found->group == "electronics") return electronics_rows(bench);
  if (found->group == "slanted edge") return edge_rows(bench, sharpness);
  if (found->group == "iris") return iris_rows(bench);
  if (found->group == "raster") return raster_rows(bench);
  return repeatability_rows(bench);
}

class CertificateDefects : public testing::TestWithParam<Defect> {};

TEST_P(CertificateDefects, AreSeenByTheirRow) {
  const Defect& defect = GetParam();
  const Rows rows = measured_group(defect.row, {.seed = 3, .chain = chain_of(defect)});
  const CertificateRow* row = test::find_row(rows, defect.row);
  ASSERT_NE(row, nullptr) << defect.row;
  EXPECT_TRUE(row->verdict == Verdict::Fail)
      << "measured " << row->measured << " +- " << row->tolerance << ", law " << row->expected;
}

INSTANTIATE_TEST_SUITE_P(, CertificateDefects, testing::ValuesIn(defects()),
                         [](const auto& made) { return made.param.name; });

// The skewness is not tested with lag, so that this camera has none.
TEST(CertificateDefect, NoiseCutOnOneSideIsSkew) {
  const Defect cut = linear("Cut", "", [](double s, std::size_t) { return std::min(s, 0.51); });
  CctvCamera camera = test::busy_camera();
  camera.lag = 0.0;
  const auto skewness = [&](const CertifyOptions& options) {
    const Rows rows = repeatability_rows(Bench(camera, test::small_screen(), options));
    return test::find_row(rows, "skewness of the noise")->verdict;
  };
  EXPECT_TRUE(skewness({.seed = 3}) == Verdict::Pass);
  EXPECT_TRUE(skewness({.seed = 3, .chain = chain_of(cut)}) == Verdict::Fail);
}

TEST(CertificateDefect, IsNamedByTheCertificate) {
  const Defect defect = changed("Darker", "", [](Call& call) { call.camera.transmittance *= 0.9; });
  const Certificate certificate =
      certify(test::busy_camera(), test::small_screen(), {.seed = 3, .chain = chain_of(defect)});
  EXPECT_FALSE(certificate.passed());
  EXPECT_GT(certificate.count(Verdict::Fail), 5);
  EXPECT_NE(certificate.failures().find("photon transfer: mean signal of white"),
            std::string::npos);
}

}  // namespace
}  // namespace earthshine::degrade
