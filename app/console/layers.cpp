// SPDX-License-Identifier: Apache-2.0
#include "app/console/layers.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/console.h"
#include "app/views/frames.h"
#include "base/error.h"

namespace earthshine::app {
namespace {

using scenes::no_group;

// The consecutive light groups of the Sun's or the Earth's parts.
struct Range {
  std::size_t first = no_group, count = 0;
  [[nodiscard]] bool has(std::size_t group) const {
    return first != no_group && group >= first && group < first + count;
  }
};

Range suns_of(const studies::LightBasis& basis) {
  const scenes::LightGroups& groups = basis.groups();
  return {basis.in_parts() ? groups.sun_parts : groups.sun, basis.sun_parts()};
}

Range earth_of(const studies::LightBasis& basis) {
  return {basis.groups().earth, basis.earth_parts()};
}

std::size_t number_of(const std::vector<ConsoleLight>& lights, const std::string& name) {
  const auto found = std::find_if(lights.begin(), lights.end(),
                                  [&](const ConsoleLight& light) { return light.name == name; });
  return static_cast<std::size_t>(found - lights.begin());
}

void add(std::vector<float>& sum, const base::Image& image, const std::string& layer,
         const char* colour, double factor) {
  if (factor == 0.0) return;
  const base::Channel* channel = image.find("light_" + layer + "." + colour);
  if (channel == nullptr) return;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] += static_cast<float>(factor * static_cast<double>(channel->values[i]));
  }
}

// Weighted sum of these groups; no value if all weights are 0.
std::optional<ConsoleLayer> weighted(const base::Image& image,
                                     const std::vector<std::string>& names,
                                     const std::vector<Rgb>& weights, const Range& range) {
  ConsoleLayer layer;
  for (std::vector<float>* plane : {&layer.r, &layer.g, &layer.b}) {
    plane->assign(image.pixel_count(), 0.0F);
  }
  bool any = false;
  for (std::size_t g = range.first; g < range.first + range.count; ++g) {
    any = any || base::max_component(weights[g]) > 0.0;
    add(layer.r, image, names[g], "R", weights[g].r);
    add(layer.g, image, names[g], "G", weights[g].g);
    add(layer.b, image, names[g], "B", weights[g].b);
  }
  return any ? std::optional(std::move(layer)) : std::nullopt;
}

std::vector<ConsoleLayer> layers_of(const StudyPart& part, const base::Image& image) {
  const studies::LightBasis& basis = *part.basis;
  const std::vector<std::string>& names = basis.groups().names;
  const std::vector<ConsoleLight> lights = console_lights(part);
  const Range suns = suns_of(basis), earth = earth_of(basis);
  std::vector<ConsoleLayer> layers;
  const auto take = [&](std::optional<ConsoleLayer> layer, const std::string& light,
                        std::optional<std::size_t> place) {
    if (!layer) return;
    layer->light = number_of(lights, light);
    layer->place = place;
    layers.push_back(std::move(*layer));
  };
  const std::vector<Rgb> ones(names.size(), Rgb(1.0));
  for (std::size_t g = 0; g < names.size(); ++g) {
    const bool sky = suns.has(g) || earth.has(g);
    if (!sky || !basis.in_parts()) take(weighted(image, names, ones, {g, 1}), names[g], {});
  }
  // As in the scene: a lamp setting may dim both.
  for (std::size_t p = 0; basis.in_parts() && p < basis.places().size(); ++p) {
    if (suns.count > 0) {
      take(weighted(image, names, basis.weights_with(p, 0, "sun").weight, suns), "sun", p);
    }
    if (earth.count > 0) {
      take(weighted(image, names, basis.weights_with(p, 0, "earth").weight, earth), "earth", p);
    }
  }
  return layers;
}

}  // namespace

studies::StudyFile console_study(const StudyCall& call, std::vector<double> positions_deg) {
  studies::StudyFile study = study_of(call, {}, {});
  study.positions_deg = std::move(positions_deg);
  const LoadedScene named = load(call.scene, true);
  studies::LampSetting& setting = study.lamps.front();
  if (named.scene.lamps.size() <= most_faders) {
    for (const scenes::Lamp& lamp : named.scene.lamps) setting.factors[lamp.name] = Rgb(1.0);
  }
  return study;
}

std::vector<ConsoleLight> console_lights(const StudyPart& part) {
  const studies::LightBasis& basis = *part.basis;
  const scenes::LightGroups& groups = basis.groups();
  const Range suns = suns_of(basis), earth = earth_of(basis);
  const scenes::Scene& scene = part.loaded.scene;
  std::vector<ConsoleLight> lights;
  for (std::size_t g = 0; g < groups.count(); ++g) {
    if (suns.has(g) || earth.has(g)) {
      const std::string name = suns.has(g) ? "sun" : "earth";
      if (number_of(lights, name) == lights.size()) lights.push_back({name, name, ""});
      continue;
    }
    ConsoleLight light{groups.names[g], g == groups.ambient ? "ambient" : "group", ""};
    for (const scenes::Lamp& lamp : scene.lamps) {
      if (lamp.name == light.name && lamp.group != light.name) {
        light.kind = "lamp";
        light.group = lamp.group;
      }
    }
    lights.push_back(std::move(light));
  }
  return lights;
}

void draw_views(const StudyPart& part, const std::string& folder, const std::string& other,
                const Common& common, const std::function<void(ConsoleView)>& take) {
  const PartCall alone;
  std::vector<StudyCost> costs;
  std::optional<StudyFrames> finished;
  if (!other.empty()) finished.emplace(part, other, common, alone);
  std::optional<StudyFrames> own;
  for (const StudyCamera& camera : part.cameras) {
    const bool known = finished && finished->has(camera);
    if (!known && !own) own.emplace(part, folder, common, alone);
    std::optional<StudyFrames::Frame> frame;
    if (!Interrupt::asked()) frame = (known ? *finished : *own).frame(camera, costs);
    if (!frame) {
      throw base::Error(base::Blame::Work, "console", "interrupted", {},
                        "Run the same command again: finished cameras are in " + folder);
    }
    ConsoleView view;
    view.camera = &camera;
    view.relative_noise = frame->relative_noise;
    view.seconds = frame->seconds;
    view.layers = layers_of(part, frame->image);
    studies::ObjectMap map = studies::object_map(frame->image);
    auto targets = studies::find_targets(part.basis->scene(), *camera.camera, map);
    view.plan = studies::plan_sight(*camera.camera, std::move(map), std::move(targets));
    view.image = std::move(frame->image);
    take(std::move(view));
  }
}

}  // namespace earthshine::app
