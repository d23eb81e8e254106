// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

namespace earthshine::degrade {
namespace {

constexpr double exact_poisson_below = 64.0;

// Sources of independent random numbers within a stage.
enum class Part : std::uint64_t { Photons = 1, Pattern, Amplifier, BlackPattern };

base::Key plane_key(const NoiseKey& key, base::Stream stream, std::uint64_t frame, Part part,
                    std::size_t plane) {
  return base::Key(key.seed, stream, frame)
      .with(key.view)
      .with(static_cast<std::uint64_t>(part))
      .with(plane);
}

// A pixel's counter consists of its column and row, so that it does not depend on the picture's
// size.
std::uint64_t counter(std::size_t index, int columns) {
  const std::uint64_t width = static_cast<std::uint64_t>(columns);
  return (index / width) << 32 | index % width;
}

double normal(base::Key key, std::uint64_t n) {
  return normal_quantile(std::max(base::uniform(key, n), 0x1p-54));
}

template <class F>
Picture for_each_pixel(Picture picture, F f) {
  for_each_run(picture, [&](std::size_t plane, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      float& value = picture.planes[plane][i];
      value = static_cast<float>(f(static_cast<double>(value), plane, counter(i, picture.columns)));
    }
  });
  return picture;
}

template <std::size_t N>
double polynomial(const std::array<double, N>& coefficients, double x) {
  double sum = 0.0;
  for (double c : coefficients) sum = sum * x + c;
  return sum;
}

}  // namespace

NoiseLaw noise_law(const CctvCamera& camera) {
  const double inverse_snr2 = std::pow(10.0, -camera.snr_db / 10.0);
  const double n = camera.electrons_at_white;
  const auto square = [](double x) { return x * x; };
  switch (camera.noise) {
    case NoiseMode::Report:
      return {.c = inverse_snr2};
    case NoiseMode::Spec:
      return {.a = inverse_snr2};
    case NoiseMode::Photon:
      return {.a = square(camera.read_electrons / n),
              .b = camera.excess_noise / n,
              .c = square(camera.prnu_percent / 100.0),
              .c_is_fixed_pattern = true,
              .dark = camera.excess_noise * camera.dark_electrons / square(n),
              .black_pattern = square(camera.dsnu_percent / 100.0)};
    case NoiseMode::Law:
      return {.a = camera.noise_a, .b = camera.noise_b, .c = camera.noise_c};
    case NoiseMode::None:
      break;
  }
  return {};
}

NoiseFigures noise_figures(const CctvCamera& camera) {
  NoiseFigures figures;
  figures.law = noise_law(camera);
  const auto decibel = [](double variance) {
    return variance > 0.0 ? -10.0 * std::log10(variance) : std::numeric_limits<double>::infinity();
  };
  figures.snr_db = decibel(figures.law.variance(1.0));
  figures.floor_db = decibel(figures.law.at_black());
  figures.percent_of_signal = 100.0 * std::sqrt(figures.law.c);
  figures.electrons_at_white =
      figures.law.b > 0.0 ? 1.0 / figures.law.b : std::numeric_limits<double>::infinity();
  return figures;
}

std::string describe_noise(const CctvCamera& camera) {
  const NoiseFigures figures = noise_figures(camera);
  if (figures.law.variance(1.0) == 0.0) return "no noise";
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(4);
  text << "a = " << figures.law.at_black() << ", b = " << figures.law.b << ", c = " << figures.law.c
       << ": SNR " << figures.snr_db << " dB at white";
  if (figures.law.at_black() > 0.0)
    text << ", white over black noise " << figures.floor_db << " dB";
  if (figures.law.b > 0.0) text << ", " << figures.electrons_at_white << " electrons at white";
  if (figures.law.c > 0.0) text << ", " << figures.percent_of_signal << " % of the signal";
  return text.str();
}

namespace {

// One key per plane.
std::vector<base::Key> plane_keys(const Picture& picture, const NoiseKey& key, base::Stream stream,
                                  std::uint64_t frame, Part part) {
  std::vector<base::Key> keys;
  for (std::size_t plane = 0; plane < picture.planes.size(); ++plane) {
    keys.push_back(plane_key(key, stream, frame, part, plane));
  }
  return keys;
}

// S <- S + sigma(S) normal.
template <class Sigma>
Picture add_normal(Picture signal, const std::vector<base::Key>& keys, Sigma sigma) {
  return for_each_pixel(std::move(signal), [&](double s, std::size_t plane, std::uint64_t n) {
    return s + sigma(s) * normal(keys[plane], n);
  });
}

// A fixed pattern belongs to the camera: its key has no frame number.
constexpr std::uint64_t every_frame = 0;

}  // namespace

Picture differ_in_sensitivity(Picture signal, const NoiseLaw& law, const NoiseKey& key) {
  if (!law.c_is_fixed_pattern || !(law.c > 0.0)) return signal;
  const double relative = std::sqrt(law.c);
  const auto keys = plane_keys(signal, key, base::Stream::ShotNoise, every_frame, Part::Pattern);
  return add_normal(std::move(signal), keys, [&](double s) { return s * relative; });
}

Picture add_grain(Picture signal, const NoiseLaw& law, const NoiseKey& key) {
  const auto photons = plane_keys(signal, key, base::Stream::ShotNoise, key.frame, Part::Photons);
  const auto gauss = plane_keys(signal, key, base::Stream::ShotNoise, key.frame, Part::Pattern);
  const double relative = law.c_is_fixed_pattern ? 0.0 : std::sqrt(law.c);
  // Signal per count. Photon noise always has b > 0; other forms have no dark counts.
  const double per_count = law.b;
  const double dark_counts = per_count > 0.0 ? law.dark / (per_count * per_count) : 0.0;
  return for_each_pixel(std::move(signal), [&](double s, std::size_t plane, std::uint64_t n) {
    double noisy = s;
    const double light = std::max(s, 0.0);
    if (per_count > 0.0) {
      const double counts = light / per_count + dark_counts;
      noisy =
          per_count * (poisson_quantile(counts, base::uniform(photons[plane], n)) - dark_counts);
    }
    if (relative > 0.0) noisy += light * relative * normal(gauss[plane], n);
    return noisy;
  });
}

Picture add_signal_noise(Picture signal, const NoiseLaw& law, const NoiseKey& key) {
  return add_grain(differ_in_sensitivity(std::move(signal), law, key), law, key);
}

Picture add_read_noise(Picture signal, const NoiseLaw& law, const NoiseKey& key) {
  if (law.a > 0.0) {
    const auto keys = plane_keys(signal, key, base::Stream::ReadNoise, key.frame, Part::Amplifier);
    const double sigma = std::sqrt(law.a);
    signal = add_normal(std::move(signal), keys, [&](double) { return sigma; });
  }
  if (law.black_pattern > 0.0) {
    const auto keys =
        plane_keys(signal, key, base::Stream::ReadNoise, every_frame, Part::BlackPattern);
    const double sigma = std::sqrt(law.black_pattern);
    signal = add_normal(std::move(signal), keys, [&](double) { return sigma; });
  }
  return signal;
}

double normal_quantile(double p) {
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    static constexpr std::array<double, 8> num = {
        2509.0809287301226727, 33430.575583588128105, 67265.770927008700853, 45921.953931549871457,
        13731.693765509461125, 1971.5909503065514427, 133.14166789178437745, 3.387132872796366608};
    static constexpr std::array<double, 8> den = {
        5226.495278852545925,  28729.085735721942674, 39307.89580009271061,  21213.794301586595867,
        5394.1960214247511077, 687.1870074920579083,  42.313330701600911252, 1.0};
    const double r = 0.180625 - q * q;
    return q * polynomial(num, r) / polynomial(den, r);
  }
  double r = std::sqrt(-std::log(std::min(p, 1.0 - p)));
  double x = 0.0;
  if (r <= 5.0) {
    static constexpr std::array<double, 8> num = {
        7.7454501427834140764e-4, 0.0227238449892691845833, 0.24178072517745061177,
        1.27045825245236838258,   3.64784832476320460504,   5.7694972214606914055,
        4.6303378461565452959,    1.42343711074968357734};
    static constexpr std::array<double, 8> den = {
        1.05075007164441684324e-9, 5.475938084995344946e-4,
        0.0151986665636164571966,  0.14810397642748007459,
        0.68976733498510000455,    1.6763848301838038494,
        2.05319162663775882187,    1.0};
    r -= 1.6;
    x = polynomial(num, r) / polynomial(den, r);
  } else {
    static constexpr std::array<double, 8> num = {
        2.01033439929228813265e-7, 2.71155556874348757815e-5, 0.0012426609473880784386,
        0.026532189526576123093,   0.29656057182850489123,    1.7848265399172913358,
        5.4637849111641143699,     6.6579046435011037772};
    static constexpr std::array<double, 8> den = {
        2.04426310338993978564e-15, 1.4215117583164458887e-7,
        1.8463183175100546818e-5,   7.868691311456132591e-4,
        0.0148753612908506148525,   0.13692988092273580531,
        0.59983220655588793769,     1.0};
    r -= 5.0;
    x = polynomial(num, r) / polynomial(den, r);
  }
  return q < 0.0 ? -x : x;
}

double poisson_quantile(double mean, double uniform) {
  if (!(mean > 0.0)) return 0.0;
  if (mean < exact_poisson_below) {
    // Inversion: the first count whose cumulative probability exceeds the uniform number. The limit
    // of the loop is far beyond any count that 53 bits can reach.
    double probability = std::exp(-mean), cumulative = probability;
    int count = 0;
    while (uniform >= cumulative && count < 400) {
      ++count;
      probability *= mean / count;
      cumulative += probability;
    }
    return count;
  }
  const double z = normal_quantile(std::max(uniform, 0x1p-54));
  const double root = std::sqrt(mean);
  // z + k3 (z^2-1)/6 + k4 (z^3-3z)/24 - k3^2 (2z^3-5z)/36 with k3 = 1/root and k4 = 1/mean.
  return mean + root * z + (z * z - 1.0) / 6.0 + (z - z * z * z) / (72.0 * root);
}

}  // namespace earthshine::degrade
