// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/noise_forms.h"

#include <cmath>
#include <limits>

#include "degrade/parts/noise.h"

namespace earthshine::degrade {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

double decibels_over(double variance) {
  return variance > 0.0 ? -10.0 * std::log10(variance) : infinite;
}

bool within_limits(const NoiseForm& form) {
  bool all = true;
  const CctvCamera camera;
  visit_camera_fields(camera, [&](const std::string& key, const auto&, Limits limits, auto&&...) {
    for (const auto& [name, value] : form.settings) {
      if (name == key && !(value >= limits.least && value <= limits.most)) all = false;
    }
  });
  return all;
}

}  // namespace

NoiseWords noise_words(const CctvCamera& camera) {
  const NoiseLaw law = noise_law(camera);
  const auto snr_db = [&](double s) { return decibels_over(law.variance(s) / (s * s)); };
  NoiseWords words;
  words.a = law.at_black();
  words.b = law.b;
  words.c = law.c;
  words.snr_white_db = snr_db(1.0);
  words.snr_half_db = snr_db(0.5);
  words.snr_dark_db = snr_db(0.05);
  words.floor_db = decibels_over(words.a);
  words.percent_at_white = 100.0 * std::sqrt(law.variance(1.0));
  words.percent_of_signal = 100.0 * std::sqrt(law.c);
  words.electrons_at_white = law.b > 0.0 ? 1.0 / law.b : infinite;
  words.read_electrons = law.b > 0.0 ? std::sqrt(words.a) / law.b : 0.0;
  words.line_sigma_white = std::sqrt(law.variance(1.0)) / camera.gamma;
  words.gamma_db = 20.0 * std::log10(camera.gamma);
  words.line_snr_white_db = words.snr_white_db + words.gamma_db;
  return words;
}

namespace {

// Properties of a photon camera's noise that a law of three numbers omits.
std::string lost_in_law(const NoiseLaw& law) {
  std::string lost;
  if ((law.c_is_fixed_pattern && law.c > 0.0) || law.black_pattern > 0.0) {
    lost = "patterns new in every frame";
  }
  if (law.dark > 0.0) lost += std::string(lost.empty() ? "" : ", ") + "dark counts not blurred";
  return lost;
}

}  // namespace

std::vector<NoiseForm> other_forms(const CctvCamera& camera) {
  const NoiseWords words = noise_words(camera);
  std::vector<NoiseForm> forms;
  if (!std::isfinite(words.snr_white_db)) return forms;
  const double n = words.electrons_at_white;
  forms.push_back({NoiseMode::Law,
                   {{"noise_a", words.a}, {"noise_b", words.b}, {"noise_c", words.c}},
                   lost_in_law(noise_law(camera))});
  if (std::isfinite(n)) {
    forms.push_back({NoiseMode::Photon,
                     {{"electrons_at_white", n},
                      {"read_electrons", words.read_electrons},
                      {"excess_noise", 1.0},
                      {"prnu_percent", words.percent_of_signal}},
                     words.c > 0.0 ? "c the same pattern in every frame" : ""});
  }
  forms.push_back({NoiseMode::Report,
                   {{"snr_db", words.snr_white_db}},
                   words.a > 0.0 || words.b > 0.0 ? "the same at white, less in the dark" : ""});
  forms.push_back({NoiseMode::Spec,
                   {{"snr_db", words.snr_white_db}},
                   words.b > 0.0 || words.c > 0.0 ? "the same at white, more in the dark" : ""});
  if (words.a > 0.0 && (words.b > 0.0 || words.c > 0.0)) {
    forms.push_back(
        {NoiseMode::Spec, {{"snr_db", words.floor_db}}, "the same at black, less above"});
  }
  std::erase_if(forms, [&](const NoiseForm& form) {
    return form.mode == camera.noise || !within_limits(form);
  });
  return forms;
}

}  // namespace earthshine::degrade
