// SPDX-License-Identifier: Apache-2.0
// Reads a table of attitudes from a CSV file to AttitudeTable.
//
// The header line names the columns, in any order: time_s (since orbit noon) or position_deg, and
// either qw, qx, qy, qz or yaw_deg, pitch_deg, roll_deg. Blank lines are ignored, # starts a
// comment.
//
// Attitudes are relative to the local vertical: axes 1 along the velocity, 2 to starboard (against
// the orbit normal), 3 to the nadir. The spacecraft's axes are 1 nose, 2 starboard, 3 belly: scene
// -x, y, -z. The quaternion q, scalar first, rotates the axes of the local vertical to the
// spacecraft's axes: a vector with components p in spacecraft axes has components q p q* in the
// local vertical. The identity is nose forward and belly to the Earth: bay-to-space. Yaw, pitch and
// roll are rotations about the spacecraft's own axes 3, 2, 1 in this order (nose to starboard, nose
// up, starboard side down): q = q3(yaw) q2(pitch) q1(roll). bay-to-earth is roll 180; tail-down is
// yaw 180 and pitch 90.
//
// Between rows slerp interpolates by the shorter way (Shoemake 1985). A single row is valid
// everywhere. A warning names rows that differ by half a turn or more: their angles suggest the
// other way.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// asked_at: the place that names the file. Throws base::Error (Input) at asked_at if the file
// cannot be read or exceeds 16 MiB, and at the file's line and column for invalid columns,
// incomplete rows, invalid numbers, times that do not rise, and quaternions whose length differs
// from 1 by more than 1 %. warnings: gets a line for the first two rows that differ by half a turn
// or more, in the rotation between them or in an angle. An angle that only wraps from 360 to 0, or
// from 180 to -180 deg, consistent with its neighbours, is no such difference.
[[nodiscard]] AttitudeTable read_attitudes(const std::filesystem::path& path,
                                           const base::Location& asked_at,
                                           std::vector<std::string>& warnings);

}  // namespace earthshine::scenes
