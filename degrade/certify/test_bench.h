// SPDX-License-Identifier: Apache-2.0
// Shared by the tests of the certificate: the camera on the bench, charts of known light, result
// rows.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "degrade/certify/block_statistics.h"
#include "degrade/certify/certificate.h"
#include "degrade/parts/transfer_law.h"

namespace earthshine::degrade {

// Stages by kind, to switch them off while others are measured.
using Names = std::vector<std::string>;
[[nodiscard]] Names operator+(Names a, const Names& b);
namespace stage {
extern const Names noise;    // signal noise and read noise
extern const Names uneven;   // vary over a flat field
extern const Names spatial;  // spread light over resels
extern const Names limits;   // limit a linear signal: saturation, black, white
extern const Names coding;   // gamma and quantisation
extern const Names screen;   // all stages after the line
}  // namespace stage

// Vertical field of view of the charts.
inline constexpr double bench_fov_deg = 40.0;

class Bench {
 public:
  Bench(const CctvCamera& camera, const Monitor& monitor, const CertifyOptions& options);

  [[nodiscard]] const CctvCamera& camera() const { return camera_; }
  // The camera with a fixed f-number of its range and gain 1, so that its signal is proportional to
  // light.
  [[nodiscard]] const CctvCamera& held() const { return held_; }
  [[nodiscard]] const Monitor& monitor() const { return monitor_; }
  // Law of its noise on the line.
  [[nodiscard]] const LineNoise& noise() const { return noise_; }
  [[nodiscard]] int columns() const { return monitor_.columns; }
  [[nodiscard]] int rows() const { return monitor_.rows; }

  // Luminance that gives signal 1 in the held camera, cd/m^2.
  [[nodiscard]] double white_luminance() const;
  // A chart with one pixel per resel, or `fine` x `fine` pixels. f(x, y), with x and y in resels,
  // is the signal in the held camera.
  template <class F>
  [[nodiscard]] base::Image chart(F f, int fine = 1) const;
  [[nodiscard]] base::Image flat(double signal) const;

  [[nodiscard]] Result run(const base::Image& chart, const CctvCamera& camera,
                           const Options& options) const;
  // Frames of different numbers share fixed patterns only.
  [[nodiscard]] Options options(Names off, std::uint64_t frame = 0) const;
  // Linear signal of the held camera with noise, without limits, coding and unevenness.
  [[nodiscard]] Picture linear(const base::Image& chart, std::uint64_t frame,
                               const Names& off = {}) const;
  [[nodiscard]] Picture linear(const base::Image& chart, const Options& options) const;

  // Blocks for statistics: inside the margin and larger than the grain.
  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }
  [[nodiscard]] int margin() const { return margin_; }

 private:
  CctvCamera camera_, held_;
  Monitor monitor_;
  CertifyOptions options_;
  LineNoise noise_;
  int margin_ = 0;
  std::vector<Block> blocks_;
};

[[nodiscard]] Picture to_picture(const base::Image& image);

inline constexpr double chain_rounding = 1e-5;  // rounding of single precision over the whole chain

// Result rows. A number that is not finite fails.
[[nodiscard]] CertificateRow within(std::string_view name, std::string_view unit, double measured,
                                    double expected, double tolerance, std::string_view law);
// Tolerance: four standard errors plus `rounding` of single precision.
[[nodiscard]] CertificateRow within_errors(std::string_view name, std::string_view unit,
                                           const Estimate& measured, double expected,
                                           std::string_view law, double rounding = 0.0);
[[nodiscard]] CertificateRow absent(std::string_view name, std::string_view unit,
                                    std::string_view why);

// The value that is farther from 0; NaN is farthest.
[[nodiscard]] double farther(double a, double b);
// Largest |a - b|; NaN if either plane contains one.
[[nodiscard]] double largest_difference(const Plane& a, const Plane& b);

// Groups of rows.
using Rows = std::vector<CertificateRow>;
[[nodiscard]] Rows photon_transfer_rows(const Bench& bench, std::vector<TransferPoint>& points);
[[nodiscard]] Rows optics_rows(const Bench& bench);
[[nodiscard]] Rows electronics_rows(const Bench& bench);
[[nodiscard]] Rows edge_rows(const Bench& bench, std::vector<SharpnessPoint>& points);
[[nodiscard]] Rows iris_rows(const Bench& bench);
[[nodiscard]] Rows raster_rows(const Bench& bench);
[[nodiscard]] Rows repeatability_rows(const Bench& bench);

template <class F>
base::Image Bench::chart(F f, int fine) const {
  base::Image image{columns() * fine, rows() * fine, {}};
  std::vector<float>& values = image.add("Y");
  const double white = white_luminance();
  std::size_t i = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      values[i++] = static_cast<float>(white * f((x + 0.5) / fine, (y + 0.5) / fine));
    }
  }
  return image;
}

}  // namespace earthshine::degrade
