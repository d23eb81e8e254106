// SPDX-License-Identifier: Apache-2.0
// The cameras that ship.
#pragma once

#include <span>
#include <string_view>

#include "degrade/camera.h"

namespace earthshine::degrade {

struct Preset {
  std::string_view name;
  std::string_view about;
  CctvCamera camera;
};

[[nodiscard]] std::span<const Preset> presets();
[[nodiscard]] const Preset* find_preset(std::string_view name);  // nullptr when there is none

}  // namespace earthshine::degrade
