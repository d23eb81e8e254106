// SPDX-License-Identifier: Apache-2.0
#include "studies/sight/cctv_signal.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "degrade/carry.h"
#include "degrade/moments/point_moments.h"
#include "degrade/parts/electronics.h"

namespace earthshine::studies {
namespace {

using degrade::AxisMap;
using degrade::Picture;
using degrade::Plane;

// Smaller taps add less than 1e-6 to any variance and cost most of the time.
constexpr double least_tap = 1e-5;

AxisMap without_far_taps(const AxisMap& map) { return degrade::without_taps_below(map, least_tap); }

// `first`, then `second`.
AxisMap chained(const AxisMap& first, const AxisMap& second) {
  AxisMap both;
  both.in = first.in;
  std::vector<double> sum(static_cast<std::size_t>(first.in), 0.0);
  std::vector<std::size_t> touched;
  for (std::size_t i = 0; i + 1 < second.start.size(); ++i) {
    touched.clear();
    for (std::size_t k = second.start[i]; k < second.start[i + 1]; ++k) {
      const std::size_t j = second.source[k];
      for (std::size_t m = first.start[j]; m < first.start[j + 1]; ++m) {
        touched.push_back(first.source[m]);
        sum[first.source[m]] += second.weight[k] * first.weight[m];
      }
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const std::size_t source : touched) {
      both.source.push_back(source);
      both.weight.push_back(sum[source]);
      sum[source] = 0.0;
    }
    both.start.push_back(both.source.size());
  }
  return both;
}

AxisMap squared(AxisMap map) {
  for (double& weight : map.weight) weight *= weight;
  return map;
}

AxisMap nothing(int size) { return degrade::gaussian_blur(size, 0.0); }

// Mean over each resel's pixels of the light that the phosphor spreads.
AxisMap mean_spread(const degrade::Monitor& monitor, int resels) {
  const int pixels = monitor.pixels_per_resel;
  return without_far_taps(
      chained(degrade::spread_map(monitor.spread, monitor.spread_width, resels, pixels),
              degrade::area_average(resels * pixels, resels)));
}

// Computes the remaining noise of the light from the filters.
void carry_light_noise(CctvSignal& line, SignalPlane& plane, const Plane& exposed,
                       const AxisMap& along, const AxisMap& across, double lag_factor, bool on) {
  const degrade::NoiseLaw& law = line.report.noise;
  const auto filtered = [&](const Plane& variance) {
    return apply(Picture{line.columns, line.rows, {variance}}, along, across).planes.front();
  };
  plane.grain.assign(exposed.size(), 0.0F);
  if (on) {
    const double c_grain = law.c_is_fixed_pattern ? 0.0 : law.c;
    std::transform(exposed.begin(), exposed.end(), plane.grain.begin(), [&](float value) {
      const double s = std::max(static_cast<double>(value), 0.0);
      return static_cast<float>(lag_factor * (law.dark + (law.b + c_grain * s) * s));
    });
  }
  plane.grain_at_line = filtered(plane.grain);
  if (!on || !law.c_is_fixed_pattern || !(law.c > 0.0)) return;
  plane.pattern.resize(exposed.size());
  std::transform(exposed.begin(), exposed.end(), plane.pattern.begin(),
                 [&](float value) { return static_cast<float>(law.c) * value * value; });
  plane.pattern_at_line = filtered(plane.pattern);
}

// A saturated target blocks fluctuations. full: the signal before saturation. Near `most` the share
// is the probability to be below it (Bussgang's gain of a clamp).
void saturate_noise(SignalPlane& plane, const Plane& full, double most, double noise_factor) {
  plane.passed.resize(full.size());
  for (std::size_t i = 0; i < full.size(); ++i) {
    const double variance =
        noise_factor *
        static_cast<double>(plane.grain[i] + (plane.pattern.empty() ? 0.0F : plane.pattern[i]));
    const double room = most - static_cast<double>(full[i]);
    double share = room > 0.0 ? 1.0 : 0.0;
    if (room * room < 64.0 * variance) {
      share = degrade::normal_probability(room / std::sqrt(variance));
    }
    plane.passed[i] = static_cast<float>(share);
    const auto power = static_cast<float>(share * share);
    plane.grain_at_line[i] *= power;
    if (!plane.pattern.empty()) plane.pattern_at_line[i] *= power;
  }
}

double sum_of_squares(const AxisMap& map) {  // of the taps in the middle, away from the border
  const std::size_t middle = (map.start.size() - 1) / 2;
  double sum = 0.0;
  for (std::size_t k = map.start[middle]; k < map.start[middle + 1]; ++k) {
    sum += map.weight[k] * map.weight[k];
  }
  return sum;
}

double mean_screen_luminance(const CctvSignal& line) {
  double sum = 0.0, count = 0.0;
  const std::size_t step = std::max<std::size_t>(1, line.resel_count() / 4096);
  for (std::size_t p = 0; p < line.planes.size(); ++p) {
    for (std::size_t i = step / 2; i < line.resel_count(); i += step) {
      sum += line.luminance_share[p] * line.screen(static_cast<double>(line.planes[p].signal[i]));
      if (p == 0) count += 1.0;
    }
  }
  return sum / count + line.room_luminance;
}

}  // namespace

ShownRange shown_range(const degrade::CctvCamera& camera, const degrade::Report& report,
                       double mean_luminance) {
  // Signal per cd/m^2 before gain; glare removes a share from each point and distributes it evenly.
  const double per_luminance =
      degrade::lens_transfer(camera, report.exposure.f_number) / camera.white_lux;
  const double veil = camera.glare * mean_luminance;
  const auto luminance_of_signal = [&](double signal) {
    return (signal / per_luminance - veil) / (1.0 - camera.glare);
  };
  double white = degrade::white_signal / report.exposure.gain;
  if (camera.saturation > 0.0) white = std::min(white, camera.saturation);
  return {luminance_of_signal(std::sqrt(report.noise.at_black())), luminance_of_signal(white)};
}

namespace {

// Identifies a stage by its law.
bool is_on(decltype(degrade::Stage::carry) carry, const degrade::Setup& setup,
           const degrade::Report* found) {
  const auto stages = degrade::stages();
  const auto stage = std::find_if(stages.begin(), stages.end(),
                                  [&](const degrade::Stage& s) { return s.carry == carry; });
  return degrade::runs(*stage, setup, found);
}

}  // namespace

degrade::PlaneMap screen_spread(const degrade::Setup& setup, int columns, int rows) {
  if (!is_on(degrade::carry_spread, setup, nullptr)) return {nothing(columns), nothing(rows)};
  return {mean_spread(setup.monitor, columns), mean_spread(setup.monitor, rows)};
}

namespace {

// Planes of the signal where noise enters it.
struct NoiseInputs {
  Picture exposed, full;  // at the sensor; before saturation
};

// Whether the stage changes the noise-free signal of one frame up to the screen.
bool maps_noise_free(const degrade::Stage& stage) {
  return stage.merge == nullptr && !stage.is(degrade::Kind::Noise) &&
         stage.carry != degrade::carry_lag && stage.carry != degrade::carry_spread &&
         stage.carry != degrade::carry_room_light;
}

// amplified: the filter is behind the amplifier's noise.
void take_filter(CctvSignal& line, const degrade::PlaneMap& filter, bool amplified) {
  (amplified ? line.bandwidth : line.blur_along) = without_far_taps(filter.along);
  if (!amplified) line.blur_across = without_far_taps(filter.across);
}

std::vector<double> luminance_shares(std::size_t planes) {
  if (planes != 3) return {1.0};
  return {base::luminance({1.0, 0.0, 0.0}), base::luminance({0.0, 1.0, 0.0}),
          base::luminance({0.0, 0.0, 1.0})};
}

// Noise of the line from the light on `picture`, the noise-free signal, and from the amplifier.
void add_noise(CctvSignal& line, Picture picture, const NoiseInputs& inputs,
               const degrade::Setup& setup, const degrade::StageContext& at) {
  const auto runs = [&](auto* carry) { return is_on(carry, setup, &line.report); };
  const double lag = runs(degrade::carry_lag) ? degrade::lag_of(at) : 0.0;
  line.lag_per_field = runs(degrade::carry_lag) ? setup.camera.lag : 0.0;
  const AxisMap along = squared(chained(line.blur_along, line.bandwidth)),
                across = squared(line.blur_across), read = squared(line.bandwidth);
  if (runs(degrade::carry_read_noise)) {
    line.amplifier = line.report.noise.a;
    line.amplifier_pattern = line.report.noise.black_pattern;
  }
  const std::size_t columns = static_cast<std::size_t>(line.columns);
  line.amplifier_at_line.resize(columns);
  for (std::size_t x = 0; x < columns; ++x) {
    double sum = 0.0;
    for (std::size_t k = read.start[x]; k < read.start[x + 1]; ++k) sum += read.weight[k];
    line.amplifier_at_line[x] = static_cast<float>(sum);
  }
  for (std::size_t p = 0; p < picture.planes.size(); ++p) {
    SignalPlane plane;
    plane.signal = std::move(picture.planes[p]);
    carry_light_noise(line, plane, inputs.exposed.planes[p], along, across,
                      (1.0 - lag) / (1.0 + lag), runs(degrade::carry_signal_noise));
    if (runs(degrade::carry_saturation)) {
      saturate_noise(plane, inputs.full.planes[p], setup.camera.saturation,
                     sum_of_squares(line.blur_along) * sum_of_squares(line.blur_across));
    }
    line.planes.push_back(std::move(plane));
  }
}

}  // namespace

CctvSignal pass_through(const base::Image& radiance, const degrade::Setup& setup) {
  const degrade::CctvCamera& camera = setup.camera;
  CctvSignal line;
  degrade::Report& report = line.report;
  degrade::Memory memory;
  Picture picture = degrade::sensor_input(radiance, camera.colour, report.negative_pixels);
  report.noise = degrade::noise_law(camera);
  report.sensor = {picture.columns, picture.rows};
  report.exposure.f_number = camera.f_number;
  line.has_fields = degrade::has_fields(setup, report);
  const degrade::StageContext at{setup, report, memory, 0, line.has_fields ? 2U : 1U};

  const auto is_on = [&](auto* carry) { return studies::is_on(carry, setup, &report); };
  // A picture of one resel, on which only the point maps act.
  degrade::Moments maps = degrade::still({1, 1, {{0.0F}}});
  NoiseInputs inputs;
  bool at_maps = false, amplified = false, on_screen = false;
  for (const degrade::Stage& stage : degrade::stages()) {
    const bool sensor = stage.part == degrade::Part::Sensor;
    if (sensor && inputs.exposed.planes.empty()) {
      inputs.exposed = picture;
      line.blur_along = line.bandwidth = nothing(picture.columns);
      line.blur_across = nothing(picture.rows);
    }
    at_maps = at_maps || (sensor && stage.law.points != nullptr);
    amplified = amplified || stage.carry == degrade::carry_read_noise;
    if (stage.is(degrade::Kind::Meter)) {
      line.level = luminance_plane(transform(picture, maps.pending));
    }
    if (stage.part == degrade::Part::Monitor && !on_screen) {
      line.line = maps.pending;
      on_screen = true;
    }
    if (stage.carry == degrade::carry_bloom) inputs.full = picture;  // and saturation after it
    if (!degrade::runs(stage, setup, &report)) continue;
    if (!maps_noise_free(stage)) continue;
    if (sensor && stage.law.filter != nullptr) {
      take_filter(line, stage.law.filter(picture, at), amplified);
    }
    if (at_maps) {
      maps = carry(std::move(maps), stage, at);
    } else {
      picture = stage.law(std::move(picture), at);
    }
  }
  line.screen = maps.pending;
  line.columns = picture.columns;
  line.rows = picture.rows;
  degrade::PlaneMap spread = screen_spread(setup, line.columns, line.rows);
  line.spread_along = std::move(spread.along);
  line.spread_across = std::move(spread.across);
  if (is_on(degrade::carry_room_light))
    line.room_luminance = degrade::room_luminance(setup.monitor);

  line.luminance_share = luminance_shares(picture.planes.size());
  add_noise(line, std::move(picture), inputs, setup, at);
  line.screen_luminance = mean_screen_luminance(line);
  return line;
}

}  // namespace earthshine::studies
