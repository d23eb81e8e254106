// SPDX-License-Identifier: Apache-2.0
// Phong's k_d, k_s and n from measured reflectance: R(a) = k_d + k_s cos^n(a), a the off-specular
// angle, with standard errors.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace earthshine::scenes {

// Measured reflectance: a CSV file to points.

struct ReflectancePoint {
  double angle_deg = 0.0;    // from the mirror direction, -180 to 180
  double reflectance = 0.0;  // reflectance factor pi f
};

// Rows "angle in degrees, reflectance" with an optional heading row; # starts a comment.
// Throws base::Error (Input) with file, line and column.
[[nodiscard]] std::vector<ReflectancePoint> read_reflectance(const std::filesystem::path& path);

// How far a measured point lies from the true R, as a standard deviation.
enum class ReflectanceNoise {
  Proportional,  // a share of R: calibration, lamp and detector drift; 1 % of the peak is added in
                 // quadrature, so that points next to zero do not rule the fit
  Constant       // the same everywhere: a detector's dark noise
};

// Standard deviations of what was found, by first-order propagation of the noise; nothing where the
// data do not determine the quantity.
struct PhongErrors {
  std::optional<double> diffuse, specular, shininess;
};

struct PhongFit {
  double diffuse = 0.0;         // k_d
  double specular = 0.0;        // k_s
  double shininess = 1.0;       // n; 1 where there is no lobe
  double residual = 0.0;        // root mean square over all points, not weighted
  std::size_t points_used = 0;  // for n
  PhongErrors std_error{};
};

// k_d + 2 k_s / (n + 2): a scene refuses materials for which it exceeds 1.
[[nodiscard]] double reflected_share(const PhongFit& fit);

struct PhongFits {
  PhongFit report;         // the 1990 report's three steps
  PhongFit least_squares;  // over k_d, k_s >= 0 and 0.5 <= n <= 20000, weighted by the noise
  // Standard deviation of the noise: a share of R (Proportional) or a reflectance factor
  // (Constant), from the weighted residuals of least_squares over N - 3. Nothing for N = 3.
  std::optional<double> noise;
  std::vector<std::string> notes;  // what the data do not say
};

// The report's method: k_d = R(80 deg), k_s = R(0) - k_d, both interpolated linearly, and n the
// mean over the points between of ln((R - k_d) / k_s) / ln(cos a). Points on both sides of the
// mirror direction count alike. Its standard errors are those of its inputs carried through the
// three steps; they do not hold what the method gets wrong of a broad lobe, k_s cos^n(80 deg).
//
// Least squares: sum of ((R - model) / h)^2, h the shape of the noise at the fitted model, weights
// and fit in turn until they agree (the estimating equations of a quasi-likelihood: no bias from
// the weights). Covariance s^2 (J^T W J)^-1, s the noise, J by k_d, k_s and n. A lobe counts as
// found when leaving it out would raise the sum of squares by more than chance does: p = (S_lobe /
// S_flat)^((N - 3)/2), the F test with 2 and N - 3 degrees of freedom, below 0.001.
//
// Throws base::Error (Input), naming `source`, for fewer than 3 different angles or data that do
// not reach from 0 to 80 degrees.
[[nodiscard]] PhongFits fit_phong(std::span<const ReflectancePoint> points,
                                  const std::string& source,
                                  ReflectanceNoise noise = ReflectanceNoise::Proportional);

}  // namespace earthshine::scenes
