// SPDX-License-Identifier: Apache-2.0
#include "studies/why/sight_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace earthshine::studies {
namespace {

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

// Factor on the distance of a lamp that is too far.
constexpr double nearer = 0.25;
// Relative to the reference white: below, the distance of a lamp may be the cause.
constexpr double dark_signal = 0.25;
// Weber contrast below which a target is as bright as its surround.
constexpr double no_contrast = 0.02;

double mean_over(const base::Image& image, const std::vector<std::uint32_t>& pixels) {
  const std::vector<float> luminance = base::luminance_of(image);
  double sum = 0.0;
  for (const std::uint32_t pixel : pixels) sum += static_cast<double>(luminance[pixel]);
  return sum / static_cast<double>(std::max<std::size_t>(1, pixels.size()));
}

// Whether the target is too dark for another reason than a closed iris.
bool is_dark(const WhyNotInputs& in, std::size_t index) {
  const Sight& sight = in.sight.targets[index];
  if (!in.cctv || !in.sight.exposure) return true;  // an eye
  if (in.cctv->camera.iris != degrade::IrisMode::Fixed && !in.sight.exposure->underexposed) {
    return false;
  }
  return sight.luminance.value_or(0.0) * signal_per_luminance(in.cctv->camera, *in.sight.exposure) <
         dark_signal;
}

}  // namespace

Scenario scenario_of(const WhyNotInputs& in, std::size_t index, const SightOptions& options) {
  // Sights need only the map's size; a scenario is copied often.
  const ObjectMap size{in.plan.map.columns, in.plan.map.rows, {}};
  Scenario scenario{{size, in.plan.fov_deg, {in.plan.targets[index]}}, {}, in.cctv, options};
  scenario.radiance.width = in.radiance.width;
  scenario.radiance.height = in.radiance.height;
  for (const char* name : {"R", "G", "B", "Y"}) {
    if (const base::Channel* channel = in.radiance.find(name)) {
      scenario.radiance.channels.push_back(*channel);
    }
  }
  return scenario;
}

Scenario without_all(const Scenario& scenario, const std::vector<Change>& changes) {
  Scenario changed = scenario;
  const auto apply = [&](bool light) {
    for (const Change& change : changes) {
      if ((change.cause == Cause::Unlit) == light) change.apply(changed);
    }
  };
  apply(true);
  apply(false);
  return changed;
}

double signal_per_luminance(const degrade::CctvCamera& camera, const degrade::Exposure& exposure) {
  return degrade::lens_transfer(camera, exposure.f_number) / camera.white_lux * exposure.gain;
}

void hold_exposure(Scenario& scenario, const degrade::Exposure& exposure) {
  degrade::CctvCamera& camera = scenario.cctv->camera;
  camera.iris = degrade::IrisMode::Fixed;
  camera.f_number = exposure.f_number;
  camera.gain_db = 20.0 * std::log10(exposure.gain);
}

std::optional<Change> without_hiding(const WhyNotInputs& in, std::size_t index) {
  const TargetView& view = in.plan.targets[index].view;
  const auto alone = static_cast<double>(view.pixels_alone);
  // A hidden corner is no reason.
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
                               const std::vector<SourceOnTarget>& sources, std::size_t most) {
  const std::vector<std::uint32_t>& measured = in.plan.targets[index].view.measured;
  const double now = in.sight.targets[index].luminance.value_or(0.0);
  std::vector<std::pair<double, Change>> by_light;
  for (const SourceOnTarget& source : sources) {
    const double more = source.unshadowed - source.direct;
    const bool picture = !source.off.empty() && source.when_on != nullptr;
    std::string why = darkness_of(source);
    Change change;
    change.cause = Cause::Unlit;
    change.by = source.group;
    change.share = 1.0 - source.lit;
    change.without = "with it";
    if (picture) {
      change.apply = [on = source.when_on](Scenario& scenario) {
        for (base::Channel& channel : scenario.radiance.channels) {
          if (const base::Channel* lit = on->find(channel.name)) channel.values = lit->values;
        }
      };
      by_light.emplace_back(mean_over(*source.when_on, measured) - now, change);
    } else if (!why.empty() && more > 0.0) {
      change.apply = [&in, index, more](Scenario& scenario) {
        for_light(scenario.radiance, [&](std::vector<float>& values) {
          for (const std::uint32_t pixel : in.plan.targets[index].seen) {
            values[pixel] += static_cast<float>(more);
          }
        });
      };
      by_light.emplace_back(more, change);
    } else if (why.empty() && source.distance_m > 0.0 && source.direct > 0.0 &&
               source.luminance > 0.5 * now && is_dark(in, index)) {
      // Scales the whole picture by the lamp's share of the target's light: surfaces beside the
      // target are as far.
      const double share = std::min(1.0, source.luminance / now);
      const double factor = 1.0 + share * (1.0 / (nearer * nearer) - 1.0);
      why = fmt::format("{} is too far ({:.3g} m), it gives {:.2g} cd/m^2", source.group,
                        source.distance_m, source.luminance);
      change.without = "four times nearer";
      change.apply = [factor](Scenario& scenario) {
        for_light(scenario.radiance, [&](std::vector<float>& values) {
          for (float& value : values) value *= static_cast<float>(factor);
        });
      };
      by_light.emplace_back((factor - 1.0) * now, change);
    } else {
      continue;
    }
    by_light.back().second.text = "unlit: " + why;
  }
  std::stable_sort(by_light.begin(), by_light.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Change> changes;
  for (auto& [light, change] : by_light) {
    if (changes.size() < most) changes.push_back(std::move(change));
  }
  return changes;
}

std::optional<Change> without_black_back(const WhyNotInputs& in, std::size_t index,
                                         const std::vector<SourceOnTarget>& sources) {
  const std::vector<std::uint32_t>& back = in.plan.targets[index].view.black_back;
  const double share = in.sight.targets[index].black_back.value_or(0.0);
  if (!(share >= 0.1)) return std::nullopt;  // a corner of it is no reason
  double more = 0.0;
  for (const SourceOnTarget& source : sources) more += source.on_back;
  Change change;
  change.cause = Cause::BlackBack;
  change.share = share;
  change.text = fmt::format("black back seen ({} of it): its surface has one side", percent(share));
  change.without = "with a back like its front";
  // The mean is over all points; only pixels with the back change.
  change.apply = [&back, more = more / share](Scenario& scenario) {
    for_light(scenario.radiance, [&](std::vector<float>& values) {
      for (const std::uint32_t pixel : back) values[pixel] += static_cast<float>(more);
    });
    for (SightTarget& target : scenario.plan.targets) target.view.black_back.clear();
  };
  return change;
}

std::vector<Change> without_limits_of_the_eye(const WhyNotInputs& in, std::size_t index) {
  const Sight& sight = in.sight.targets[index];
  Change contrast, small;
  contrast.cause = Cause::Contrast;
  const bool none = sight.weber && std::abs(*sight.weber) < no_contrast;
  contrast.text = none ? fmt::format("as bright as what is round it (contrast {:.1f} %)",
                                     100.0 * std::abs(*sight.weber))
                       : "too little contrast for the eye's threshold";
  contrast.without = none ? "on a black ground" : "to an eye without one";
  const auto add_figures = [&](const std::optional<double>& weber,
                               const std::optional<double>& least) {
    if (none || !weber || !least) return;
    contrast.text +=
        fmt::format(" ({:.1f} % against {:.1f} %)", 100.0 * std::abs(*weber), 100.0 * *least);
  };
  if (sight.monitor) {
    add_figures(sight.monitor->weber, sight.monitor->threshold);
  } else if (sight.eye) {
    add_figures(sight.eye->weber, sight.eye->threshold);
  }
  contrast.apply = [none](Scenario& s) {
    s.options.eye.threshold_factor = 0.0;
    if (!none) return;
    for_light(s.radiance, [&](std::vector<float>& values) {
      for (const std::uint32_t pixel : s.plan.targets.front().view.surround) values[pixel] = 0.0F;
    });
  };
  small.without = "if it were large";
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
