// SPDX-License-Identifier: Apache-2.0
#include "raytrace/share/signals.h"

#include "base/numbers/random.h"
#include "base/parallel.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t points_at_once = 1024;

// Of one point's window.
struct Found {
  float s = 0.0F, q = 0.0F;  // of a detail with the noise that is expected on the average there
  float chance = 0.0F;       // variance of s / q
};

Found found_at(const Neighbours::Planes& squares, std::size_t p) {
  const float noise = squares[NoiseSquare][p], weight = squares[Weight][p];
  if (weight <= 0.0F) return {};
  Found found{(squares[Energy][p] - noise) / weight, noise / weight, 0.0F};
  for (std::size_t k = 0; noise > 0.0F && k < scatter_fields; ++k) {
    const float off = squares[Scatter + k][p] / noise;
    found.chance += off * off / float(scatter_fields);
  }
  return found;
}

// Of all windows of the picture.
struct Spread {
  double count = 0.0, s = 0.0, q = 0.0;
  double ratio = 0.0, squared = 0.0, chance = 0.0;  // s / q, its square, and its variance by chance
  void add(const Found& found) {
    if (found.q <= 0.0F) return;
    const double of_both = double(found.s) / double(found.q);
    *this += {1.0,     double(found.s),   double(found.q),
              of_both, of_both * of_both, std::min(2.0, double(found.chance))};
  }
  Spread& operator+=(const Spread& other) {
    count += other.count, s += other.s, q += other.q;
    ratio += other.ratio, squared += other.squared, chance += other.chance;
    return *this;
  }
  // Not the mean of the ratios: with q known by few details that is too large.
  [[nodiscard]] float mean() const { return q > 0.0 ? static_cast<float>(s / q) : 0.0F; }
  // Of what a signal is off the mean, as much as is chance.
  [[nodiscard]] float chance_share() const {
    if (count < 2.0) return 0.0F;
    const double variance = squared / count - ratio / count * (ratio / count);
    return variance * count > chance ? static_cast<float>(chance / count / variance) : 1.0F;
  }
};

}  // namespace

std::vector<std::uint8_t> draw_signs(const Neighbours& neighbours,
                                     const std::vector<float>& samples) {
  const std::size_t points = neighbours.count();
  std::vector<std::uint8_t> signs(points);
  for (std::size_t p = 0; p < points; ++p) signs[p] = static_cast<std::uint8_t>(base::mix64(p));
  const auto sampled = [](float n) { return n > 0.0F; };
  if (std::all_of(samples.begin(), samples.begin() + std::ptrdiff_t(points), sampled)) return signs;
  constexpr std::size_t fields = noise_fields + scatter_fields;
  Neighbours::Planes own(fields, std::vector<float>(points)), around;
  for (std::size_t k = 0; k < fields; ++k) {
    for (std::size_t p = 0; p < points; ++p) own[k][p] = sign_of(signs[p], k);
  }
  neighbours.blur(0, own, &samples, around);
  for (std::size_t p = 0; p < points; ++p) {
    if (sampled(samples[p])) continue;
    signs[p] = 0;
    for (std::size_t k = 0; k < fields; ++k) {
      if (around[k][p] < 0.0F) signs[p] |= static_cast<std::uint8_t>(1U << k);
    }
  }
  return signs;
}

void find_signals(std::size_t level, const Neighbours::Planes& squares,
                  const std::vector<float>& expected, Shared& shared) {
  const std::size_t points = expected.size();
  const Spread all =
      base::ordered_sum(points, points_at_once, Spread(), [&](std::size_t begin, std::size_t end) {
        Spread part;
        for (std::size_t p = begin; p < end; ++p) {
          if (expected[p] > 0.0F) part.add(found_at(squares, p));
        }
        return part;
      });
  const float mean = all.mean(), by_chance = all.chance_share();
  base::parallel_chunks(points, points_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Found found = found_at(squares, p);
      const float s = found.s + by_chance * (mean * found.q - found.s);
      const float q =
          expected[p] > 0.0F ? expected[p] * squares[NoiseSquare][p] : certain * std::max(0.0F, s);
      const float over = q > 0.0F ? found.q / q : 0.0F;
      shared.signal[p][level] = s;
      shared.noise[p][level] = q;
      // The mean of N normal squares has the relative variance 2 / N.
      shared.few[p][level] = std::min(1.0F, 0.5F * found.chance * over * over);
    }
  });
}

}  // namespace earthshine::raytrace
