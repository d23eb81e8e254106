// SPDX-License-Identifier: Apache-2.0
// The squared error that keeping details leaves.
#include "raytrace/share/share.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t points_at_once = 256;

// What is kept of the noise, and what is not kept of the signal.
struct Left {
  float noise, blur;
  // Signals that are not there come out as often below zero as above; noise is never undone so.
  [[nodiscard]] float all() const { return noise + std::max(0.0F, blur); }
};

// few: 1 / N. c = 1 - q / (D - k q), so c' = (1 - c)^2 / q; no choice is off by more than the
// detail.
Left left_of(float s, float q, float few) {
  const float share = kept_share(s, q), ratio = 1.0F - share;
  const float kept = share * share * q, lost = ratio * ratio * s;
  const float choice = std::min(4.0F * (s + q) * ratio * ratio * few, s + q - kept - lost);
  return {kept + (share > 0.0F ? choice : 0.0F), lost};
}

}  // namespace

void Shared::squared_errors_with(double factor, std::size_t begin, std::size_t end,
                                 float* errors) const {
  const float per_more = 1.0F / static_cast<float>(factor);
  std::array<float, points_at_once> kept, lost;
  for (; begin < end; begin += points_at_once) {
    const std::size_t count = std::min(points_at_once, end - begin);
    for (std::size_t k = 0; k < count; ++k) kept[k] = rest[begin + k] * per_more, lost[k] = 0.0F;
    for (std::size_t level = 0; level < share_levels; ++level) {
      const float *s = &signal[level][begin], *q = &noise[level][begin], *n = &few[level][begin];
      std::array<float, points_at_once> least;
      if (level == 0 && !hidden.empty()) {
        for (std::size_t k = 0; k < count; ++k) {
          const float hides = hidden[begin + k] * per_more;
          least[k] = hides > 0.0F ? std::max(s[k], hides) : s[k];
        }
        s = least.data();
      }
      for (std::size_t k = 0; k < count; ++k) {
        const Left left = left_of(s[k], q[k] * per_more, n[k]);
        kept[k] += left.noise;
        lost[k] += left.blur;
      }
    }
    for (std::size_t k = 0; k < count; ++k) *errors++ = Left{kept[k], lost[k]}.all();
  }
}

double Shared::squared_error_with(std::size_t point, double factor) const {
  float error = 0.0F;
  squared_errors_with(factor, point, point + 1, &error);
  return double(error);
}

void Shared::resize(std::size_t points) {
  for (auto* const by_level : {&signal, &noise, &few}) {
    for (std::vector<float>& of : *by_level) of.resize(points, 0.0F);
  }
  rest.resize(points, 0.0F);
  squared_error.resize(points, 0.0F);
}

}  // namespace earthshine::raytrace
