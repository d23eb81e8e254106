// SPDX-License-Identifier: Apache-2.0
// What is kept of a detail, and the squared error that this leaves.
#include "raytrace/share/share.h"

namespace earthshine::raytrace {
namespace {

// Noise that is found by chance looks like signal half of the time: only what is well above it
// counts when details are kept.
constexpr float doubt = 1.5F;

}  // namespace

float kept_share(float s, float q) {
  const float sure = s - (doubt - 1.0F) * q;
  return sure > 0.0F ? sure / (sure + q) : 0.0F;
}

namespace {

// What that leaves: what is kept of the noise, and what is not kept of the signal. few: 1 / N.
struct Left {
  float noise = 0.0F, blur = 0.0F;
  void add(float s, float q, float few) {
    const float share = kept_share(s, q);
    const float ratio = 1.0F - share, kept = share * share * q, lost = ratio * ratio * s;
    noise += kept;
    blur += lost;
    if (share <= 0.0F) return;
    // c = 1 - q / (D - k q), so c' = (1 - c)^2 / q. No choice is off by more than the detail.
    noise += std::min(4.0F * (s + q) * ratio * ratio * few, s + q - kept - lost);
  }
  // Signals that are not there come out as often below zero as above; noise is never undone so.
  [[nodiscard]] float all() const { return noise + std::max(0.0F, blur); }
};

}  // namespace

double Shared::squared_error_with(std::size_t point, double factor) const {
  const auto more = static_cast<float>(factor);
  Left left{rest[point] / more, 0.0F};
  for (std::size_t level = 0; level < share_levels; ++level) {
    const float least = level == 0 && !hidden.empty() ? hidden[point] / more : 0.0F;
    const float s = least > 0.0F ? std::max(signal[point][level], least) : signal[point][level];
    left.add(s, noise[point][level] / more, few[point][level]);
  }
  return double(left.all());
}

}  // namespace earthshine::raytrace
