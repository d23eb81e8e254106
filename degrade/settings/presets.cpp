// SPDX-License-Identifier: Apache-2.0
#include "degrade/settings/presets.h"

#include <algorithm>

namespace earthshine::degrade {
namespace {

// Builds a preset: value and source in one call, so that neither is missing.
class Writer {
 public:
  Writer(std::string_view name, std::string_view about) {
    preset_.name = name;
    preset_.about = about;
  }
  // Starts from another camera; settings that are not set again keep their source.
  Writer(std::string_view name, std::string_view about, Preset other) : preset_(std::move(other)) {
    preset_.name = name;
    preset_.about = about;
  }

  template <class T>
  Writer& set(T CctvCamera::*field, T value, std::string_view source) {
    preset_.camera.*field = value;
    visit_camera_fields(preset_.camera, [&](const char* key, const auto& f, auto&&...) {
      if (static_cast<const void*>(&f) == &(preset_.camera.*field)) {
        note(preset_.sources, key, source);
      }
    });
    return *this;
  }
  template <class T>
  Writer& show(T Monitor::*field, T value, std::string_view source) {
    preset_.monitor.*field = value;
    visit_monitor_fields(preset_.monitor, [&](const char* key, const auto& f, auto&&...) {
      if (static_cast<const void*>(&f) == &(preset_.monitor.*field)) {
        note(preset_.monitor_sources, key, source);
      }
    });
    return *this;
  }
  // Gives this source to all settings in use that have none; they keep their defaults.
  Writer& rest(std::string_view source) {
    visit_camera_fields(preset_.camera, [&](const char* key, const auto&, auto&&...) {
      if (!has(preset_.sources, key)) note(preset_.sources, key, source);
    });
    return *this;
  }

  // Sources in the order of the fields, without settings that have no effect in this camera.
  [[nodiscard]] Preset done() const {
    Preset result = preset_;
    result.sources.clear();
    result.monitor_sources.clear();
    visit_camera_fields(preset_.camera, [&](const char* key, const auto&, auto&&...) {
      if (is_used(preset_.camera, key)) take(preset_.sources, key, result.sources);
    });
    visit_monitor_fields(preset_.monitor, [&](const char* key, const auto&, auto&&...) {
      if (is_used(preset_.monitor, key)) take(preset_.monitor_sources, key, result.monitor_sources);
    });
    return result;
  }

 private:
  using Sources = std::vector<SettingSource>;

  static bool has(const Sources& sources, std::string_view key) {
    return std::any_of(sources.begin(), sources.end(), [&](const auto& s) { return s.key == key; });
  }
  static void note(Sources& sources, const char* key, std::string_view source) {
    std::erase_if(sources, [&](const SettingSource& s) { return s.key == key; });
    sources.push_back({key, std::string(source)});
  }
  static void take(const Sources& from, std::string_view key, Sources& to) {
    for (const SettingSource& s : from) {
      if (s.key == key) to.push_back(s);
    }
  }

  Preset preset_;
};

// A black-and-white 525-line monitor in a dim flight deck.
Writer with_monitor(Writer writer) {
  return writer.show(&Monitor::rows, 300, "[1990] resolution of the monitor, 300 x 400")
      .show(&Monitor::columns, 400, "[1990] resolution of the monitor, 300 x 400")
      .show(&Monitor::pixels_per_resel, 3, "computed: the spot's shape shows on 3 x 3 pixels")
      .show(&Monitor::spread, Spread::Gaussian, "[1990] Gaussian, one of its three")
      .show(&Monitor::spread_width, 1.0, "estimate: as wide as a picture element")
      .show(&Monitor::gamma, 2.2, "estimate: the television standards' display")
      .show(&Monitor::white_luminance, 100.0, "estimate: usual for cathode-ray monitors")
      .show(&Monitor::black_luminance, 1.0, "estimate: contrast 100 of a cathode-ray tube")
      .show(&Monitor::room_illuminance, 50.0, "estimate: dim cabin")
      .show(&Monitor::reflectance, 0.05, "estimate: dark filter glass");
}

Preset ideal() {
  return with_monitor(
             Writer("ideal", "no fault: finds any exposure, adds no noise, loses no detail"))
      .rest("none: a camera without faults, by definition")
      .done();
}

Preset report_1990() {
  return with_monitor(Writer("report-1990",
                             "the 1990 report's Figure 5: noise of 10 % of each point's intensity"))
      .set(&CctvCamera::iris, IrisMode::Peak,
           "estimate: the report says that the iris closes for bright objects")
      .set(&CctvCamera::noise, NoiseMode::Report,
           "[1990] a percentage of the intensity of each point")
      .set(&CctvCamera::snr_db, 20.0, "[1990] +-10 %, read as the standard deviation")
      .set(&CctvCamera::white_clip, 0.0, "none: not in the report; the monitor clamps at its white")
      .set(&CctvCamera::gamma, 2.2, "estimate: matched to the monitor, so that light stays linear")
      .rest("none: not in the report")
      .show(&Monitor::white_luminance, 100.0, "estimate: a scale only, the report shows prints")
      .show(&Monitor::black_luminance, 0.0, "none: not in the report")
      .show(&Monitor::room_illuminance, 0.0, "none: not in the report")
      .show(&Monitor::reflectance, 0.0, "none: not in the report")
      .done();
}

Writer sit() {
  using C = CctvCamera;
  return with_monitor(
             Writer("sit-monochrome", "silicon intensifier target tube, as on the shuttle in 1992"))
      .set(&C::colour, false, "[shutref] a monochrome system; colour by another lens")
      .set(&C::transmittance, 0.8, "estimate: zoom lens")
      .set(&C::magnification, 0.0, "none: below 0.02 at the distances of the bay")
      .set(&C::fall_off, 0.0, "none: not every picture states its field of view")
      .set(&C::lens_blur, 0.0, "none: blur_h and blur_v stand for lens and tube")
      .set(&C::glare, 0.02, "estimate: veiling glare of a zoom lens")
      .set(&C::iris, IrisMode::Normal, "[SCOM] one of peak, normal and average")
      .set(&C::f_number_min, 1.4, "estimate: zoom lens")
      .set(&C::f_number_max, 1000.0, "estimate: f/22 and a density spot in the iris")
      .set(&C::iris_target, 0.0, "estimate: half of white in the normal mode")
      .set(&C::iris_centre, 0.5, "estimate: meters weigh the centre more")
      .set(&C::white_lux, 0.02, "estimate: faceplate illuminance of full output, SIT tubes")
      .set(&C::gain_max_db, 12.0, "estimate: gain control of target and amplifier")
      .set(&C::iris_rate, 0.1, "estimate: motor drive, within 5 % after a second")
      .set(&C::iris_slew, 0.0, "none: no figure found")
      .set(&C::shading_percent, 20.0, "estimate: beam landing of 25 mm tubes")
      .set(&C::lag, 0.42, "estimate: 7 % left after three fields, usual for SIT tubes")
      .set(&C::smear_db, 0.0, "none: a tube is read by a beam")
      .set(&C::saturation, 4.0, "estimate: target storage above white")
      .set(&C::bloom, 1.0, "estimate: all charge stays on the target")
      .set(
          &C::bloom_radius, 15.0,
          "computed: halo of a tenth of the height, an estimate, around 3 x 3 resels of 1000 white")
      .set(&C::blur_h, 0.35, "computed: 35 % response at 400 TV lines, an estimate for 25 mm tubes")
      .set(&C::blur_v, 0.35, "computed: as blur_h, the beam is round")
      .set(&C::noise, NoiseMode::Photon,
           "computed: 28 dB at 0.02 lx; [GCTA] has above 32 dB at full light")
      .set(&C::electrons_at_white, 640.0,
           "computed: 0.02 lx, 150 uA/lm, 1/30 s, resel of 12.8 x 9.6 mm")
      .set(&C::read_electrons, 2.3,
           "computed: 2 nA rms at 4 MHz against 553 nA, seen before target gain")
      .set(&C::excess_noise, 1.0, "estimate: target gain 1500 adds little")
      .set(&C::prnu_percent, 1.0, "estimate: fixed pattern of the diode target")
      .set(&C::dark_electrons, 0.0, "none: the photocathode sends far below one in a frame")
      .set(&C::dsnu_percent, 0.2, "estimate: uneven dark current of the diode target")
      .set(&C::bandwidth_mhz, 4.2, "estimate: broadcast luminance; [GCTA] has at most 5 MHz")
      .set(&C::aperture_correction, 0.0, "none: no figure found")
      .set(&C::black_clamp, true, "estimate: RS-170 equipment clamps at black")
      .set(&C::white_clip, 1.1, "estimate: RS-170 equipment clips near 110 IRE")
      .set(&C::interlace, true, "[GCTA] 525 lines, 30 frames a second: two fields, by the standard")
      .set(&C::gamma, 2.2, "estimate: corrected for the monitor; the tube is linear [IUCr] [GCTA]")
      .set(&C::bits, 0, "none: analogue");
}

Preset sit_colour_wheel() {
  using C = CctvCamera;
  return Writer("sit-colour-wheel", "the same tube behind a lens with a colour wheel", sit().done())
      .set(&C::colour, true, "[shutref] colour by the lens in front of the same tube")
      .set(&C::transmittance, 0.16, "estimate: the wheel's filters pass about a fifth")
      .set(&C::glare, 0.03, "estimate: three more surfaces")
      .set(&C::blur_h, 0.6, "[GCTA] above 200 TV lines in colour against 600 of the tube")
      .set(&C::electrons_at_white, 213.0, "computed: a third of the time for each colour")
      .done();
}

Preset ccd_colour() {
  using C = CctvCamera;
  return with_monitor(Writer("ccd-colour", "CCD colour camera of the mid-1990s"))
      .set(&C::colour, true, "computed: by definition of this preset")
      .set(&C::transmittance, 0.8, "estimate: zoom lens")
      .set(&C::magnification, 0.0, "none: below 0.02 at the distances of the bay")
      .set(&C::fall_off, 0.0, "none: not every picture states its field of view")
      .set(&C::lens_blur, 0.0, "none: blur_h and blur_v stand for lens and chip")
      .set(&C::glare, 0.01, "estimate: zoom lens of the years")
      .set(&C::iris, IrisMode::Normal, "[SCOM] one of peak, normal and average")
      .set(&C::f_number_min, 1.4, "estimate: zoom lens")
      .set(&C::f_number_max, 360.0, "estimate: f/22, and an electronic shutter to 1/8000 s")
      .set(&C::iris_target, 0.0, "estimate: half of white in the normal mode")
      .set(&C::iris_centre, 0.5, "estimate: meters weigh the centre more")
      .set(&C::white_lux, 2.0, "estimate: 2/3 inch interline CCD")
      .set(&C::gain_max_db, 20.0, "estimate: automatic gain of the years")
      .set(&C::iris_rate, 0.1, "estimate: motor drive, within 5 % after a second")
      .set(&C::iris_slew, 0.0, "none: no figure found")
      .set(&C::shading_percent, 5.0, "estimate: microlenses of the years")
      .set(&C::lag, 0.0, "none: each field empties the photodiodes")
      .set(&C::smear_db, 90.0, "estimate: usual for interline chips")
      .set(&C::bloom, 0.0, "none: the chip drains what a pixel cannot hold")
      .set(&C::saturation, 6.0, "computed: full well 60000 e-, an estimate, over 10000 e- at white")
      .set(&C::blur_h, 0.25, "estimate: 570 TV lines")
      .set(&C::blur_v, 0.2, "estimate: two lines of the chip make one of a field")
      .set(&C::noise, NoiseMode::Photon, "computed: shot and read noise as EMVA 1288 has them")
      .set(&C::electrons_at_white, 10000.0,
           "computed: 2 lx, efficiency 0.25, pixel 11.6 x 13.5 um, two fields")
      .set(&C::read_electrons, 30.0, "estimate: gives the 50 dB that data sheets quote")
      .set(&C::excess_noise, 1.0, "computed: no multiplication in the chip")
      .set(&C::prnu_percent, 0.5, "estimate: usual for CCDs")
      .set(&C::dark_electrons, 100.0, "estimate: a warm chip of the years")
      .set(&C::dsnu_percent, 0.1, "estimate: a tenth of the dark counts")
      .set(&C::bandwidth_mhz, 0.0, "none: 570 TV lines are in blur_h")
      .set(&C::aperture_correction, 0.0, "none: no figure found")
      .set(&C::black_clamp, true, "estimate: RS-170 equipment clamps at black")
      .set(&C::white_clip, 1.1, "estimate: RS-170 equipment clips near 110 IRE")
      .set(&C::interlace, true, "computed: 525 lines in two fields, by the standard")
      .set(&C::gamma, 2.222, "computed: v = S^0.45, the television standards' correction")
      .set(&C::bits, 0, "none: analogue output")
      .done();
}

const std::vector<Preset>& table() {
  static const std::vector<Preset> rows = {ideal(), report_1990(), sit().done(), sit_colour_wheel(),
                                           ccd_colour()};
  return rows;
}

}  // namespace

std::span<const Preset> presets() { return table(); }

const Preset* find_preset(std::string_view name) {
  for (const Preset& preset : presets()) {
    if (preset.name == name) return &preset;
  }
  return nullptr;
}

}  // namespace earthshine::degrade
