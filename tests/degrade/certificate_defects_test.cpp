// SPDX-License-Identifier: Apache-2.0
// The certificate must be able to fail. Each case wraps the chain in one mistake, most of them
// found in published camera simulators, and names the row that has to see it. In the right chain
// all these rows pass (certificate_test.cpp).
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "base/random.h"
#include "degrade/certificate.h"
#include "degrade/test_bench.h"
#include "tests/degrade/certified.h"

namespace earthshine::degrade {
namespace {

struct Call {
  const base::Image& chart;
  CctvCamera camera;
  Monitor monitor;
  Options options;

  [[nodiscard]] bool leaves_out(std::string_view name) const {
    return std::find(options.off.begin(), options.off.end(), name) != options.off.end();
  }
  [[nodiscard]] Result run() const { return still_chain(chart, camera, monitor, options); }
  [[nodiscard]] Result run_without(std::vector<std::string> names) const {
    Options fewer = options;
    for (std::string& name : names) {
      if (!leaves_out(name)) fewer.off.push_back(std::move(name));
    }
    return still_chain(chart, camera, monitor, fewer);
  }
};

// A mistake changes the call or the linear signal, or makes the whole result.
struct Defect {
  std::string name, row;
  std::function<Result(Call)> chain;
};
std::ostream& operator<<(std::ostream& out, const Defect& defect) { return out << defect.name; }

Defect changed(std::string name, std::string row, std::function<void(Call&)> change) {
  return {std::move(name), std::move(row), [change](Call call) {
            change(call);
            return call.run();
          }};
}

// change(signal, resel) where the signal before gamma is looked at.
Defect linear(std::string name, std::string row,
              std::function<double(double, std::size_t)> change) {
  return {std::move(name), std::move(row), [change](const Call& call) {
            Result result = call.run();
            if (!call.leaves_out("camera-gamma")) return result;
            std::vector<float>& values = result.signal.channels[0].values;
            for (std::size_t i = 0; i < values.size(); ++i) {
              values[i] = static_cast<float>(change(static_cast<double>(values[i]), i));
            }
            return result;
          }};
}

double uniform(std::size_t i) { return base::uniform(base::Key(11, base::Stream::Test, 0), i); }

// Steps of the line signal by a rule of its own, rule(v in steps, resel).
Defect steps(std::string name, std::string row, std::function<double(double, std::size_t)> rule) {
  return {std::move(name), std::move(row), [rule](const Call& call) {
            if (call.leaves_out("quantisation")) return call.run();
            Result result = call.run_without({"quantisation"});
            const double levels = std::ldexp(1.0, call.camera.bits) - 1.0;
            std::vector<float>& values = result.signal.channels[0].values;
            for (std::size_t i = 0; i < values.size(); ++i) {
              values[i] =
                  static_cast<float>(rule(static_cast<double>(values[i]) * levels, i) / levels);
            }
            return result;
          }};
}

Result noise_after_blur(const Call& call) {
  Result blurred = call.run_without({"signal-noise"});
  const Result noisy = call.run_without({"blur"});
  const Result clean = call.run_without({"blur", "signal-noise"});
  for (std::size_t i = 0; i < blurred.signal.channels[0].values.size(); ++i) {
    blurred.signal.channels[0].values[i] +=
        noisy.signal.channels[0].values[i] - clean.signal.channels[0].values[i];
  }
  return blurred;
}

Result power_of_negative(const Call& call) {
  if (call.leaves_out("camera-gamma")) return call.run();
  Result result = call.run_without({"black-clamp", "white-clip", "camera-gamma", "quantisation"});
  for (float& value : result.signal.channels[0].values) {
    value = std::pow(value, static_cast<float>(1.0 / call.camera.gamma));
  }
  return result;
}

Result divided_by_brightest(const Call& call) {
  Result result = call.run();
  std::vector<float>& values = result.signal.channels[0].values;
  const float most = *std::max_element(values.begin(), values.end());
  for (float& value : values) value = most > 0.0F ? value / most : value;
  return result;
}

// The spot spreads the voltage, and the gamma comes after it.
Result spread_before_gamma(Call call) {
  const Monitor monitor = call.monitor;
  if (call.leaves_out("screen")) return call.run();
  call.monitor.gamma = 1.0;
  call.monitor.black_luminance = 0.0;
  call.monitor.white_luminance = 1.0;
  call.monitor.room_illuminance = 0.0;
  Result result = call.run();
  const double veil = monitor.reflectance * monitor.room_illuminance / 3.14159265358979323846;
  for (float& value : result.viewed.channels[0].values) {
    value = static_cast<float>(monitor.black_luminance +
                               (monitor.white_luminance - monitor.black_luminance) *
                                   std::pow(static_cast<double>(value), monitor.gamma) +
                               veil);
  }
  return result;
}

// Every second pixel of a finer chart is dropped in place of averaging.
Result nearest_pixel(const Call& call) {
  const base::Image& in = call.chart;
  if (in.width != 2 * call.monitor.columns) return call.run();
  base::Image out{call.monitor.columns, call.monitor.rows, {}};
  std::vector<float>& values = out.add("Y");
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      values[static_cast<std::size_t>(y * out.width + x)] =
          in.channels[0].values[static_cast<std::size_t>(2 * y * in.width + 2 * x)];
    }
  }
  return still_chain(out, call.camera, call.monitor, call.options);
}

Defect never_the_same_twice() {
  const auto calls = std::make_shared<std::atomic<std::uint64_t>>(0);
  return {"WallClockInTheSeed", "differing values, same seed again", [calls](Call call) {
            call.options.seed += ++*calls;
            return call.run();
          }};
}

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
       divided_by_brightest},
      linear("DimSignalsSetToZero", "linearity: worst level's distance from the line",
             [](double s, std::size_t) { return s < 0.1 ? 0.0 : s; }),
      linear("SensitivityPatternOfMeanTwo", "mean signal of white",
             [](double s, std::size_t i) { return s * (1.0 + std::exp(0.01 * uniform(i))); }),
      linear("SensitivityPatternTwice", "PRNU, fixed pattern of white",
             [](double s, std::size_t i) { return s * (1.0 + 0.1 * (uniform(i) - 0.5)); }),
      linear("PatternOfBlack", "DSNU, fixed pattern of black",
             [](double s, std::size_t i) { return s + 0.05 * (uniform(i) - 0.5); }),
      changed("TwiceTheDeviation", "b, noise of the light",
              [](Call& call) { call.camera.excess_noise *= 4.0; }),
      changed(
          "DeviationTakenForVariance", "b, noise of the light",
          [](Call& call) { call.camera.excess_noise = std::sqrt(call.camera.electrons_at_white); }),
      changed("DarkCountsTimesTimeSquared", "a, noise of black",
              [](Call& call) { call.camera.dark_electrons *= 0.01; }),
      changed("DarkCountsWithoutNoise", "dynamic range",
              [](Call& call) { call.camera.dark_electrons = 0.0; }),
      changed("LagWithoutEffectOnNoise", "b, noise of the light", off({"lag"})),
      changed("EachPhotonCountedFourTimes", "electrons at white",
              [](Call& call) { call.camera.electrons_at_white *= 4.0; }),
      changed("NoiseLeftOut", "SNR at white", off({"signal-noise", "read-noise"})),
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
       power_of_negative},
      steps("DitherAndRounding", "step: variance over q^2",
            [](double v, std::size_t i) { return std::round(v + uniform(i) - 0.5); }),
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
      {"NearestPixelForTheMean", "along the line: MTF at Nyquist", nearest_pixel},
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
      {"SpreadBeforeGamma", "mean luminance of a checkerboard of resels", spread_before_gamma},
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
      {"NoiseAfterBlur", "correlation with the next resel", noise_after_blur},
      changed("NoiseCannotBeLeftOut", "differing values, noise left out against a camera without",
              [](Call& call) { std::erase(call.options.off, "signal-noise"); }),
      never_the_same_twice(),
      linear("NoiseGrowsFromLeftToRight", "z of sixteen tiles' variances",
             [](double s, std::size_t i) {
               const std::size_t columns = static_cast<std::size_t>(test::small_screen().columns);
               const double x = static_cast<double>(i % columns) / static_cast<double>(columns);
               return 0.5 + (s - 0.5) * (0.8 + 0.4 * x);
             }),
  };
}

// The group of the row, measured through the chain.
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

Chain chain_of(const Defect& defect) {
  return [&](const base::Image& chart, const CctvCamera& camera, const Monitor& monitor,
             const Options& options) {
    return defect.chain({chart, camera, monitor, options});
  };
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

// Behind a lag the skewness is not looked at, so the camera here has none.
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
