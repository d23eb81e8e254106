// SPDX-License-Identifier: Apache-2.0
// The table of stages. A new stage needs its setting in stage/camera.h and a row here with its law:
// a point map, a filter, or a function of the picture in parts/ with its twin in carry.cpp.
#include <cmath>

#include "base/error.h"
#include "degrade/carry.h"
#include "degrade/chain.h"
#include "degrade/parts/electronics.h"
#include "degrade/parts/optics.h"
#include "degrade/parts/sensor.h"

namespace earthshine::degrade {
namespace {

// Fields are numbered throughout the sequence, so that each has different noise.
NoiseKey noise_key(const StageContext& at) {
  const Options& options = at.setup.options;
  return {options.seed, 2 * options.frame + at.field, options.view};
}

double from_db(double db) { return std::pow(10.0, -db / 20.0); }

// Adds to the mean over the fields.
void add_levels(Levels& sum, const Levels& field, std::uint64_t fields) {
  sum.saturated_share += field.saturated_share / static_cast<double>(fields);
  sum.crushed_share += field.crushed_share / static_cast<double>(fields);
}

Picture fall_off(Picture&& p, const StageContext& at) {
  const double fov = at.setup.options.fov_deg;
  if (!(fov > 0.0 && fov < 180.0)) {
    throw base::Error(
        base::Blame::Input, "fall_off", "needs the picture's field of view, which is not known",
        "an angle above 0 and below 180 degrees", "Give --fov DEGREES, or leave fall_off out");
  }
  return fall_off_from_axis(std::move(p), at.setup.camera.fall_off, fov);
}

Picture iris(Picture&& p, const StageContext& at) {
  if (at.field > 0) return p;
  const CctvCamera& camera = at.setup.camera;
  const bool slow = camera.iris_rate != 1.0 || camera.iris_slew > 0.0;
  at.report.exposure = expose(camera, metered_luminance(p, camera),
                              slow ? at.memory.f_number : std::optional<double>());
  at.memory.f_number = at.report.exposure.f_number;
  return p;
}

Picture signal_noise(Picture&& p, const StageContext& at) {
  const NoiseLaw& law = at.report.noise;
  NoiseKey key = noise_key(at);
  const double lag = lag_of(at);
  if (lag > 0.0 && at.memory.charge.planes.empty()) {
    // The field before the first one.
    at.memory.charge = settled_charge(p, law, {key.seed, key.frame - 1, key.view}, lag);
  }
  return add_signal_noise(std::move(p), law, key);
}

Picture lag(Picture&& p, const StageContext& at) {
  Picture& charge = at.memory.charge;
  if (charge.planes.empty()) charge = p;  // no noise, and the scene is still
  if (charge.columns != p.columns || charge.rows != p.rows ||
      charge.planes.size() != p.planes.size()) {
    const auto shape = [](const Picture& of) {
      return std::to_string(of.columns) + " x " + std::to_string(of.rows) + " resels";
    };
    throw base::Error(base::Blame::Input, "frame " + std::to_string(at.setup.options.frame),
                      "has " + shape(p) + ", the one before had " + shape(charge),
                      "all frames of a sequence have the same shape and colours");
  }
  p = after_lag(std::move(p), charge, lag_of(at));
  charge = p;
  return p;
}

Picture levels(Picture&& p, const StageContext& at) {
  const double black_noise = at.report.exposure.gain * std::sqrt(at.report.noise.at_black());
  add_levels(at.report.levels, measure_levels(p, black_noise), at.fields);
  return p;
}

Picture saturate(Picture&& p, const StageContext& at) {
  const double most = at.setup.camera.saturation;
  // Share of the signal before bloom, as all shares are.
  const double left = 1.0 - (1.0 - at.setup.camera.bloom) * at.report.excess_share;
  at.report.lost_share += left * share_above(p, most) / static_cast<double>(at.fields);
  return limit_above(std::move(p), most);
}

Picture bloom(Picture&& p, const StageContext& at) {
  const CctvCamera& camera = at.setup.camera;
  const double share = share_above(p, camera.saturation);
  if (share == 0.0) return p;
  at.report.excess_share += share / static_cast<double>(at.fields);
  at.report.lost_share += (1.0 - camera.bloom) * share / static_cast<double>(at.fields);
  return bloom_over(std::move(p), camera.saturation, camera.bloom, camera.bloom_radius);
}

PlaneMap blur(const Picture& p, double along, double across) {
  return {gaussian_blur(p.columns, along), gaussian_blur(p.rows, across)};
}

bool gain_runs(const Setup& setup, const Report* found) {
  if (found != nullptr) return found->exposure.gain != 1.0;
  return setup.camera.iris == IrisMode::Fixed ? setup.camera.gain_db > 0.0
                                              : setup.camera.gain_max_db > 0.0;
}

bool always(const Setup&, const Report*) { return true; }

template <class... Names>
constexpr std::array<std::string_view, 3> decided_by(Names... names) {
  return {names...};
}

constexpr Stage table[] = {
    {"sensor-grid", Part::Lens, Kind::Plain, decided_by(), "cd/m^2", "cd/m^2",
     "area average onto 300 rows", always,
     [](const Picture& p, const StageContext& at) {
       const Grid grid = picture_grid(p.columns, p.rows, at.setup.monitor);
       at.report.sensor = grid;
       return PlaneMap{area_average(p.columns, grid.columns), area_average(p.rows, grid.rows)};
     }},
    {"iris", Part::Lens, Kind::Plain, decided_by(), "cd/m^2", "cd/m^2",
     "finds N and the gain; the picture passes", always, iris},
    {"lens", Part::Lens, Kind::Plain, decided_by(), "cd/m^2", "lx",
     "E = pi tau L / (4 N^2 (1 + m)^2)", always,
     [](Picture&& p, const StageContext& at) {
       return through_lens(std::move(p), at.setup.camera, at.report.exposure.f_number);
     }},
    {"fall-off", Part::Lens, Kind::Uneven, decided_by("fall_off"), "lx", "lx",
     "E = E cos(theta)^fall_off",
     [](const Setup& s, const Report*) { return s.camera.fall_off > 0.0; }, fall_off},
    {"glare", Part::Lens, Kind::Spatial, decided_by("glare"), "lx", "lx",
     "E = (1 - g) E + g mean(E)",
     [](const Setup& s, const Report*) { return s.camera.glare > 0.0; },
     [](Picture&& p, const StageContext& at) {
       return add_glare(std::move(p), at.setup.camera.glare);
     }},
    {"lens-spread", Part::Lens, Kind::Spatial, decided_by("lens_blur"), "lx", "lx",
     "discrete Gaussian, in light",
     [](const Setup& s, const Report*) { return s.camera.lens_blur > 0.0; },
     [](const Picture& p, const StageContext& at) {
       return blur(p, at.setup.camera.lens_blur, at.setup.camera.lens_blur);
     }},
    {"conversion", Part::Lens, Kind::Plain, decided_by(), "lx", "signal", "S = E / E_white", always,
     [](Picture&& p, const StageContext& at) {
       return to_signal(std::move(p), at.setup.camera.white_lux);
     }},
    {"shading", Part::Lens, Kind::Uneven, decided_by("shading_percent"), "signal", "signal",
     "S = S (1 - d r^2), r = 1 in the corners",
     [](const Setup& s, const Report*) { return s.camera.shading_percent > 0.0; },
     [](Picture&& p, const StageContext& at) {
       return shade(std::move(p), at.setup.camera.shading_percent / 100.0);
     }},
    {"signal-noise", Part::Sensor, Kind::Noise, decided_by("noise"), "signal", "signal",
     "variance b S + c S^2, and dark counts",
     [](const Setup& s, const Report*) { return noise_law(s.camera).with_light(); }, signal_noise,
     carry_signal_noise},
    {"lag", Part::Sensor, Kind::Plain, decided_by("lag"), "signal", "signal",
     "y = (1 - lag) S + lag y of the field before",
     [](const Setup& s, const Report*) { return s.camera.lag > 0.0; }, lag, carry_lag},
    {"blur", Part::Sensor, Kind::Spatial, decided_by("blur_h", "blur_v"), "signal", "signal",
     "discrete Gaussian, sigma_h along and sigma_v across lines",
     [](const Setup& s, const Report*) { return s.camera.blur_h > 0.0 || s.camera.blur_v > 0.0; },
     [](const Picture& p, const StageContext& at) {
       return blur(p, at.setup.camera.blur_h, at.setup.camera.blur_v);
     }},
    {"smear", Part::Sensor, Kind::Uneven, decided_by("smear_db"), "signal", "signal",
     "S = S + 10 smear mean(column)",
     [](const Setup& s, const Report*) { return s.camera.smear_db > 0.0; },
     [](Picture&& p, const StageContext& at) {
       return smear_columns(std::move(p), from_db(at.setup.camera.smear_db));
     }},
    {"bloom", Part::Sensor, Kind::Spatial | Kind::Limit, decided_by("saturation", "bloom"),
     "signal", "signal", "S = min(S, S_most) + bloom * Gaussian of what lay above",
     [](const Setup& s, const Report*) {
       return s.camera.saturation > 0.0 && s.camera.bloom > 0.0;
     },
     bloom, carry_bloom},
    {"saturation", Part::Sensor, Kind::Limit, decided_by("saturation"), "signal", "signal",
     "S = min(S, S_most)", [](const Setup& s, const Report*) { return s.camera.saturation > 0.0; },
     saturate, carry_saturation},
    {"read-noise", Part::Sensor, Kind::Noise, decided_by("noise"), "signal", "signal", "variance a",
     [](const Setup& s, const Report*) { return noise_law(s.camera).with_amplifier(); },
     [](Picture&& p, const StageContext& at) {
       return add_read_noise(std::move(p), at.report.noise, noise_key(at));
     },
     carry_read_noise},
    {"bandwidth", Part::Sensor, Kind::Spatial, decided_by("bandwidth_mhz", "aperture_correction"),
     "signal", "signal", "along the line: low pass of -3 dB at B, then aperture correction",
     [](const Setup& s, const Report*) {
       return s.camera.bandwidth_mhz > 0.0 || s.camera.aperture_correction > 0.0;
     },
     [](const Picture& p, const StageContext& at) {
       const CctvCamera& camera = at.setup.camera;
       return PlaneMap{line_filter(p.columns, camera.bandwidth_mhz, camera.aperture_correction,
                                   at.setup.monitor.columns),
                       gaussian_blur(p.rows, 0.0)};
     }},
    {"black-clamp", Part::Sensor, Kind::Limit, decided_by("black_clamp"), "signal", "signal",
     "S = max(S, 0)", [](const Setup& s, const Report*) { return s.camera.black_clamp; },
     [](PointMap& map, const StageContext&) { map.limit_below(0.0); }},
    {"gain", Part::Sensor, Kind::Plain, decided_by("iris", "gain_db", "gain_max_db"), "signal",
     "signal", "S = G S", gain_runs,
     [](PointMap& map, const StageContext& at) { map.amplify(at.report.exposure.gain); }},
    {"levels", Part::Sensor, Kind::Meter, decided_by(), "signal", "signal",
     "counts white and black resels; the picture passes", always, levels},
    {"white-clip", Part::Sensor, Kind::Limit, decided_by("white_clip"), "signal", "signal",
     "S = min(S, S_clip)", [](const Setup& s, const Report*) { return s.camera.white_clip > 0.0; },
     [](PointMap& map, const StageContext& at) { map.limit_above(at.setup.camera.white_clip); }},
    {"camera-gamma", Part::Sensor, Kind::Coding, decided_by("gamma"), "signal", "line signal",
     "v = S^(1/gamma)", [](const Setup& s, const Report*) { return s.camera.gamma != 1.0; },
     [](PointMap& map, const StageContext& at) { map.power(1.0 / at.setup.camera.gamma); }},
    {"quantisation", Part::Sensor, Kind::Coding, decided_by("bits"), "line signal", "line signal",
     "nearest of 2^bits levels", [](const Setup& s, const Report*) { return s.camera.bits > 0; },
     [](PointMap& map, const StageContext& at) { map.quantise(at.setup.camera.bits); }},
    {"interlace", Part::Sensor, Kind::Plain, decided_by("interlace"), "line signal", "line signal",
     "even lines from the first field, odd ones from the second",
     [](const Setup& s, const Report*) { return s.camera.interlace; }, nullptr, carry_interlace,
     weave},
    {"screen", Part::Monitor, Kind::Plain, decided_by(), "line signal", "cd/m^2",
     "I = I_b + (I_w - I_b) v^gamma", always,
     [](PointMap& map, const StageContext& at) {
       const Monitor& monitor = at.setup.monitor;
       at.report.white = monitor.white_luminance;
       map.screen(monitor.black_luminance, monitor.white_luminance, monitor.gamma);
     }},
    {"spread", Part::Monitor, Kind::Plain, decided_by("monitor.spread", "monitor.pixels_per_resel"),
     "cd/m^2", "cd/m^2", "point spread, on the finer grid of pixels",
     [](const Setup& s, const Report*) {
       return s.monitor.spread != Spread::None || s.monitor.pixels_per_resel > 1;
     },
     [](Picture&& p, const StageContext& at) {
       return spread_on_screen(p, at.setup.monitor, at.report.clipped_negative_light);
     },
     carry_spread},
    {"room-light", Part::Monitor, Kind::Plain,
     decided_by("monitor.room_illuminance", "monitor.reflectance"), "cd/m^2", "cd/m^2",
     "I = I + reflectance E_room / pi",
     [](const Setup& s, const Report*) { return room_luminance(s.monitor) > 0.0; },
     [](Picture&& p, const StageContext& at) {
       at.report.white += room_luminance(at.setup.monitor);
       return add_light(std::move(p), room_luminance(at.setup.monitor));
     },
     carry_room_light},
};

}  // namespace

std::span<const Stage> stages() { return table; }

double lag_of(const StageContext& at) {
  const double lag = at.setup.camera.lag;
  return at.fields == 2 ? lag : lag * lag;
}

}  // namespace earthshine::degrade
