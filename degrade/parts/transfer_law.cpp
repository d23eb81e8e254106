// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/transfer_law.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/units.h"

namespace earthshine::degrade {
namespace {

// The discrete Gaussian's transfer (Lindeberg 1990): exp(-sigma^2 (1 - cos 2 pi f)).
double gaussian(double sigma, double f) {
  return std::exp(-sigma * sigma * (1.0 - std::cos(2.0 * base::pi * f)));
}

// RS-170: 52.66 us of picture per line, over all columns of the screen.
double cycles_per_resel(double mhz, const Monitor& monitor) {
  return mhz * 52.66 / monitor.columns;
}

// 1 / sqrt 2 at B. From the Nyquist frequency of the resels on, the variance of the continuous
// Gaussian.
double bandwidth(double mhz, const Monitor& monitor, double f) {
  if (mhz == 0.0) return 1.0;
  const double b = cycles_per_resel(mhz, monitor);
  const double variance = b < 0.5 ? 0.5 * std::log(2.0) / (1.0 - std::cos(2.0 * base::pi * b))
                                  : std::log(2.0) / std::pow(2.0 * base::pi * b, 2.0);
  return gaussian(std::sqrt(variance), f);
}

// The stages that blur or sharpen, in order.
struct TransferRow {
  bool picture, light_noise, amplifier_noise;  // signals that pass it
  double (*transfer)(const CctvCamera&, const Monitor&, Axis, double frequency);
};
constexpr TransferRow table[] = {
    // lens-spread
    {true, false, false,
     [](const CctvCamera& camera, const Monitor&, Axis, double f) {
       return gaussian(camera.lens_blur, f);
     }},
    // blur
    {true, true, false,
     [](const CctvCamera& camera, const Monitor&, Axis axis, double f) {
       return gaussian(axis == Axis::Along ? camera.blur_h : camera.blur_v, f);
     }},
    // bandwidth
    {true, true, true,
     [](const CctvCamera& camera, const Monitor& monitor, Axis axis, double f) {
       if (axis == Axis::Across) return 1.0;
       return bandwidth(camera.bandwidth_mhz, monitor, f) *
              (1.0 + camera.aperture_correction * (1.0 - std::cos(2.0 * base::pi * f)));
     }},
};

bool passes(const TransferRow& row, Travels what) {
  switch (what) {
    case Travels::Picture:
      return row.picture;
    case Travels::LightNoise:
      return row.light_noise;
    case Travels::AmplifierNoise:
      break;
  }
  return row.amplifier_noise;
}

double covariance_of(const std::vector<double>& h, int shift) {
  double sum = 0.0;
  const int size = static_cast<int>(h.size());
  for (int i = 0; i < size; ++i) {
    const int j = i + shift;
    if (j >= 0 && j < size) sum += h[static_cast<std::size_t>(i)] * h[static_cast<std::size_t>(j)];
  }
  return sum;
}

}  // namespace

double transfer(const CctvCamera& camera, const Monitor& monitor, Travels what, Axis axis,
                double frequency) {
  double product = 1.0;
  for (const TransferRow& row : table) {
    if (passes(row, what)) product *= row.transfer(camera, monitor, axis, frequency);
  }
  return product;
}

std::vector<double> taps(const CctvCamera& camera, const Monitor& monitor, Travels what,
                         Axis axis) {
  // T is smooth and has the period 1, so that the trapezoidal rule gives its Fourier coefficients
  // exactly, except for those beyond `points`, which no blur here reaches.
  constexpr int points = 512;
  std::vector<double> spectrum;
  spectrum.reserve(points);
  for (int k = 0; k < points; ++k) {
    spectrum.push_back(transfer(camera, monitor, what, axis, static_cast<double>(k) / points));
  }
  std::vector<double> half;
  for (int n = 0; n < points / 2; ++n) {
    double sum = 0.0;
    for (int k = 0; k < points; ++k) {
      sum += spectrum[static_cast<std::size_t>(k)] *
             std::cos(2.0 * base::pi * (static_cast<double>(k) * n / points));
    }
    half.push_back(sum / points);
    // Two in succession, because sharpening may pass through zero.
    if (n > 1 && std::abs(half.back()) < 1e-9 && std::abs(half[half.size() - 2]) < 1e-9) break;
  }
  while (half.size() > 1 && std::abs(half.back()) < 1e-9) half.pop_back();
  std::vector<double> all(half.rbegin(), half.rend());
  all.insert(all.end(), half.begin() + 1, half.end());
  return all;
}

double gaussian_tap(double sigma, int n) {
  const int reach = static_cast<int>(std::ceil(12.0 * sigma)) + 12;
  if (std::abs(n) > reach) return 0.0;
  // Fourier coefficient of the transfer, by the trapezoidal rule over its period. Fewer points than
  // twice the reach would alias far taps.
  const int points = 4 * reach;
  double sum = 0.0;
  for (int k = 0; k < points; ++k) {
    const double f = static_cast<double>(k) / points;
    sum += gaussian(sigma, f) * std::cos(2.0 * base::pi * f * n);
  }
  return sum / points;
}

int Filter::radius() const {
  constexpr double least = 1e-5;
  std::size_t reach = 0;
  for (const std::vector<double>* h : {&along, &across}) {
    for (std::size_t n = 0; n <= h->size() / 2; ++n) {
      if (std::abs((*h)[n]) < least) continue;
      reach = std::max(reach, h->size() / 2 - n);
      break;
    }
  }
  return static_cast<int>(reach);
}

double Filter::power_sum(int p) const {
  const auto sum = [&](const std::vector<double>& h) {
    double total = 0.0;
    for (const double value : h) total += std::pow(value, p);
    return total;
  };
  return sum(along) * sum(across);
}

double Filter::covariance(int dx, int dy) const {
  return covariance_of(along, std::abs(dx)) * covariance_of(across, std::abs(dy));
}

Filter filter_of(const CctvCamera& camera, const Monitor& monitor, Travels what) {
  return {taps(camera, monitor, what, Axis::Along), taps(camera, monitor, what, Axis::Across)};
}

double edge_coverage(double angle, double x) {
  // The sum of two uniform variables of widths a and b < a. Its density is a trapezium of
  // height 1 / a, flat within (a - b) / 2 and zero beyond (a + b) / 2.
  const double c = std::abs(std::cos(angle)), s = std::abs(std::sin(angle));
  const double a = std::max(c, s), b = std::min(c, s);
  const double flat = 0.5 * (a - b), foot = 0.5 * (a + b), away = std::abs(x);
  double half = 0.5;
  if (away <= flat) {
    half = away / a;
  } else if (away < foot) {
    half = 0.5 - (foot - away) * (foot - away) / (2.0 * a * b);
  }
  return 0.5 + std::copysign(half, x);
}

double edge_modulation(const CctvCamera& camera, const Monitor& monitor, Axis axis, double angle,
                       double frequency) {
  const Axis other = axis == Axis::Along ? Axis::Across : Axis::Along;
  const double f = frequency * std::cos(angle), g = frequency * std::sin(angle);
  return transfer(camera, monitor, Travels::Picture, axis, f) *
         transfer(camera, monitor, Travels::Picture, other, g) * base::sinc(f) * base::sinc(g);
}

double edge_profile(const Filter& picture, Axis axis, double angle, double x) {
  const bool along = axis == Axis::Along;
  const std::vector<double>&main = along ? picture.along : picture.across,
        &other = along ? picture.across : picture.along;
  const auto middle = [](const std::vector<double>& h) {
    const std::size_t half = h.size() / 2;
    return static_cast<double>(half);
  };
  double sum = 0.0;
  for (std::size_t n = 0; n < main.size(); ++n) {
    for (std::size_t m = 0; m < other.size(); ++m) {
      const double at = x - (static_cast<double>(n) - middle(main)) * std::cos(angle) -
                        (static_cast<double>(m) - middle(other)) * std::sin(angle);
      sum += main[n] * other[m] * edge_coverage(angle, at);
    }
  }
  return sum;
}

double phosphor_edge(const Monitor& monitor, double x) {
  const double w = monitor.spread_width;
  switch (monitor.spread) {
    case Spread::None:
      return x < 0.0 ? 0.0 : 1.0;
    case Spread::Gaussian:
      // Full width at half maximum w = 2 sqrt(2 ln 2) s; the integral is Phi(x / s).
      return 0.5 * (1.0 + std::erf(x * 2.0 * std::sqrt(std::log(2.0)) / w));
    case Spread::Triangle: {
      const double u = std::clamp(x / w, -1.0, 1.0);
      return 0.5 + u - 0.5 * u * std::abs(u);
    }
    case Spread::Sinc:
      break;
  }
  constexpr double zeros = 8.0;
  const auto integral = [](double end) {
    constexpr int steps = 2048;
    double sum = 0.0;
    for (int k = 0; k <= steps; ++k) {
      const double u = end * k / steps;
      const double weight = k == 0 || k == steps ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0);
      sum += weight * base::sinc(u) * base::sinc(u / zeros);
    }
    return sum * end / (3.0 * steps);
  };
  static const double all = integral(zeros);
  const double part = integral(std::min(std::abs(x) / w, zeros));
  return 0.5 + std::copysign(0.5 * part / all, x);
}

}  // namespace earthshine::degrade
