// SPDX-License-Identifier: Apache-2.0
// The R2 lattice (Roberts 2018): any number of points, even over the unit square, in step with no
// pattern.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

namespace earthshine::base {

inline constexpr double r2_u = 0.7548776662466927, r2_v = 0.5698402909980532;

[[nodiscard]] inline glm::dvec2 even_point(std::size_t k) {
  return glm::fract(0.5 + static_cast<double>(k + 1) * glm::dvec2(r2_u, r2_v));
}

}  // namespace earthshine::base
