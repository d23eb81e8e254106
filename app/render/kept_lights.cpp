// SPDX-License-Identifier: Apache-2.0
#include "app/render/kept_lights.h"

#include <cstring>
#include <type_traits>

#include "radiosity/store/solution_key.h"

namespace earthshine::app {
namespace {

// Of the scenes and lights that a program goes back and forth between.
constexpr std::size_t most_kept = 4;

}  // namespace

bool KeptLights::Key::operator==(const Key& other) const {
  static_assert(std::has_unique_object_representations_v<scenes::Effects>);
  return parts == other.parts && knobs == other.knobs && groups == other.groups &&
         time_limit_s == other.time_limit_s &&
         std::memcmp(&effects, &other.effects, sizeof effects) == 0;
}

std::vector<std::uint64_t> KeptLights::digests_of(const LoadedScene& loaded) {
  std::vector<std::uint64_t> digests;
  for (const radiosity::ScenePart& part : radiosity::scene_parts(loaded.scene, loaded.groups)) {
    digests.push_back(part.digest);
  }
  return digests;
}

KeptLights::Key KeptLights::key_of(const LightCall& wanted) {
  const LoadedScene& loaded = wanted.loaded;
  Key key{digests_of(loaded), {}, loaded.effects, loaded.groups.names, wanted.call.time_limit_s};
  const radiosity::SolveOptions solver = solver_of(wanted.call, loaded.scene, wanted.common);
  for (const auto& knob : radiosity::solve_knobs(solver)) key.knobs.push_back(knob.value);
  key.knobs.emplace_back(static_cast<std::uint64_t>(wanted.call.indirect));
  return key;
}

const Solved& KeptLights::take(const LightCall& wanted, StageTimes& times) {
  Key key = key_of(wanted);
  for (auto kept = lights_.begin(); kept != lights_.end(); ++kept) {
    if (!(kept->first == key)) continue;
    lights_.splice(lights_.begin(), lights_, kept);
    return lights_.front().second;
  }
  Solved light = find_light(wanted, times);
  if (wanted.stop && wanted.stop()) {
    broken_off_ = std::move(light);
    return broken_off_;
  }
  solves_ += light.solved ? 1 : 0;
  lights_.emplace_front(std::move(key), std::move(light));
  if (lights_.size() > most_kept) lights_.pop_back();
  return lights_.front().second;
}

}  // namespace earthshine::app
