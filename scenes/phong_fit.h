// SPDX-License-Identifier: Apache-2.0
// Phong's k_d, k_s and n from measured reflectance: R(a) = k_d + k_s cos^n(a), a the off-specular
// angle.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace earthshine::scenes {

struct ReflectancePoint {
  double angle_deg = 0.0;    // from the mirror direction, -180 to 180
  double reflectance = 0.0;  // reflectance factor pi f
};

struct PhongFit {
  double diffuse = 0.0;         // k_d
  double specular = 0.0;        // k_s
  double shininess = 1.0;       // n; 1 where there is no lobe
  double residual = 0.0;        // root mean square over all points
  std::size_t points_used = 0;  // for n
};

// k_d + 2 k_s / (n + 2): a scene refuses materials for which it exceeds 1.
[[nodiscard]] double reflected_share(const PhongFit& fit);

struct PhongFits {
  PhongFit report;                 // the 1990 report's three steps
  PhongFit least_squares;          // smallest residual over k_d, k_s >= 0 and 0.5 <= n <= 20000
  std::vector<std::string> notes;  // what the data do not say
};

// Rows "angle in degrees, reflectance" with an optional heading row; # starts a comment.
// Throws base::Error (Input) with file, line and column.
[[nodiscard]] std::vector<ReflectancePoint> read_reflectance(const std::filesystem::path& path);

// The report's method: k_d = R(80 deg), k_s = R(0) - k_d, both interpolated linearly, and n the
// mean over the points between of ln((R - k_d) / k_s) / ln(cos a). Points on both sides of the
// mirror direction count alike. Throws base::Error (Input), naming `source`, for fewer than 3
// different angles or data that do not reach from 0 to 80 degrees.
[[nodiscard]] PhongFits fit_phong(std::span<const ReflectancePoint> points,
                                  const std::string& source);

}  // namespace earthshine::scenes
