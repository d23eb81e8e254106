// SPDX-License-Identifier: Apache-2.0
// What the certificate's tests share: the camera on the bench, charts of known light in front of
// it, rows of results.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "degrade/certify/block_statistics.h"
#include "degrade/certify/certificate.h"
#include "degrade/parts/transfer_law.h"

namespace earthshine::degrade {

// Stages by what they do, to be left out where another is measured.
using Names = std::vector<std::string>;
[[nodiscard]] Names operator+(Names a, const Names& b);
namespace stage {
extern const Names noise;    // both
extern const Names uneven;   // what makes a flat field uneven
extern const Names spatial;  // what spreads light over resels
extern const Names limits;   // what a linear signal ends at: saturation, black, white
extern const Names coding;   // gamma and steps
extern const Names screen;   // everything behind the line
}  // namespace stage

// Vertical field of view that the charts fill.
inline constexpr double bench_fov_deg = 40.0;

class Bench {
 public:
  Bench(const CctvCamera& camera, const Monitor& monitor, const CertifyOptions& options);

  [[nodiscard]] const CctvCamera& camera() const { return camera_; }
  // The same with its iris held at an f-number of its range and the gain at 1, so that light and
  // signal are proportional.
  [[nodiscard]] const CctvCamera& held() const { return held_; }
  [[nodiscard]] const Monitor& monitor() const { return monitor_; }
  // The law of its noise.
  [[nodiscard]] const LineNoise& noise() const { return noise_; }
  [[nodiscard]] int columns() const { return monitor_.columns; }
  [[nodiscard]] int rows() const { return monitor_.rows; }

  // cd/m^2 that the held camera turns into signal 1.
  [[nodiscard]] double white_luminance() const;
  // A chart of one pixel per resel, or of `fine` x `fine`; f(x, y) in resels gives the signal
  // wanted of the held camera.
  template <class F>
  [[nodiscard]] base::Image chart(F f, int fine = 1) const;
  [[nodiscard]] base::Image flat(double signal) const;

  [[nodiscard]] Result run(const base::Image& chart, const CctvCamera& camera,
                           const Options& options) const;
  // `frame` counts frames that have nothing in common but fixed patterns.
  [[nodiscard]] Options options(Names off, std::uint64_t frame = 0) const;
  // The held camera's linear signal, with noise: every limit, code and unevenness left out.
  [[nodiscard]] Picture linear(const base::Image& chart, std::uint64_t frame,
                               const Names& off = {}) const;
  [[nodiscard]] Picture linear(const base::Image& chart, const Options& options) const;

  // Blocks for statistics, clear of the border and wider than the grain.
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

inline constexpr double chain_rounding = 1e-5;  // of single precision, over a whole chain

// Rows. A number that is not finite fails.
[[nodiscard]] CertificateRow within(std::string_view name, std::string_view unit, double measured,
                                    double expected, double tolerance, std::string_view law);
// Four standard errors, and `rounding` of single precision.
[[nodiscard]] CertificateRow within_errors(std::string_view name, std::string_view unit,
                                           const Estimate& measured, double expected,
                                           std::string_view law, double rounding = 0.0);
[[nodiscard]] CertificateRow absent(std::string_view name, std::string_view unit,
                                    std::string_view why);

// The one of two that is farther from 0; what is not a number is farthest.
[[nodiscard]] double farther(double a, double b);
// Largest |a - b|; NaN if one is in either.
[[nodiscard]] double largest_difference(const Plane& a, const Plane& b);

// The groups.
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
