// SPDX-License-Identifier: Apache-2.0
// Where each number comes from stands behind it:
//   [1990]   NASA Johnson Space Center's report on simulated CCTV pictures of the payload bay, 1990
//   [GCTA]   Apollo ground-commanded television assembly, an RCA SIT camera of the same makers
//   [IUCr]   International Tables for Crystallography C, 7.1.6.5.4, on SIT tubes
//   [SCOM]   Shuttle Crew Operations Manual 2.3, the closed-circuit television
//   computed from the other numbers
//   estimate usual for the kind of device and the years; no flight figure was found
#include "degrade/presets.h"

namespace earthshine::degrade {
namespace {

constexpr CctvCamera report_1990 = {
    .iris = IrisMode::Peak,  // estimate: the report says that the iris closes for bright objects
    .noise = NoiseMode::Report,  // [1990] a percentage of the intensity of each point
    .snr_db = 20.0,              // [1990] +-10 %, read as the standard deviation
    .white_clip = 0.0,           // [1990] none spoken of; the monitor clamps at its white
    .gamma = 2.2,                // estimate: matched to the monitor, the picture is linear in light
};

constexpr CctvCamera sit_monochrome = {
    .transmittance = 0.8,      // estimate: zoom lens
    .glare = 0.02,             // estimate: veiling glare of a zoom lens
    .iris = IrisMode::Normal,  // [SCOM] one of peak, normal and average
    .f_number_min = 1.4,       // estimate
    .f_number_max = 1000.0,    // estimate: f/22 and a density spot in the iris
    .white_lux = 0.02,         // estimate: faceplate illuminance of full output, SIT tubes
    .gain_max_db = 12.0,       // estimate: gain control of target and amplifier
    .blur_h = 0.35,            // computed: 35 % response at 400 TV lines, estimate for 25 mm tubes
    .blur_v = 0.35,            // the same; the beam is round
    .saturation = 4.0,         // estimate: target storage above white
    .noise = NoiseMode::Photon,   // 28 dB at 0.02 lx; [GCTA] has above 32 dB at full light
    .electrons_at_white = 640.0,  // computed: 0.02 lx, 150 uA/lm, 1/30 s, resel of 12.8 x 9.6 mm
    .read_electrons = 2.3,  // computed: 2 nA rms at 4 MHz against 553 nA, seen before target gain
    .excess_noise = 1.0,    // estimate: target gain 1500 adds little
    .prnu_percent = 1.0,    // estimate: fixed pattern of the diode target
    .white_clip = 1.1,      // estimate: RS-170 equipment clips near 110 IRE
    .gamma = 2.2,           // estimate: corrected for the monitor; the tube is linear [IUCr] [GCTA]
};

constexpr CctvCamera sit_colour_wheel = {
    .colour = true,               // colour lens in front of the same tube
    .transmittance = 0.16,        // estimate: the wheel's filters pass about a fifth
    .glare = 0.03,                // estimate: three more surfaces
    .iris = IrisMode::Normal,     // [SCOM]
    .f_number_min = 1.4,          // estimate
    .f_number_max = 1000.0,       // estimate
    .white_lux = 0.02,            // estimate, as monochrome
    .gain_max_db = 12.0,          // estimate, as monochrome
    .blur_h = 0.6,                // [GCTA] above 200 TV lines in colour against 600 of the tube
    .blur_v = 0.35,               // as monochrome
    .saturation = 4.0,            // estimate, as monochrome
    .noise = NoiseMode::Photon,   // as monochrome
    .electrons_at_white = 213.0,  // computed: a third of the time for each colour
    .read_electrons = 2.3,        // as monochrome
    .excess_noise = 1.0,          // as monochrome
    .prnu_percent = 1.0,          // as monochrome
    .white_clip = 1.1,            // as monochrome
    .gamma = 2.2,                 // as monochrome
};

constexpr CctvCamera ccd_colour = {
    .colour = true,
    .transmittance = 0.8,        // estimate
    .glare = 0.01,               // estimate
    .iris = IrisMode::Normal,    // [SCOM]
    .f_number_min = 1.4,         // estimate
    .f_number_max = 360.0,       // estimate: f/22, and an electronic shutter to 1/8000 s
    .white_lux = 2.0,            // estimate: 2/3 inch interline CCD
    .gain_max_db = 20.0,         // estimate
    .blur_h = 0.25,              // estimate: 570 TV lines
    .blur_v = 0.2,               // estimate: two lines of the chip make one of a field
    .saturation = 6.0,           // computed: full well 60000 e-, estimate, over 10000 e- at white
    .noise = NoiseMode::Photon,  // EMVA 1288
    .electrons_at_white =
        10000.0,             // computed: 2 lx, efficiency 0.25, pixel 11.6 x 13.5 um, two fields
    .read_electrons = 30.0,  // estimate: gives the 50 dB that data sheets quote
    .excess_noise = 1.0,     // no multiplication in the chip
    .prnu_percent = 0.5,     // estimate
    .white_clip = 1.1,       // estimate: 110 IRE
    .gamma = 2.222,          // v = S^0.45, the television standards' correction
};

constexpr Preset table[] = {
    {"ideal", "no fault: finds any exposure, adds no noise, loses no detail", CctvCamera{}},
    {"report-1990", "the 1990 report's Figure 5: noise of 10 % of each point's intensity",
     report_1990},
    {"sit-monochrome", "silicon intensifier target tube, as on the shuttle in 1992",
     sit_monochrome},
    {"sit-colour-wheel", "the same tube behind a lens with a colour wheel", sit_colour_wheel},
    {"ccd-colour", "CCD colour camera of the mid-1990s", ccd_colour},
};

}  // namespace

std::span<const Preset> presets() { return table; }

const Preset* find_preset(std::string_view name) {
  for (const Preset& preset : table) {
    if (preset.name == name) return &preset;
  }
  return nullptr;
}

}  // namespace earthshine::degrade
