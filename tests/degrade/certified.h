// SPDX-License-Identifier: Apache-2.0
// Cameras and a small bench for tests of the certificate.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include "degrade/certify/certificate.h"

namespace earthshine::test {

// A tenth of the usual screen's resels, for a fast certificate.
inline degrade::Monitor small_screen() {
  degrade::Monitor monitor;
  monitor.rows = 96;
  monitor.columns = 128;
  monitor.pixels_per_resel = 2;
  return monitor;
}

// Every stage on, with parameters that all differ.
inline degrade::CctvCamera busy_camera() {
  degrade::CctvCamera camera;
  camera.magnification = 0.1;
  camera.fall_off = 4.0;
  camera.glare = 0.02;
  camera.lens_blur = 0.35;
  camera.iris = degrade::IrisMode::Normal;
  camera.f_number_min = 1.4;
  camera.f_number_max = 100.0;
  camera.white_lux = 0.02;
  camera.gain_max_db = 12.0;
  camera.shading_percent = 10.0;
  camera.blur_h = 0.4;
  camera.blur_v = 0.7;
  camera.lag = 0.4;
  camera.smear_db = 60.0;
  camera.saturation = 4.0;
  camera.bloom = 0.5;
  camera.bloom_radius = 6.0;
  camera.noise = degrade::NoiseMode::Photon;
  camera.electrons_at_white = 640.0;
  camera.read_electrons = 3.0;
  camera.prnu_percent = 2.0;
  camera.dark_electrons = 12.0;
  camera.dsnu_percent = 0.5;
  camera.bandwidth_mhz = 0.8;
  camera.aperture_correction = 0.3;
  camera.bits = 8;
  camera.interlace = true;
  return camera;
}

inline const degrade::CertificateRow* find_row(const std::vector<degrade::CertificateRow>& rows,
                                               std::string_view name) {
  const auto row = std::find_if(rows.begin(), rows.end(),
                                [&](const degrade::CertificateRow& r) { return r.name == name; });
  return row == rows.end() ? nullptr : &*row;
}

}  // namespace earthshine::test
