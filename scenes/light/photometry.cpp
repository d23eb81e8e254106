// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/photometry.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace earthshine::scenes {
namespace {

// The interval of an increasing list that contains x, which must be in its range.
std::size_t interval(const std::vector<double>& list, double x) {
  const auto above = std::upper_bound(list.begin() + 1, list.end() - 1, x);
  return static_cast<std::size_t>(above - list.begin()) - 1;
}

// Angle between a and b at which the integral of (at_a + slope (t - a)) sin t reaches `share` of
// its total: Newton's method with bisection as a safeguard.
double invert_band(double a, double b, double at_a, double at_b, double share) {
  const double slope = (at_b - at_a) / (b - a);
  const auto integral = [&](double t) {
    return at_a * (std::cos(a) - std::cos(t)) +
           slope * (std::sin(t) - std::sin(a) - (t - a) * std::cos(t));
  };
  const double wanted = share * integral(b);
  double low = a, high = b, t = 0.5 * (a + b);
  for (int step = 0; step < 60 && high - low > 1e-13; ++step) {
    const double excess = integral(t) - wanted;
    (excess > 0.0 ? high : low) = t;
    const double density = (at_a + slope * (t - a)) * std::sin(t);
    const double next = density > 0.0 ? t - excess / density : low;
    const double moved = next > low && next < high ? next : 0.5 * (low + high);
    const bool settled = std::abs(moved - t) < 1e-12;
    t = moved;
    if (settled) break;
  }
  return t;
}

}  // namespace

Photometry::Photometry(std::vector<double> vertical_deg, std::vector<double> horizontal_deg,
                       std::vector<double> candela)
    : vertical_(std::move(vertical_deg)),
      horizontal_(std::move(horizontal_deg)),
      value_(std::move(candela)) {
  for (double& angle : vertical_) angle = base::radians(angle);
  for (double& angle : horizontal_) angle = base::radians(angle);
  peak_cd_ = *std::max_element(value_.begin(), value_.end());
  for (double& value : value_) value /= peak_cd_;
  add_up();
}

void Photometry::add_up() {
  const std::size_t rows = vertical_.size(), planes = horizontal_.size();
  for (std::size_t row = 0; row + 1 < rows; ++row) {
    const double a = vertical_[row], b = vertical_[row + 1];
    const double mean_cosine = std::cos(0.5 * (a + b)) * std::sin(0.5 * (b - a)) / (0.5 * (b - a));
    double flux = 0.0;
    for (std::size_t k = 0; k < planes; ++k) {
      const double per_rad =
          at(k, row) * (std::cos(a) - mean_cosine) + at(k, row + 1) * (mean_cosine - std::cos(b));
      band_per_rad_.push_back(std::max(0.0, per_rad));  // rounding dominates very thin bands
      if (k > 0) {
        const double both = band_per_rad_.back() + band_per_rad_[band_per_rad_.size() - 2];
        flux += 0.5 * both * (horizontal_[k] - horizontal_[k - 1]);
        is_round_ = is_round_ && at(k, row) == at(0, row) && at(k, row + 1) == at(0, row + 1);
      }
      flux_to_plane_.push_back(flux);
    }
    solid_angle_sr_ += flux;
    flux_to_band_.push_back(solid_angle_sr_);
  }
}

double Photometry::relative(double theta_rad, double phi_rad) const {
  // Rounding may put a direction at the edge of the table slightly outside.
  constexpr double rounding = 1e-9;
  if (theta_rad < vertical_.front() - rounding || theta_rad > vertical_.back() + rounding) {
    return 0.0;
  }
  const double theta = std::clamp(theta_rad, vertical_.front(), vertical_.back());
  const std::size_t row = interval(vertical_, theta);
  const double y = (theta - vertical_[row]) / (vertical_[row + 1] - vertical_[row]);
  if (is_round_) return (1.0 - y) * at(0, row) + y * at(0, row + 1);
  constexpr double full_circle = 2.0 * base::pi;
  double from_first = phi_rad - horizontal_.front();
  from_first -= full_circle * std::floor(from_first / full_circle);
  const double phi = std::min(horizontal_.front() + from_first, horizontal_.back());
  const std::size_t k = interval(horizontal_, phi);
  const double x = (phi - horizontal_[k]) / (horizontal_[k + 1] - horizontal_[k]);
  return (1.0 - x) * ((1.0 - y) * at(k, row) + y * at(k, row + 1)) +
         x * ((1.0 - y) * at(k + 1, row) + y * at(k + 1, row + 1));
}

Photometry::Angles Photometry::sample(double x, double y) const {
  const double wanted = x * solid_angle_sr_;
  const auto band = std::upper_bound(flux_to_band_.begin(), flux_to_band_.end() - 1, wanted);
  const auto row = static_cast<std::size_t>(band - flux_to_band_.begin());
  const double below = row == 0 ? 0.0 : flux_to_band_[row - 1];
  const double in_band = flux_to_band_[row] - below;
  const double share = in_band > 0.0 ? std::clamp((wanted - below) / in_band, 0.0, 1.0) : 0.0;

  const std::size_t planes = horizontal_.size();
  const double* flux_to = &flux_to_plane_[row * planes];
  const double* per_rad = &band_per_rad_[row * planes];
  const double wanted_in_band = y * in_band;
  const double* next = std::upper_bound(flux_to + 1, flux_to + planes - 1, wanted_in_band);
  const auto k = static_cast<std::size_t>(next - flux_to) - 1;
  const double width = horizontal_[k + 1] - horizontal_[k];
  const double in_cell = flux_to[k + 1] - flux_to[k];
  const double z =
      in_cell > 0.0 ? std::clamp((wanted_in_band - flux_to[k]) / in_cell, 0.0, 1.0) : 0.0;
  // The flux per radian is linear between two planes; its integral is inverted without
  // cancellation.
  const double g0 = per_rad[k], g1 = per_rad[k + 1];
  const double root = std::sqrt((1.0 - z) * g0 * g0 + z * g1 * g1);
  const double s = g0 + root > 0.0 ? std::min(1.0, z * (g0 + g1) / (g0 + root)) : 0.0;

  const double at_a = (1.0 - s) * at(k, row) + s * at(k + 1, row);
  const double at_b = (1.0 - s) * at(k, row + 1) + s * at(k + 1, row + 1);
  return {invert_band(vertical_[row], vertical_[row + 1], at_a, at_b, share),
          horizontal_[k] + s * width};
}

}  // namespace earthshine::scenes
