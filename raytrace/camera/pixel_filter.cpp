// SPDX-License-Identifier: Apache-2.0
#include "raytrace/camera/pixel_filter.h"

namespace earthshine::raytrace {
namespace {

using scenes::FilterShape;

constexpr int inverse_steps = 1024;   // of the table of start values for Newton's method
constexpr int most_newton_steps = 8;  // one or two suffice except in the outermost interval
constexpr double newton_end = 1e-7;   // of the width; convergence is quadratic

// Integral of the filter up to x, for a width of 1; only smooth shapes. Not normalised.
double smooth_share(FilterShape shape, double x) {
  if (shape == FilterShape::Gaussian) return std::erf(6.0 * x / std::sqrt(2.0));
  const double t = 2.0 * base::pi * x;
  return 0.35875 * t + 0.48829 * std::sin(t) + 0.14128 / 2.0 * std::sin(2.0 * t) +
         0.01168 / 3.0 * std::sin(3.0 * t);
}

// Its derivative by x.
double smooth_density(FilterShape shape, double x) {
  if (shape == FilterShape::Gaussian) {
    return 6.0 * std::sqrt(2.0 / base::pi) * std::exp(-18.0 * x * x);
  }
  const double c = std::cos(2.0 * base::pi * x);
  return 2.0 * base::pi *
         (0.35875 + 0.48829 * c + 0.14128 * (2.0 * c * c - 1.0) +
          0.01168 * (4.0 * c * c - 3.0) * c);
}

// Positions of equal steps of the integral in the lower half.
std::vector<double> invert(FilterShape shape) {
  const double low = smooth_share(shape, -0.5);
  std::vector<double> inverse(inverse_steps + 1);
  for (int k = 0; k <= inverse_steps; ++k) {
    const double wanted = low * (1.0 - static_cast<double>(k) / inverse_steps);
    double a = -0.5, b = 0.0;
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = 0.5 * (a + b);
      (smooth_share(shape, middle) < wanted ? a : b) = middle;
    }
    inverse[static_cast<std::size_t>(k)] = 0.5 * (a + b);
  }
  inverse.front() = -0.5;
  inverse.back() = 0.0;
  return inverse;
}

}  // namespace

PixelFilter::PixelFilter(FilterShape shape, double width_px) : shape_(shape), width_px_(width_px) {
  if (shape == FilterShape::Gaussian || shape == FilterShape::BlackmanHarris) {
    inverse_ = invert(shape);
  }
}

double PixelFilter::at(double u) const {
  switch (shape_) {
    case FilterShape::Box:
      return (u - 0.5) * width_px_;
    case FilterShape::Triangle:
      return 0.5 * width_px_ *
             (u < 0.5 ? std::sqrt(2.0 * u) - 1.0 : 1.0 - std::sqrt(2.0 * (1.0 - u)));
    case FilterShape::Gaussian:
    case FilterShape::BlackmanHarris:
      break;
  }
  // The filter is symmetric: the upper half mirrors the lower one.
  const double lower = std::clamp(std::min(u, 1.0 - u), 0.0, 0.5);
  const double place = 2.0 * lower * inverse_steps;
  const auto cell = static_cast<std::size_t>(std::min(place, inverse_steps - 1.0));
  const double low = inverse_[cell], high = inverse_[cell + 1];
  const double wanted = smooth_share(shape_, -0.5) * (1.0 - 2.0 * lower);
  double x = low + (place - static_cast<double>(cell)) * (high - low);
  for (int k = 0; k < most_newton_steps; ++k) {
    const double step = (wanted - smooth_share(shape_, x)) / smooth_density(shape_, x);
    x = std::clamp(x + step, low, high);
    if (std::fabs(step) < newton_end) break;
  }
  return (u < 0.5 ? width_px_ : -width_px_) * x;
}

double PixelFilter::density_at(double x) const {
  const double at = std::abs(x) / width_px_;
  if (at > 0.5) return 0.0;
  switch (shape_) {
    case FilterShape::Box:
      return 1.0 / width_px_;
    case FilterShape::Triangle:
      return 2.0 * (1.0 - 2.0 * at) / width_px_;
    case FilterShape::Gaussian:
    case FilterShape::BlackmanHarris:
      break;
  }
  return smooth_density(shape_, at) / (-2.0 * smooth_share(shape_, -0.5) * width_px_);
}

}  // namespace earthshine::raytrace
