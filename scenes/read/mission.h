// SPDX-License-Identifier: Apache-2.0
// [time], and an [orbit] with a trajectory.
#pragma once

#include "scenes/text/table_reader.h"
#include "scenes/time/mission.h"

namespace earthshine::scenes {

// Limit of the number of times of a [time].
inline constexpr std::size_t most_moments = 3600;
// Of a study; a scene's has the key "moment" too.
[[nodiscard]] TimeSpan read_time(const TomlNode& node);
// UTC, as a string or a TOML date; no value if the key is absent.
[[nodiscard]] std::optional<Instant> read_moment(const TableReader& table, std::string_view key);

// Whether an [orbit] has a trajectory.
[[nodiscard]] bool names_trajectory(const TomlNode& orbit);
// Such an [orbit], with [time] unless it is null. Files are looked for beside scene.path, named in
// scene.files, and warnings go to the scene.
// body_axes and quaternion beside an attitude from a file.
[[nodiscard]] glm::dmat3 read_body_axes(const TableReader& table);
[[nodiscard]] std::optional<ScalarPlace> read_scalar_place(const TableReader& table);

// The keys that [sun] has; the others follow from its distance.
struct SunKeys {
  bool illuminance = false, angular_radius_deg = false;
};
[[nodiscard]] Orbit read_mission(Scene& scene, const TomlNode& orbit, const TomlNode* time,
                                 const SunKeys& given);

}  // namespace earthshine::scenes
