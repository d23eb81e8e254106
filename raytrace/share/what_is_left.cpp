// SPDX-License-Identifier: Apache-2.0
// The squared error that keeping details leaves.
#include <limits>

#include "base/parallel.h"
#include "raytrace/share/share.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t points_at_once = 256;

// What is kept of the noise and not kept of the signal. few: 1 / N. c = 1 - q / (D - k q), so c' =
// (1 - c)^2 / q; no choice is off by more than the detail.
float left_of(float s, float q, float few) {
  const float share = kept_share(s, q, few), ratio = 1.0F - share;
  const float kept = share * share * q, lost = ratio * ratio * s;
  const float choice = std::min(4.0F * (s + q) * ratio * ratio * few, s + q - kept - lost);
  return kept + lost + (share > 0.0F ? choice : 0.0F);
}

// Of details that nothing is kept of the signal that is found is mostly chance: it is held to that
// of the next coarser ones.
float told_signal(float s, float q, float few, float coarser) {
  const float held = std::min(std::max(s, 0.0F), coarser);
  return kept_share(s, q, few) > 0.0F ? s : held;
}

}  // namespace

void Shared::squared_errors_with(double factor, std::size_t begin, std::size_t end,
                                 float* errors) const {
  const float per_more = 1.0F / static_cast<float>(factor);
  for (; begin < end; begin += points_at_once) {
    const std::size_t count = std::min(points_at_once, end - begin);
    std::array<float, points_at_once> told, coarser;
    coarser.fill(std::numeric_limits<float>::max());
    for (std::size_t k = 0; k < count; ++k) errors[k] = rest[begin + k] * per_more;
    for (std::size_t level = share_levels; level-- > 0;) {
      const float *s = &signal[level][begin], *q = &noise[level][begin], *n = &few[level][begin];
      for (std::size_t k = 0; k < count; ++k) {
        told[k] = told_signal(s[k], q[k], n[k], coarser[k]);
        // Of strays, and in small pictures, there are no coarser ones.
        coarser[k] = told[k] + q[k] > 0.0F ? told[k] : coarser[k];
      }
      if (level == 0 && !hidden.empty()) {
        const float* const hides = &hidden[begin];
        for (std::size_t k = 0; k < count; ++k) told[k] = std::max(told[k], hides[k] * per_more);
      }
      for (std::size_t k = 0; k < count; ++k) {
        errors[k] += left_of(told[k], q[k] * per_more, n[k]);
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
  for (auto* const by_level : {&signal, &noise, &few}) {
    base::resize_together(*by_level, points);
  }
  rest.resize(points, 0.0F);
  squared_error.resize(points, 0.0F);
}

}  // namespace earthshine::raytrace
