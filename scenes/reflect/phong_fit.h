// SPDX-License-Identifier: Apache-2.0
// Fits Phong's k_d, k_s and n to measured reflectance: R(a) = k_d + k_s cos^n(a), a the
// off-specular angle, with standard errors.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace earthshine::scenes {

// Measured reflectance from a CSV file.

struct ReflectancePoint {
  double angle_deg = 0.0;    // from the mirror direction, -180 to 180
  double reflectance = 0.0;  // reflectance factor pi f
};

// Rows "angle in degrees, reflectance" with an optional header row; # starts a comment. Throws
// base::Error (Input) with file, line and column.
[[nodiscard]] std::vector<ReflectancePoint> read_reflectance(const std::filesystem::path& path);

// Model of the standard deviation of a measured point.
enum class ReflectanceNoise {
  Proportional,  // proportional to R: calibration, lamp and detector drift; 1 % of the peak is
                 // added in quadrature, so that points near zero do not dominate the fit
  Constant       // equal everywhere: a detector's dark noise
};

// Standard errors by first-order propagation of the noise; no value if the data do not determine
// the quantity.
struct PhongErrors {
  std::optional<double> diffuse, specular, shininess;
};

struct PhongFit {
  double diffuse = 0.0;         // k_d
  double specular = 0.0;        // k_s
  double shininess = 1.0;       // n; 1 without a lobe
  double residual = 0.0;        // unweighted RMS over all points
  std::size_t points_used = 0;  // to determine n
  PhongErrors std_error{};
};

// k_d + 2 k_s / (n + 2): scenes reject materials for which it exceeds 1.
[[nodiscard]] double reflected_share(const PhongFit& fit);

struct PhongFits {
  PhongFit report;         // the 1990 report's three steps
  PhongFit least_squares;  // over k_d, k_s >= 0 and 0.5 <= n <= 20000, weighted by the noise
  // Standard deviation of the noise, as a share of R (Proportional) or a reflectance factor
  // (Constant), from the weighted residuals of least_squares over N - 3. No value for N = 3.
  std::optional<double> noise;
  std::vector<std::string> notes;  // quantities that the data do not determine
};

// Method of the report: k_d = R(80 deg), k_s = R(0) - k_d, both interpolated linearly; n is the
// mean of ln((R - k_d) / k_s) / ln(cos a) over the points between. Points on both sides of the
// mirror direction have equal weight. Its standard errors propagate the noise through the three
// steps. They exclude the method's bias for a broad lobe, k_s cos^n(80 deg).
//
// Least squares: minimises the sum of ((R - model) / h)^2, h the shape of the noise at the fitted
// model. Weights and fit alternate until they agree (the estimating equations of a
// quasi-likelihood: the weights cause no bias). Covariance s^2 (J^T W J)^-1, s the noise, J the
// derivatives by k_d, k_s and n. A lobe is significant if p = (S_lobe / S_flat)^((N - 3)/2) <
// 0.001: the F test with 2 and N - 3 degrees of freedom.
//
// Throws base::Error (Input), with the name `source`, for fewer than 3 different angles or data
// that do not cover 0 to 80 degrees.
[[nodiscard]] PhongFits fit_phong(std::span<const ReflectancePoint> points,
                                  const std::string& source,
                                  ReflectanceNoise noise = ReflectanceNoise::Proportional);

}  // namespace earthshine::scenes
