// SPDX-License-Identifier: Apache-2.0
// Measured luminous intensity on a grid of directions, interpolated bilinearly in the angles.
#pragma once

#include <cstddef>
#include <vector>

namespace earthshine::scenes {

// Angles as in photometry of type C (IES LM-63, CIE 102): the vertical angle theta from the
// luminaire's axis, the horizontal angle phi about it. Values are relative to the table's maximum.
// The intensity is 0 at theta outside the table.
class Photometry {
 public:
  // vertical_deg: strictly increasing in [0, 180], at least two. horizontal_deg: strictly
  // increasing, from first to first + 360, at least two. candela[plane * vertical_deg.size() +
  // row]: finite, not negative, at least one positive.
  Photometry(std::vector<double> vertical_deg, std::vector<double> horizontal_deg,
             std::vector<double> candela);

  [[nodiscard]] bool operator==(const Photometry&) const = default;

  [[nodiscard]] double peak_cd() const { return peak_cd_; }
  // Flux of a luminaire with a maximum of 1 cd: the integral of relative(theta, phi) over all
  // directions, exact for the interpolated table. For theta between a and b = a + 2 h, with m = a +
  // h and S = cos m sin h / h: row a has the weight cos a - S, row b the weight S - cos b.
  [[nodiscard]] double solid_angle_sr() const { return solid_angle_sr_; }

  [[nodiscard]] double relative(double theta_rad, double phi_rad) const;

  // A direction with density relative / solid_angle_sr, for x and y uniform in [0, 1).
  struct Angles {
    double theta_rad, phi_rad;
  };
  [[nodiscard]] Angles sample(double x, double y) const;

  [[nodiscard]] const std::vector<double>& vertical_rad() const { return vertical_; }
  [[nodiscard]] const std::vector<double>& horizontal_rad() const { return horizontal_; }
  [[nodiscard]] const std::vector<double>& values() const { return value_; }
  [[nodiscard]] bool is_round() const { return is_round_; }  // independent of phi

 private:
  [[nodiscard]] double at(std::size_t plane, std::size_t row) const {
    return value_[plane * vertical_.size() + row];
  }
  void add_up();

  std::vector<double> vertical_, horizontal_;  // rad
  std::vector<double> value_;                  // candela / peak
  double peak_cd_ = 0.0;
  double solid_angle_sr_ = 0.0;
  bool is_round_ = true;
  // For each band between two vertical angles: flux per radian of phi in each plane; cumulative
  // flux from the first plane to each plane, and from the first band to the end of each band.
  std::vector<double> band_per_rad_, flux_to_plane_, flux_to_band_;
};

}  // namespace earthshine::scenes
