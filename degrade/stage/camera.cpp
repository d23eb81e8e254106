// SPDX-License-Identifier: Apache-2.0
#include "degrade/stage/camera.h"

namespace earthshine::degrade {

bool is_used(const CctvCamera& camera, std::string_view field) {
  const bool fixed = camera.iris == IrisMode::Fixed;
  const NoiseMode noise = camera.noise;
  if (field == "f_number" || field == "gain_db") return fixed;
  if (field == "f_number_min" || field == "f_number_max" || field == "gain_max_db" ||
      field == "iris_target" || field == "iris_rate" || field == "iris_slew") {
    return !fixed;
  }
  if (field == "iris_centre") return camera.iris == IrisMode::Normal;
  if (field == "snr_db") return noise == NoiseMode::Report || noise == NoiseMode::Spec;
  if (field.starts_with("noise_")) return noise == NoiseMode::Law;
  if (field == "electrons_at_white" || field == "read_electrons" || field == "excess_noise" ||
      field == "prnu_percent" || field == "dark_electrons" || field == "dsnu_percent") {
    return noise == NoiseMode::Photon;
  }
  if (field == "bloom") return camera.saturation > 0.0;
  if (field == "bloom_radius") return camera.saturation > 0.0 && camera.bloom > 0.0;
  return true;
}

}  // namespace earthshine::degrade
