// SPDX-License-Identifier: Apache-2.0
#include "raytrace/share/signals.h"

#include <bit>

#include "base/numbers/random.h"
#include "base/parallel.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t points_a_chunk = 1024;

// Sums over all windows of the picture.
struct Spread {
  double count = 0.0, s = 0.0, q = 0.0;
  double ratio = 0.0, squared = 0.0, chance = 0.0;  // s / q, its square, and its variance by chance
  // by_chance: variance of the ratio.
  void add(float signal, float noise, float by_chance) {
    if (noise <= 0.0F) return;
    const double of_both = double(signal) / double(noise);
    *this += {1.0,     double(signal),    double(noise),
              of_both, of_both * of_both, std::min(2.0, double(by_chance))};
  }
  Spread& operator+=(const Spread& other) {
    count += other.count, s += other.s, q += other.q;
    ratio += other.ratio, squared += other.squared, chance += other.chance;
    return *this;
  }
  // The ratio of the means: the mean of the ratios is too large if few details give q.
  [[nodiscard]] float mean() const { return q > 0.0 ? static_cast<float>(s / q) : 0.0F; }
  // The fraction of the variance of s / q that is due to chance.
  [[nodiscard]] float chance_share() const {
    if (count < 2.0) return 0.0F;
    const double variance = squared / count - ratio / count * (ratio / count);
    return variance * count > chance ? static_cast<float>(chance / count / variance) : 1.0F;
  }
};

}  // namespace

std::vector<std::uint8_t> draw_signs(const Neighbours& neighbours, const Estimate& estimate) {
  const std::vector<float>& samples = estimate.samples;
  const std::size_t points = neighbours.count();
  std::vector<std::uint8_t> signs(points);
  const auto for_all = [&](const auto& visit) {
    base::parallel_chunks(points, points_a_chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) visit(p);
    });
  };
  for_all([&](std::size_t p) {
    const auto by_chance = std::bit_cast<std::uint32_t>(estimate.variance[p]);
    signs[p] = static_cast<std::uint8_t>(base::mix64(p ^ base::mix64(by_chance)));
  });
  const auto sampled = [](float n) { return n > 0.0F; };
  if (std::all_of(samples.begin(), samples.begin() + std::ptrdiff_t(points), sampled)) return signs;
  constexpr std::size_t fields = tuning::noise_fields + tuning::scatter_fields;
  Neighbours::Planes own = neighbours.planes(fields), around;
  for_all([&](std::size_t p) {
    for (std::size_t k = 0; k < fields; ++k) own[k][p] = sign_of(signs[p], k);
  });
  neighbours.blur(0, own, &samples, around);
  for_all([&](std::size_t p) {
    if (sampled(samples[p])) return;
    signs[p] = 0;
    for (std::size_t k = 0; k < fields; ++k) {
      if (around[k][p] < 0.0F) signs[p] |= static_cast<std::uint8_t>(1U << k);
    }
  });
  return signs;
}

// Until the last loop, noise is <n^2 / e> over <1 / e>, and inverse_dof the variance of s / q.
void find_signals(std::size_t level, const Neighbours::Planes& squares,
                  const std::vector<float>& expected, Shared& shared) {
  const std::size_t points = expected.size();
  float* const signal = shared.signal[level].data();
  float* const noise = shared.noise[level].data();
  float* const inverse_dof = shared.inverse_dof[level].data();
  const float *energy = squares[Energy].data(), *of_noise = squares[NoiseSquare].data(),
              *weight = squares[Weight].data(), *e = expected.data();
  const Spread all =
      base::ordered_sum(points, points_a_chunk, Spread(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
          const float scale = weight[p] > 0.0F ? 1.0F / weight[p] : 0.0F;
          signal[p] = (energy[p] - of_noise[p]) * scale;
          noise[p] = of_noise[p] * scale;
          inverse_dof[p] = 0.0F;
        }
        for (std::size_t k = 0; k < tuning::scatter_fields; ++k) {
          const float* const scatter = squares[Scatter + k].data();
          for (std::size_t p = begin; p < end; ++p) {
            const float off = noise[p] > 0.0F ? scatter[p] / of_noise[p] : 0.0F;
            inverse_dof[p] += off * off / float(tuning::scatter_fields);
          }
        }
        Spread part;
        for (std::size_t p = begin; p < end; ++p) {
          if (e[p] > 0.0F) part.add(signal[p], noise[p], inverse_dof[p]);
        }
        return part;
      });
  const float mean = all.mean(), by_chance = all.chance_share();
  base::parallel_chunks(points, points_a_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const float s = signal[p] + by_chance * (mean * noise[p] - signal[p]);
      const float q = e[p] > 0.0F ? e[p] * of_noise[p] : certain * std::max(0.0F, s);
      const float over = q > 0.0F ? noise[p] / q : 0.0F;
      signal[p] = s;
      noise[p] = q;
      // The mean of N normal squares has the relative variance 2 / N.
      inverse_dof[p] = std::min(1.0F, 0.5F * inverse_dof[p] * over * over);
    }
  });
}

}  // namespace earthshine::raytrace
