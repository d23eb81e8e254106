// SPDX-License-Identifier: Apache-2.0
// What the lens does to the light, noise left out.
#include <cmath>

#include "degrade/test_bench.h"

namespace earthshine::degrade {
namespace {

constexpr double rounding = 1e-5;

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
                value_at(signal, bench.columns() / 2, bench.rows() / 2), 0.25, rounding,
                "E proportional to 1 / N^2");
}

// A bright left half: the far dark side sees the veil alone.
void glare(const Bench& bench, Rows& rows) {
  const double share = bench.camera().glare;
  const int half = bench.columns() / 2;
  const Picture signal = bench.linear(
      bench.chart([&](double x, double) { return x < half ? 0.8 : 0.0; }), 0, stage::noise);
  double sum = 0.0;
  for (const float value : signal.planes[0]) sum += static_cast<double>(value);
  const double mean = 0.8 * half / bench.columns();
  rows.push_back(within("glare: light of a half bright picture", "1",
                        sum / static_cast<double>(signal.pixel_count()), mean, rounding,
                        "E = (1 - g) E + g mean(E) keeps the mean"));
  rows.push_back(within("glare: veil on black", "1",
                        value_at(signal, bench.columns() - 1, bench.rows() / 2), share * mean,
                        rounding, "g mean(S)"));
}

}  // namespace

Rows optics_rows(const Bench& bench) {
  Rows rows = {aperture(bench)};
  glare(bench, rows);
  return rows;
}

}  // namespace earthshine::degrade
