// SPDX-License-Identifier: Apache-2.0
// A table of attitudes: a CSV file to AttitudeTable.
//
// The header line names the columns, in any order: time_s (since orbit noon) or position_deg, and
// either qw, qx, qy, qz or yaw_deg, pitch_deg, roll_deg. Blank lines do not count, # starts a
// comment.
//
// A turn is relative to the local vertical: axes 1 along the velocity, 2 to starboard of it
// (against the orbit normal), 3 to the nadir. The spacecraft's axes are 1 nose, 2 starboard,
// 3 belly: scene -x, y, -z. The turn, the quaternion q with its scalar first, takes the local
// vertical's axes to the spacecraft's; a vector of components p along the spacecraft's axes has
// q p q* along the local vertical's. The identity is nose forward and belly to the Earth:
// bay-to-space. Yaw, pitch and roll are taken about the spacecraft's own axes 3, 2, 1 in this order
// (nose to starboard, nose up, starboard side down): q = q3(yaw) q2(pitch) q1(roll). bay-to-earth
// is roll 180, tail-down yaw 180 and pitch 90.
//
// Between rows the turn goes by slerp (Shoemake 1985), the shorter way; one row holds everywhere.
// Rows half a turn or more apart are named: their angles say another way than the one that is taken.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// asked_at is the place that names the file. Throws base::Error (Input) there if it cannot be read
// or has more than 16 MiB, and at the file's line and column for what is wrong in it: columns,
// rows without them, what is no number, times that do not rise, quaternions whose length is more
// than 1 % from 1. warnings: gets a line for the first two rows half a turn or more apart, be it by
// the turn between them or by an angle that does not just pass from 360 to 0, or from 180 to -180
// deg, as its neighbours go on.
[[nodiscard]] AttitudeTable read_attitudes(const std::filesystem::path& path,
                                           const base::Location& asked_at,
                                           std::vector<std::string>& warnings);

}  // namespace earthshine::scenes
