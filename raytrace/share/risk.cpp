// SPDX-License-Identifier: Apache-2.0
// Expected squared error after shrinkage (SURE).
#include <limits>

#include "base/parallel.h"
#include "raytrace/share/share.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t block = 256;

// Remaining noise, lost signal and Stein's term; inverse_dof: 1 / N. c = 1 - q / (D - k q), so that
// c' = (1 - c)^2 / q. The sum is at most the detail.
float residual_risk(float s, float q, float inverse_dof) {
  const float share = wiener_gain(s, q, inverse_dof), ratio = 1.0F - share;
  const float kept = share * share * q, lost = ratio * ratio * s;
  const float choice = std::min(4.0F * (s + q) * ratio * ratio * inverse_dof, s + q - kept - lost);
  return kept + lost + (share > 0.0F ? choice : 0.0F);
}

// Where the gain is 0, the measured signal is mostly chance: the signal of the next coarser level
// limits it.
float clamped_signal(float s, float q, float inverse_dof, float coarser) {
  const float held = std::min(std::max(s, 0.0F), coarser);
  return wiener_gain(s, q, inverse_dof) > 0.0F ? s : held;
}

}  // namespace

void Shared::squared_errors_with(double factor, std::size_t begin, std::size_t end,
                                 float* errors) const {
  const float per_more = 1.0F / static_cast<float>(factor);
  for (; begin < end; begin += block) {
    const std::size_t count = std::min(block, end - begin);
    std::array<float, block> clamped, coarser;
    coarser.fill(std::numeric_limits<float>::max());
    for (std::size_t k = 0; k < count; ++k) errors[k] = rest[begin + k] * per_more;
    for (std::size_t level = share_levels; level-- > 0;) {
      const float *s = &signal[level][begin], *q = &noise[level][begin],
                  *n = &inverse_dof[level][begin];
      for (std::size_t k = 0; k < count; ++k) {
        clamped[k] = clamped_signal(s[k], q[k], n[k], coarser[k]);
        // Off-grid points and small pictures have no coarser levels.
        coarser[k] = clamped[k] + q[k] > 0.0F ? clamped[k] : coarser[k];
      }
      if (level == 0 && !hidden.empty()) {
        const float* const hides = &hidden[begin];
        for (std::size_t k = 0; k < count; ++k)
          clamped[k] = std::max(clamped[k], hides[k] * per_more);
      }
      for (std::size_t k = 0; k < count; ++k) {
        errors[k] += residual_risk(clamped[k], q[k] * per_more, n[k]);
      }
    }
    errors += count;
  }
}

double Shared::squared_error_with(std::size_t point, double factor) const {
  float error = 0.0F;
  squared_errors_with(factor, point, point + 1, &error);
  return double(error);
}

void Shared::resize(std::size_t points) {
  for (auto* const by_level : {&signal, &noise, &inverse_dof}) {
    base::resize_together(*by_level, points);
  }
  rest.resize(points, 0.0F);
  squared_error.resize(points, 0.0F);
}

}  // namespace earthshine::raytrace
