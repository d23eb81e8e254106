// SPDX-License-Identifier: Apache-2.0
// Changes of sight_changes.h for the CCTV's camera and monitor.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "degrade/parts/monitor.h"
#include "studies/why/sight_changes.h"

namespace earthshine::studies {
namespace {

Change without_stages(Cause cause, std::string by, std::string text,
                      std::vector<std::string> stages) {
  Change change;
  change.cause = cause;
  change.by = std::move(by);
  change.text = std::move(text);
  change.apply = [stages = std::move(stages)](Scenario& scenario) {
    std::vector<std::string>& off = scenario.cctv->options.off;
    off.insert(off.end(), stages.begin(), stages.end());
  };
  return change;
}

std::optional<Change> without_saturation(const WhyNotInputs& in, std::size_t index) {
  const Sight& sight = in.sight.targets[index];
  if (!in.sight.exposure || !sight.luminance) return std::nullopt;
  const degrade::Exposure exposure = *in.sight.exposure;
  const double brighter = std::max(*sight.luminance, sight.surround.value_or(0.0));
  const double level = brighter * signal_per_luminance(in.cctv->camera, exposure);
  if (!(sight.saturated > 0.01) && level < 0.9) return std::nullopt;
  const double stops = std::max(2.0, std::log2(2.0 * level));
  Change change;
  change.cause = Cause::Saturated;
  change.share = sight.saturated;
  change.text = sight.saturated > 0.01
                    ? fmt::format("saturated ({:.0f} % of it)", 100.0 * *sight.saturated)
                    : "saturated round it";
  change.apply = [exposure, stops](Scenario& scenario) {
    degrade::Exposure less = exposure;
    less.f_number *= std::exp2(0.5 * stops);
    hold_exposure(scenario, less);
  };
  return change;
}

}  // namespace

std::vector<Change> with_better_cctv(const WhyNotInputs& in, std::size_t index) {
  std::vector<Change> changes;
  if (!in.cctv) return changes;
  const degrade::CctvCamera& camera = in.cctv->camera;
  const degrade::Monitor& monitor = in.cctv->monitor;
  if (auto change = without_saturation(in, index)) changes.push_back(std::move(*change));
  const TargetView& view = in.plan.targets[index].view;
  const double motion_lines =
      std::hypot(view.motion_px_s[0], view.motion_px_s[1]) * monitor.rows / in.plan.map.rows;
  if (camera.lag > 0.0 && motion_lines > 0.0) {
    changes.push_back(without_stages(
        Cause::Lag, {},
        fmt::format("smeared by the tube's lag (it moves {:.3g} TV lines a second)", motion_lines),
        {"lag"}));
  }
  const auto blur = [&](bool there, const char* by, const char* text, const char* stage) {
    if (there) changes.push_back(without_stages(Cause::Blur, by, text, {stage}));
  };
  blur(camera.lens_blur > 0.0, "lens", "blurred by the lens", "lens-spread");
  blur(camera.blur_h > 0.0 || camera.blur_v > 0.0, "tube", "blurred by the sensor", "blur");
  blur(camera.bandwidth_mhz > 0.0, "line", "blurred by the video line", "bandwidth");
  blur(monitor.spread != degrade::Spread::None, "monitor", "blurred by the monitor", "spread");
  if (camera.noise != degrade::NoiseMode::None) {
    changes.push_back(
        without_stages(Cause::Noise, {}, "lost in noise", {"signal-noise", "read-noise"}));
  }
  if (const double room = degrade::room_luminance(monitor); room > 0.0) {
    changes.push_back(without_stages(
        Cause::RoomLight, {},
        fmt::format("washed out by the room's light on the monitor ({:.2g} cd/m^2)", room),
        {"room-light"}));
  }
  return changes;
}

}  // namespace earthshine::studies
