// SPDX-License-Identifier: Apache-2.0
// Effects of lens and sensor other than blur and noise.
#include <cmath>

#include "base/units.h"
#include "degrade/certify/test_bench.h"

namespace earthshine::degrade {
namespace {

double value_at(const Picture& picture, int x, int y) {
  return static_cast<double>(
      picture.planes[0][static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.columns) +
                        static_cast<std::size_t>(x)]);
}

CertificateRow aperture(const Bench& bench) {
  CctvCamera closed = bench.held();
  closed.f_number *= 2.0;
  const Options options =
      bench.options(stage::noise + stage::uneven + stage::limits + stage::coding + stage::screen);
  const Picture signal = to_picture(bench.run(bench.flat(1.0), closed, options).signal);
  return within("signal at twice the f-number", "1",
                value_at(signal, bench.columns() / 2, bench.rows() / 2), 0.25, chain_rounding,
                "E proportional to 1 / N^2");
}

// A bright left half: the far dark side shows only the veil.
void glare(const Bench& bench, Rows& rows) {
  const double share = bench.camera().glare;
  const int half = bench.columns() / 2;
  const Picture signal = bench.linear(
      bench.chart([&](double x, double) { return x < half ? 0.8 : 0.0; }), 0, stage::noise);
  double sum = 0.0;
  for (const float value : signal.planes[0]) sum += static_cast<double>(value);
  const double mean = 0.8 * half / bench.columns();
  rows.push_back(within("glare: light of a half bright picture", "1",
                        sum / static_cast<double>(signal.pixel_count()), mean, chain_rounding,
                        "E = (1 - g) E + g mean(E) keeps the mean"));
  rows.push_back(within("glare: veil on black", "1",
                        value_at(signal, bench.columns() - 1, bench.rows() / 2), share * mean,
                        chain_rounding, "g mean(S)"));
}

// Signal of a chart through one non-uniform stage only.
Picture through(const Bench& bench, const base::Image& chart, const std::string& kept) {
  Names off =
      stage::noise + stage::uneven + stage::spatial + stage::limits + stage::coding + stage::screen;
  std::erase(off, kept);
  return to_picture(bench.run(chart, bench.held(), bench.options(off)).signal);
}

CertificateRow fall_off(const Bench& bench) {
  constexpr std::string_view name = "fall-off: corner over centre";
  const double power = bench.camera().fall_off;
  if (power == 0.0) return absent(name, "1", "the lens has none");
  const Picture signal = through(bench, bench.flat(0.5), "fall-off");
  const auto law = [&](int x, int y) {
    const double u = (2.0 * x + 1.0 - bench.columns()) / bench.rows();
    const double v = (2.0 * y + 1.0 - bench.rows()) / bench.rows();
    const double tangent = std::tan(base::radians(bench_fov_deg) / 2.0);
    return std::pow(std::cos(std::atan(std::hypot(u, v) * tangent)), power);
  };
  const int x = bench.columns() / 2, y = bench.rows() / 2;
  return within(name, "1", value_at(signal, 0, 0) / value_at(signal, x, y), law(0, 0) / law(x, y),
                chain_rounding, "cos(theta)^n, at 40 degrees from top to bottom");
}

CertificateRow shading(const Bench& bench) {
  constexpr std::string_view name = "shading: corner over centre";
  const double droop = bench.camera().shading_percent / 100.0;
  if (droop == 0.0) return absent(name, "1", "the sensor has none");
  const Picture signal = through(bench, bench.flat(0.5), "shading");
  const auto law = [&](int x, int y) {
    const double u = 2.0 * x + 1.0 - bench.columns(), v = 2.0 * y + 1.0 - bench.rows();
    const double corner = std::hypot(bench.columns(), bench.rows());
    return 1.0 - droop * (u * u + v * v) / (corner * corner);
  };
  const int x = bench.columns() / 2, y = bench.rows() / 2;
  return within(name, "1", value_at(signal, 0, 0) / value_at(signal, x, y), law(0, 0) / law(x, y),
                chain_rounding, "1 - d r^2, r = 1 in the corners");
}

// A patch over a tenth of the lines: in its columns, black gets the patch's signal times
// 10^(-dB / 20), the definition of smear of a chip.
CertificateRow smear(const Bench& bench) {
  constexpr std::string_view name = "smear under a patch of a tenth of the height";
  const double db = bench.camera().smear_db;
  if (db == 0.0) return absent(name, "dB", "the sensor has none");
  const int patch = bench.rows() / 10;
  const Picture signal = through(bench, bench.chart([&](double x, double y) {
    return x < 0.5 * bench.columns() && y < patch ? 1.0 : 0.0;
  }),
                                 "smear");
  const double share = 10.0 * patch / bench.rows();
  return within(name, "dB", -20.0 * std::log10(value_at(signal, 1, bench.rows() - 1) / share), db,
                1e-3, "S + 10 smear mean(column)");
}

// A square far above saturation: the share `bloom` of the excess returns as a Gaussian halo.
CertificateRow bloom(const Bench& bench) {
  constexpr std::string_view name = "bloom: halo beside an overloaded square";
  const CctvCamera& camera = bench.camera();
  if (camera.bloom == 0.0 || camera.saturation == 0.0) {
    return absent(name, "1", "no signal spills over");
  }
  constexpr int side = 5;
  constexpr double overload = 3.0;
  const int cx = bench.columns() / 2, cy = bench.rows() / 2;
  const Picture signal = through(bench, bench.chart([&](double x, double y) {
    const bool inside = std::abs(x - cx - 0.5) < 0.5 * side && std::abs(y - cy - 0.5) < 0.5 * side;
    return inside ? overload * camera.saturation : 0.0;
  }),
                                 "bloom");
  // Sum of the discrete Gaussian's taps over the square, along and across. Mirroring at the border
  // returns the light beyond it.
  const auto over_square = [&](int from, int centre, int size) {
    double sum = 0.0;
    for (int n = centre - side / 2; n <= centre + side / 2; ++n) {
      // Repeated mirror images in both borders, as far as a tap reaches.
      const int copies = 1 + static_cast<int>(7.0 * camera.bloom_radius) / size;
      for (int copy = -copies; copy <= copies; ++copy) {
        const int there = 2 * copy * size;
        sum += gaussian_tap(camera.bloom_radius, there + n - from) +
               gaussian_tap(camera.bloom_radius, there - 1 - n - from);
      }
    }
    return sum;
  };
  const int x = cx + side;
  const double law = camera.bloom * (overload - 1.0) * camera.saturation *
                     over_square(x, cx, bench.columns()) * over_square(cy, cy, bench.rows());
  return within(name, "1", value_at(signal, x, cy), law, 1e-4 * law + 1e-7,
                "share of the excess times the Gaussian over the square");
}

}  // namespace

Rows optics_rows(const Bench& bench) {
  Rows rows = {aperture(bench)};
  glare(bench, rows);
  for (const auto test : {fall_off, shading, smear, bloom}) rows.push_back(test(bench));
  return rows;
}

}  // namespace earthshine::degrade
