// SPDX-License-Identifier: Apache-2.0
// Settings of a CCTV camera: lens, iris, sensor, noise, electronics (docs/cctv.md).
//   S       video signal, linear, 1 at the reference white
//   N       f-number, so that the sensor receives E = pi tau L / (4 N^2) lx from luminance L
//   a, b, c noise law sigma^2(S) = a + b S + c S^2
// Lengths in the picture are in resels: picture elements of the monitor, 300 per picture height.
#pragma once

#include <array>
#include <string_view>

#include "degrade/stage/fields.h"

namespace earthshine::degrade {

// Metering of the automatic iris. Fixed: the iris does not move.
enum class IrisMode { Fixed, Peak, Normal, Average };
[[nodiscard]] constexpr std::array<std::string_view, 4> words_of(IrisMode) {
  return {"fixed", "peak", "normal", "average"};
}

// Source of a, b and c.
//   Report  c = 1/SNR^2: a percentage of each point's intensity, as in the 1990 report
//   Spec    a = 1/SNR^2: white level over rms noise, as in camera data sheets
//   Photon  b = F^2/n, a = (read/n)^2, c = prnu^2, n the electrons at white: EMVA 1288 and tubes
//   Law     a, b and c themselves
enum class NoiseMode { None, Report, Spec, Photon, Law };
[[nodiscard]] constexpr std::array<std::string_view, 5> words_of(NoiseMode) {
  return {"none", "report", "spec", "photon", "law"};
}

// The defaults are an ideal camera: its iris adapts to any scene, and it loses or adds no light.
struct CctvCamera {
  bool colour = false;

  double transmittance = 0.8;
  double magnification = 0.0;
  double fall_off = 0.0;
  double glare = 0.0;
  double lens_blur = 0.0;

  IrisMode iris = IrisMode::Peak;
  double f_number = 4.0;
  double f_number_min = 0.5;
  double f_number_max = 1e6;
  double iris_target = 0.0;
  double iris_centre = 0.5;
  double white_lux = 1e-6;  // with the f-numbers above: any scene from 4e-7 to 1.6e6 cd/m^2
  double gain_db = 0.0;
  double gain_max_db = 0.0;
  double iris_rate = 1.0;
  double iris_slew = 0.0;

  double shading_percent = 0.0;
  double blur_h = 0.0;
  double blur_v = 0.0;
  double lag = 0.0;
  double smear_db = 0.0;
  double saturation = 0.0;
  double bloom = 0.0;
  double bloom_radius = 15.0;

  NoiseMode noise = NoiseMode::None;
  double snr_db = 40.0;
  double noise_a = 0.0;
  double noise_b = 0.0;
  double noise_c = 0.0;
  double electrons_at_white = 10000.0;
  double read_electrons = 0.0;
  double excess_noise = 1.0;
  double prnu_percent = 0.0;
  double dark_electrons = 0.0;
  double dsnu_percent = 0.0;

  double bandwidth_mhz = 0.0;
  double aperture_correction = 0.0;
  bool black_clamp = true;
  double white_clip = 1.1;
  double gamma = 2.2;
  int bits = 0;
  bool interlace = false;
};

template <class Camera, class Visitor>
void visit_camera_fields(Camera& c, Visitor&& field) {
  field("colour", c.colour, no_limits, "", "red, green and blue; otherwise luminance only");
  field("transmittance", c.transmittance, Limits{0.001, 1.0}, "1", "of the lens, tau");
  field("magnification", c.magnification, Limits{0.0, 10.0}, "1",
        "size of the image over size of the thing: E falls by (1 + m)^2");
  field("fall_off", c.fall_off, Limits{0.0, 8.0}, "1",
        "power of the field angle's cosine that dims the corners; 4: a simple lens");
  field("glare", c.glare, Limits{0.0, 0.9}, "1",
        "share of the light spread over the whole picture");
  field("lens_blur", c.lens_blur, Limits{0.0, 10.0}, "resel",
        "standard deviation of a point's light behind the lens");
  field("iris", c.iris, no_limits, "", "what the iris follows");
  field("f_number", c.f_number, Limits{0.5, 1e6}, "1", "iris = fixed: where it stands");
  field("f_number_min", c.f_number_min, Limits{0.5, 1e6}, "1", "wide open");
  field("f_number_max", c.f_number_max, Limits{0.5, 1e6}, "1",
        "closed, density spot or shutter included");
  field("iris_target", c.iris_target, Limits{0.0, 1.0}, "1",
        "signal that the metered value is brought to; 0: peak 1, normal 0.5, average 0.25");
  field("iris_centre", c.iris_centre, Limits{0.0, 1.0}, "1",
        "iris = normal: how much less the picture's corners count");
  field("white_lux", c.white_lux, Limits{1e-9, 1e9}, "lx",
        "sensor illuminance of signal 1 at gain 1");
  field("gain_db", c.gain_db, Limits{0.0, 80.0}, "dB", "iris = fixed: gain");
  field("gain_max_db", c.gain_max_db, Limits{0.0, 80.0}, "dB", "largest automatic gain");
  field("iris_rate", c.iris_rate, Limits{0.01, 2.5}, "1",
        "share of the way in ln N^2 that the iris goes in a frame; 1: at once");
  field("iris_slew", c.iris_slew, Limits{0.0, 20.0}, "stop/frame",
        "fastest that the iris can go; 0: any");
  field("shading_percent", c.shading_percent, Limits{0.0, 100.0}, "%",
        "how much less sensitive the sensor's corners are");
  field("blur_h", c.blur_h, Limits{0.0, 10.0}, "resel",
        "standard deviation of the spread along a line");
  field("blur_v", c.blur_v, Limits{0.0, 10.0}, "resel",
        "standard deviation of the spread across lines");
  field("lag", c.lag, Limits{0.0, 0.95}, "1", "share of the signal left after a field");
  field("smear_db", c.smear_db, Limits{0.0, 200.0}, "dB",
        "a bright tenth of the picture's height over what it leaves in its column; 0: none");
  field("saturation", c.saturation, Limits{0.0, 1e6}, "1",
        "largest signal the sensor holds; 0: any");
  field("bloom", c.bloom, Limits{0.0, 1.0}, "1",
        "share of the light above saturation that flows to the surround");
  field("bloom_radius", c.bloom_radius, Limits{0.1, 100.0}, "resel",
        "standard deviation of the bloom");
  field("noise", c.noise, no_limits, "", "where the noise law comes from");
  field("snr_db", c.snr_db, Limits{0.0, 200.0}, "dB",
        "noise = report or spec: 20 lg(1 / sigma(1))");
  field("noise_a", c.noise_a, Limits{0.0, 10.0}, "1", "noise = law: constant part of the variance");
  field("noise_b", c.noise_b, Limits{0.0, 10.0}, "1", "noise = law: variance per signal");
  field("noise_c", c.noise_c, Limits{0.0, 10.0}, "1", "noise = law: variance per signal squared");
  field("electrons_at_white", c.electrons_at_white, Limits{1.0, 1e9}, "1",
        "noise = photon: electrons per resel and frame at signal 1");
  field("read_electrons", c.read_electrons, Limits{0.0, 1e6}, "1",
        "noise = photon: rms of the amplifier");
  field("excess_noise", c.excess_noise, Limits{1.0, 100.0}, "1",
        "noise = photon: factor F^2 of an intensifier");
  field("prnu_percent", c.prnu_percent, Limits{0.0, 50.0}, "%",
        "noise = photon: spread of sensitivity");
  field("dark_electrons", c.dark_electrons, Limits{0.0, 1e9}, "1",
        "noise = photon: dark counts per resel and frame, their mean subtracted");
  field("dsnu_percent", c.dsnu_percent, Limits{0.0, 50.0}, "%",
        "noise = photon: spread of black over white, the same pattern in every frame");
  field("bandwidth_mhz", c.bandwidth_mhz, Limits{0.0, 100.0}, "MHz",
        "-3 dB along a line of 52.66 us; 0: any, else 0.01 or more");
  field("aperture_correction", c.aperture_correction, Limits{0.0, 4.0}, "1",
        "k of the transfer 1 + k (1 - cos 2 pi f) along a line");
  field("black_clamp", c.black_clamp, no_limits, "", "signals below black become black");
  field("white_clip", c.white_clip, Limits{0.0, 10.0}, "1", "largest signal on the line; 0: any");
  field("gamma", c.gamma, Limits{0.2, 5.0}, "1", "line signal = S^(1/gamma); 1: linear");
  field("bits", c.bits, Limits{0.0, 16.0}, "1", "quantisation of the line signal; 0: analogue");
  field("interlace", c.interlace, no_limits, "", "two fields a frame, each with noise of its own");
}

// Whether a field has an effect in this camera. The reader refuses settings without effect.
[[nodiscard]] bool is_used(const CctvCamera& camera, std::string_view field);

}  // namespace earthshine::degrade
