// SPDX-License-Identifier: Apache-2.0
// Measured reflectance: a CSV file to points.
#pragma once

#include <filesystem>
#include <vector>

namespace earthshine::scenes {

struct ReflectancePoint {
  double angle_deg = 0.0;    // from the mirror direction, -180 to 180
  double reflectance = 0.0;  // reflectance factor pi f
};

// Rows "angle in degrees, reflectance" with an optional heading row; # starts a comment.
// Throws base::Error (Input) with file, line and column.
[[nodiscard]] std::vector<ReflectancePoint> read_reflectance(const std::filesystem::path& path);

}  // namespace earthshine::scenes
