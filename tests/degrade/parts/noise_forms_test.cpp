// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/noise_forms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "degrade/parts/noise.h"
#include "degrade/settings/presets.h"
#include "degrade/stage/point_map.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

CctvCamera with_noise(NoiseMode mode, double snr_db = 40.0) {
  CctvCamera camera;
  camera.noise = mode;
  camera.snr_db = snr_db;
  return camera;
}

// The camera with the settings of a form, as read from a file.
CctvCamera with_form(CctvCamera camera, const NoiseForm& form) {
  camera.noise = form.mode;
  camera.read_electrons = camera.prnu_percent = camera.dark_electrons = camera.dsnu_percent = 0.0;
  for (const auto& [name, given] : form.settings) {
    visit_camera_fields(camera,
                        [&, &key = name, &value = given](const char* k, auto& field, auto&&...) {
                          if constexpr (std::is_same_v<std::decay_t<decltype(field)>, double>) {
                            if (key == k) field = value;
                          }
                        });
  }
  return camera;
}

const NoiseForm* find(const std::vector<NoiseForm>& forms, NoiseMode mode) {
  const auto found =
      std::find_if(forms.begin(), forms.end(), [&](const auto& f) { return f.mode == mode; });
  return found == forms.end() ? nullptr : &*found;
}

// 40 dB: sigma = 1 % of white. Spec: equal sigma at every level, hence SNR(0.5) = 40 - 20 lg 2 =
// 33.98 dB and SNR(0.05) = 40 - 20 lg 20 = 13.98 dB. Report: an equal share at every level.
TEST(NoiseForms, DecibelsOfTheTwoModesPartInTheDark) {
  const NoiseWords spec = noise_words(with_noise(NoiseMode::Spec));
  EXPECT_NEAR(spec.snr_white_db, 40.0, 1e-12);
  EXPECT_NEAR(spec.snr_half_db, 40.0 - 20.0 * std::log10(2.0), 1e-12);
  EXPECT_NEAR(spec.snr_dark_db, 40.0 - 20.0 * std::log10(20.0), 1e-12);
  EXPECT_NEAR(spec.floor_db, 40.0, 1e-12);
  EXPECT_NEAR(spec.percent_at_white, 1.0, 1e-12);
  EXPECT_EQ(spec.percent_of_signal, 0.0);
  const NoiseWords report = noise_words(with_noise(NoiseMode::Report));
  EXPECT_NEAR(report.snr_dark_db, 40.0, 1e-12);
  EXPECT_EQ(report.floor_db, infinite);
  EXPECT_NEAR(report.percent_of_signal, 1.0, 1e-12);
}

// 10 lg n dB at white and 10 lg(n / 2) at half: pure shot noise, 640 electrons give 28.06 dB.
TEST(NoiseForms, ElectronsAreTheirOwnSignalToNoise) {
  CctvCamera camera = with_noise(NoiseMode::Photon);
  camera.electrons_at_white = 640.0;
  const NoiseWords words = noise_words(camera);
  EXPECT_NEAR(words.snr_white_db, 28.0618, 1e-4);
  EXPECT_NEAR(words.snr_half_db, 10.0 * std::log10(320.0), 1e-12);
  EXPECT_NEAR(words.electrons_at_white, 640.0, 1e-9);
  // An intensifier with F^2 = 2 has the noise of half the electrons. Its amplifier noise then
  // equals half as many of these electrons.
  camera.excess_noise = 2.0;
  camera.read_electrons = 10.0;
  EXPECT_NEAR(noise_words(camera).electrons_at_white, 320.0, 1e-9);
  EXPECT_NEAR(noise_words(camera).read_electrons, 5.0, 1e-9);
}

// sigma_v = sigma S^(1/gamma - 1) / gamma by the derivative of v = S^(1/gamma). The derivative is
// taken from the stage, at white and at S = 1/20. Decibels grow by 20 lg gamma at every level.
TEST(NoiseForms, GammaAddsTheSameDecibelsEverywhere) {
  const CctvCamera camera = with_noise(NoiseMode::Spec);
  const NoiseWords words = noise_words(camera);
  const auto slope = [&](double s) {
    const double h = 1e-3 * s;
    const auto coded = [&](const Picture& in) {
      return transform(in, PointMap().power(1.0 / camera.gamma)).planes[0][0];
    };
    const float up = coded(test::flat(1, 1, static_cast<float>(s + h)));
    const float down = coded(test::flat(1, 1, static_cast<float>(s - h)));
    return static_cast<double>(up - down) / (2.0 * h);
  };
  EXPECT_NEAR(words.line_sigma_white, 0.01 * slope(1.0), 1e-5);
  const double v = std::pow(0.05, 1.0 / camera.gamma);
  EXPECT_NEAR(words.snr_dark_db + words.gamma_db, 20.0 * std::log10(v / (0.01 * slope(0.05))),
              0.01);
  EXPECT_NEAR(words.line_snr_white_db, -20.0 * std::log10(words.line_sigma_white), 1e-12);
}

// A form that claims equal noise must give a camera with the same law. Other forms must be right at
// the level that they name: white or black.
TEST(NoiseForms, EveryFormGivesBackTheNoise) {
  std::vector<CctvCamera> cameras;
  for (const Preset& preset : presets()) cameras.push_back(preset.camera);
  for (const NoiseMode mode : {NoiseMode::Report, NoiseMode::Spec}) {
    cameras.push_back(with_noise(mode, 32.0));
  }
  CctvCamera law = with_noise(NoiseMode::Law);
  law.noise_a = 1e-4;
  law.noise_b = 1e-3;
  law.noise_c = 4e-4;
  cameras.push_back(law);
  for (const CctvCamera& camera : cameras) {
    const NoiseLaw wanted = noise_law(camera);
    for (const NoiseForm& form : other_forms(camera)) {
      EXPECT_NE(form.mode, camera.noise);
      const NoiseLaw got = noise_law(with_form(camera, form));
      const bool in_the_dark = form.differs.find("at black") != std::string::npos;
      const double s = in_the_dark ? 0.0 : 1.0;
      EXPECT_NEAR(got.variance(s), wanted.variance(s), 1e-9 * wanted.variance(s));
      if (form.differs.find("the same at") != std::string::npos) continue;
      EXPECT_NEAR(got.at_black(), wanted.at_black(), 1e-9 * wanted.at_black());
      EXPECT_NEAR(got.b, wanted.b, 1e-9 * wanted.b);
      EXPECT_NEAR(got.c, wanted.c, 1e-9 * wanted.c);
    }
  }
}

TEST(NoiseForms, OnlyFormsThatAFileMayHoldAreGiven) {
  EXPECT_TRUE(other_forms(with_noise(NoiseMode::None)).empty());
  const auto spec = other_forms(with_noise(NoiseMode::Spec));
  EXPECT_EQ(find(spec, NoiseMode::Photon), nullptr);  // no counts without b
  ASSERT_NE(find(spec, NoiseMode::Law), nullptr);
  EXPECT_EQ(find(spec, NoiseMode::Law)->differs, "");
  CctvCamera loud = with_noise(NoiseMode::Law);
  loud.noise_b = 2.0;  // half an electron at white; the key's minimum is 1
  EXPECT_EQ(find(other_forms(loud), NoiseMode::Photon), nullptr);
  loud.noise_b = 0.5;
  EXPECT_NE(find(other_forms(loud), NoiseMode::Photon), nullptr);
}

}  // namespace
}  // namespace earthshine::degrade
