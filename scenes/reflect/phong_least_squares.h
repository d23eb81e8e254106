// SPDX-License-Identifier: Apache-2.0
// Least-squares part of fit_phong (phong_fit.h has the method and its source).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scenes/reflect/phong_fit.h"

namespace earthshine::scenes {

inline constexpr double least_shininess = 0.5;
inline constexpr double most_shininess = 20000.0;

struct LeastSquaresFit {
  PhongFit fit;
  std::vector<double> shape;    // standard deviation of each point = noise * shape
  std::optional<double> noise;  // no value with as many unknowns as points
  bool lobe_found = false;      // by the F test
};

// At least 3 points at different angles.
[[nodiscard]] LeastSquaresFit fit_least_squares(std::span<const ReflectancePoint> points,
                                                ReflectanceNoise noise);

// max(0, cos): no lobe beyond 90 degrees.
[[nodiscard]] double lobe_cosine(double angle_deg);
[[nodiscard]] double rms_residual(const PhongFit& fit, std::span<const ReflectancePoint> points);

}  // namespace earthshine::scenes
