// SPDX-License-Identifier: Apache-2.0
// Solutions of a scene that changes between pictures: a new camera reads the one that is there.
#pragma once

#include <cstdint>
#include <list>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/render/light.h"

namespace earthshine::app {

class KeptLights {
 public:
  // The call's light as find_light() finds it, kept unless it was broken off. Valid until the next
  // call.
  [[nodiscard]] const Solved& take(const LightCall& wanted, StageTimes& times);
  [[nodiscard]] std::size_t solves() const { return solves_; }
  // Of the scene's parts (radiosity/store/solution_key.h).
  [[nodiscard]] static std::vector<std::uint64_t> digests_of(const LoadedScene& loaded);

 private:
  // What a solution depends on: the scene's parts, the solver's knobs, the effects.
  struct Key {
    std::vector<std::uint64_t> parts;
    std::vector<std::variant<double, std::uint64_t>> knobs;
    scenes::Effects effects;
    std::vector<std::string> groups;
    double time_limit_s = 0.0;

    [[nodiscard]] bool operator==(const Key& other) const;
  };
  static Key key_of(const LightCall& wanted);

  std::list<std::pair<Key, Solved>> lights_;  // the latest first
  Solved broken_off_;
  std::size_t solves_ = 0;
};

}  // namespace earthshine::app
