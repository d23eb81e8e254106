// SPDX-License-Identifier: Apache-2.0
// The cameras that ship with the program, with the source of each number.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "degrade/parts/monitor.h"
#include "degrade/stage/camera.h"

namespace earthshine::degrade {

// Source of a setting's value. In a shipped camera one of
//   [1990]   NASA Johnson Space Center's report on simulated CCTV pictures of the payload bay, 1990
//   [GCTA]   Apollo ground-commanded television assembly, an RCA SIT camera of the same makers
//   [IUCr]   International Tables for Crystallography C, 7.1.6.5.4, on SIT tubes
//   [SCOM]   Shuttle Crew Operations Manual 2.3, the closed-circuit television
//   [shutref] NASA's Shuttle Reference, closed-circuit television: monochrome, colour by the lens
//   computed: from the other numbers or a standard
//   estimate: usual for this kind of device at the time; no flight figure was found
//   none: off, with the reason
struct SettingSource {
  std::string key;
  std::string source;
};

// sources: one per setting in use, in the order of the fields; monitor_sources likewise.
struct Preset {
  std::string_view name;
  std::string_view about;
  CctvCamera camera;
  std::vector<SettingSource> sources;
  Monitor monitor;
  std::vector<SettingSource> monitor_sources;
};

[[nodiscard]] std::span<const Preset> presets();
[[nodiscard]] const Preset* find_preset(std::string_view name);  // nullptr if there is none

}  // namespace earthshine::degrade
