// SPDX-License-Identifier: Apache-2.0
// The noise laws of transfer_law.h.
#include <cmath>

#include "degrade/parts/transfer_law.h"

namespace earthshine::degrade {

double LineNoise::in_time(double signal, int dx, int dy) const {
  const bool other_field = two_fields && dy % 2 != 0;
  const double counts = (dark + light * signal + share * signal * signal) * lag;
  return counts * (other_field ? field_to_field : 1.0) * light_filter.covariance(dx, dy) +
         (other_field ? 0.0 : amplifier * amplifier_filter.covariance(dx, dy));
}

double LineNoise::fixed(double signal, int dx, int dy) const {
  return fixed_share * signal * signal * light_filter.covariance(dx, dy) +
         fixed_black * amplifier_filter.covariance(dx, dy);
}

double LineNoise::light_cumulant(double signal, int order) const {
  if (light == 0.0) return 0.0;
  // A still picture is (1 - k) of its field and k of the previous one, whose deviation is smaller
  // by the root of the lag factor.
  const double k = field_to_field;
  const double fresh = std::pow(1.0 - k, order), old = std::pow(k, order);
  double kept = fresh + old * std::pow(lag, order / 2.0);
  if (two_fields) kept = 0.5 * (kept + fresh + old * kept);  // the second field follows the first
  // Counts of mean S / b + dark / b^2, each of signal b.
  double counts = kept * std::pow(light, order) * (signal / light + dark / (light * light));
  // The fixed pattern makes some resels brighter, and their counts scatter more.
  if (order == 3) counts += 3.0 * fixed_share * signal * signal * light * lag;
  return counts * light_filter.power_sum(order);
}

LineNoise line_noise(const CctvCamera& camera, const Monitor& monitor) {
  LineNoise line;
  line.light_filter = filter_of(camera, monitor, Travels::LightNoise);
  line.amplifier_filter = filter_of(camera, monitor, Travels::AmplifierNoise);
  // Share that remains from one reading to the next; a frame without interlace lasts two fields. A
  // first-order recursion of white noise has (1 - k) / (1 + k) of its variance.
  const double kept = camera.interlace ? camera.lag : camera.lag * camera.lag;
  line.lag = (1.0 - kept) / (1.0 + kept);
  line.two_fields = camera.interlace;
  line.field_to_field = kept;
  const double white_over_rms = std::pow(10.0, camera.snr_db / 20.0);
  const double n = camera.electrons_at_white;
  switch (camera.noise) {
    case NoiseMode::None:
      break;
    case NoiseMode::Report:
      line.share = 1.0 / (white_over_rms * white_over_rms);
      break;
    case NoiseMode::Spec:
      line.amplifier = 1.0 / (white_over_rms * white_over_rms);
      break;
    case NoiseMode::Law:
      line.amplifier = camera.noise_a;
      line.light = camera.noise_b;
      line.share = camera.noise_c;
      break;
    case NoiseMode::Photon:
      line.amplifier = std::pow(camera.read_electrons / n, 2.0);
      line.light = camera.excess_noise / n;
      line.dark = camera.excess_noise * camera.dark_electrons / (n * n);
      line.fixed_share = std::pow(camera.prnu_percent / 100.0, 2.0);
      line.fixed_black = std::pow(camera.dsnu_percent / 100.0, 2.0);
      break;
  }
  return line;
}

}  // namespace earthshine::degrade
