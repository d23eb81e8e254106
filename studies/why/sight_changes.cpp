// SPDX-License-Identifier: Apache-2.0
#include "studies/why/sight_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace earthshine::studies {
namespace {

// The channels that carry light.
template <class Visit>
void for_light(base::Image& image, Visit visit) {
  for (base::Channel& channel : image.channels) {
    if (channel.name == "R" || channel.name == "G" || channel.name == "B" || channel.name == "Y") {
      visit(channel.values);
    }
  }
}

void stop(Scenario& scenario, std::initializer_list<const char*> stages) {
  for (const char* stage : stages) scenario.cctv->options.off.emplace_back(stage);
}

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

// Bright light counts as light in the signal: S per cd/m^2 where the iris stands.
double signal_per_luminance(const degrade::CctvCamera& camera, const degrade::Exposure& exposure) {
  return degrade::lens_transfer(camera, exposure.f_number) / camera.white_lux * exposure.gain;
}

}  // namespace

Scenario scenario_of(const WhyNotInputs& in, std::size_t index, const SightOptions& options) {
  Scenario scenario{{in.plan.map, in.plan.fov_deg, {in.plan.targets[index]}}, {}, in.cctv, options};
  scenario.radiance.width = in.radiance.width;
  scenario.radiance.height = in.radiance.height;
  for (const char* name : {"R", "G", "B", "Y"}) {
    if (const base::Channel* channel = in.radiance.find(name)) {
      scenario.radiance.channels.push_back(*channel);
    }
  }
  return scenario;
}

std::optional<Change> without_hiding(const WhyNotInputs& in, std::size_t index) {
  const TargetView& view = in.plan.targets[index].view;
  const auto alone = static_cast<double>(view.pixels_alone);
  // What hides a corner is no reason.
  if (view.hidden_by.empty() || static_cast<double>(view.hidden.size()) < 0.1 * alone) {
    return std::nullopt;
  }
  Change change;
  change.cause = Cause::Hidden;
  change.by = in.scene.objects[view.hidden_by.front().object].name;
  change.share = static_cast<double>(view.hidden_by.front().pixels) / alone;
  change.text = fmt::format("hidden by {} ({} of it)", change.by, percent(*change.share));
  for (std::size_t k = 1; k < std::min<std::size_t>(3, view.hidden_by.size()); ++k) {
    const double share = static_cast<double>(view.hidden_by[k].pixels) / alone;
    if (share < 0.05) break;
    change.text +=
        fmt::format(", {} ({})", in.scene.objects[view.hidden_by[k].object].name, percent(share));
  }
  change.apply = [&in, index](Scenario& scenario) {
    const SightTarget& target = in.plan.targets[index];
    for_light(scenario.radiance, [&](std::vector<float>& values) {
      double mean = 0.0;
      for (const std::uint32_t pixel : target.view.measured) {
        mean += static_cast<double>(values[pixel]);
      }
      mean /= static_cast<double>(target.view.measured.size());
      for (const std::uint32_t pixel : target.view.hidden) values[pixel] = static_cast<float>(mean);
    });
    ObjectMap map = in.plan.map;
    for (const std::uint32_t pixel : target.view.hidden) {
      map.object[pixel] = static_cast<std::int32_t>(target.view.object);
    }
    TargetView view_alone = find_target(map, target.view.object);
    view_alone.pixels_alone = target.view.pixels_alone;
    std::vector<TargetView> views;
    views.push_back(std::move(view_alone));
    scenario.plan = plan_sight(in.camera, std::move(map), std::move(views));
  };
  return change;
}

std::string darkness_of(const SourceOnTarget& source) {
  if (!source.off.empty()) return fmt::format("{} {}", source.group, source.off);
  if (!(source.facing > 0.0)) return fmt::format("it faces away from {}", source.group);
  if (source.lit >= 0.5 * source.facing) return {};
  const std::string shadow =
      source.shadow_of.empty() ? "" : fmt::format(" (shadow of {})", source.shadow_of.front());
  return fmt::format("{} {} it{}", source.group,
                     source.lit > 0.0 ? "hardly reaches" : "does not reach", shadow);
}

std::vector<Change> with_light(const WhyNotInputs& in, std::size_t index,
                               const std::vector<SourceOnTarget>& sources) {
  std::vector<Change> changes;
  for (const SourceOnTarget& source : sources) {
    const double more = source.unshadowed - source.direct;
    const bool picture = !source.off.empty() && source.when_on != nullptr;
    if (!picture && !(more > 0.0)) continue;
    std::string why = darkness_of(source);
    if (why.empty()) continue;
    Change change;
    change.cause = Cause::Unlit;
    change.by = source.group;
    change.share = 1.0 - source.lit;
    change.text = "unlit: " + why;
    if (picture) {
      change.apply = [on = source.when_on](Scenario& scenario) {
        for (base::Channel& channel : scenario.radiance.channels) {
          if (const base::Channel* lit = on->find(channel.name)) channel.values = lit->values;
        }
      };
    } else {
      change.apply = [&in, index, more](Scenario& scenario) {
        for_light(scenario.radiance, [&](std::vector<float>& values) {
          for (const std::uint32_t pixel : in.plan.targets[index].seen) {
            values[pixel] += static_cast<float>(more);
          }
        });
      };
    }
    changes.push_back(std::move(change));
  }
  return changes;
}

std::optional<Change> without_saturation(const WhyNotInputs& in, std::size_t index) {
  const Sight& sight = in.sight.targets[index];
  if (!in.cctv || !in.sight.exposure || !sight.luminance) return std::nullopt;
  const degrade::Exposure& exposure = *in.sight.exposure;
  const double brighter = std::max(*sight.luminance, sight.surround.value_or(0.0));
  const double level = brighter * signal_per_luminance(in.cctv->camera, exposure);
  if (!(sight.saturated > 0.01) && level < 0.9) return std::nullopt;
  const double stops = std::max(2.0, std::log2(2.0 * level));
  Change change;
  change.cause = Cause::Saturated;
  change.share = sight.saturated;
  change.text = sight.saturated > 0.01
                    ? fmt::format("saturated ({} of it)", percent(*sight.saturated))
                    : "saturated round it";
  change.apply = [exposure, stops](Scenario& scenario) {
    degrade::CctvCamera& camera = scenario.cctv->camera;
    camera.iris = degrade::IrisMode::Fixed;
    camera.f_number = exposure.f_number * std::exp2(0.5 * stops);
    camera.gain_db = 20.0 * std::log10(exposure.gain);
  };
  return change;
}

std::vector<Change> without_blur_or_noise(const WhyNotInputs& in) {
  if (!in.cctv) return {};
  Change blur, noise;
  blur.cause = Cause::Blur;
  blur.text = "blurred away";
  blur.apply = [](Scenario& s) { stop(s, {"lens-spread", "blur", "bandwidth", "spread"}); };
  noise.cause = Cause::Noise;
  noise.text = "lost in noise";
  noise.apply = [](Scenario& s) { stop(s, {"signal-noise", "read-noise"}); };
  return {blur, noise};
}

std::vector<Change> without_limits_of_the_eye(const WhyNotInputs& in, std::size_t index) {
  const Sight& sight = in.sight.targets[index];
  Change contrast, small;
  contrast.cause = Cause::Contrast;
  contrast.text = "too little contrast for the eye's threshold";
  const auto tell = [&](const std::optional<double>& weber, const std::optional<double>& least) {
    if (!weber || !least) return;
    contrast.text +=
        fmt::format(" ({:.1f} % against {:.1f} %)", 100.0 * std::abs(*weber), 100.0 * *least);
  };
  if (sight.monitor) {
    tell(sight.monitor->weber, sight.monitor->threshold);
  } else if (sight.eye) {
    tell(sight.eye->weber, sight.eye->threshold);
  }
  contrast.apply = [](Scenario& s) { s.options.eye.threshold_factor = 0.0; };
  small.cause = Cause::Small;
  small.text = "too small";
  if (sight.tv_lines) {
    small.text += fmt::format(" ({:.1f} {} across it)", *sight.tv_lines,
                              in.cctv ? "TV lines" : "rows of the picture");
  }
  small.apply = [](Scenario& s) {
    for (double* needed :
         {&s.options.cycles.detect, &s.options.cycles.recognise, &s.options.cycles.identify}) {
      *needed *= 1e-9;
    }
  };
  return {contrast, small};
}

}  // namespace earthshine::studies
