// SPDX-License-Identifier: Apache-2.0
// Repeatability: equal bytes for equal seeds, new noise in new frames. The noise as a random field:
// correlation of neighbours, stationarity, third moment.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "degrade/certify/test_bench.h"

namespace earthshine::degrade {
namespace {

constexpr double grey = 0.5;

std::size_t differing(const Result& a, const Result& b) {
  std::size_t count = 0;
  const auto compare = [&](const auto& p, const auto& q) {
    if (p.size() != q.size()) {
      count += std::max(p.size(), q.size());
      return;
    }
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (p[i] != q[i]) ++count;
    }
  };
  compare(a.pixels, b.pixels);
  for (const auto part : {&Result::signal, &Result::viewed}) {
    for (std::size_t c = 0; c < (a.*part).channels.size(); ++c) {
      compare((a.*part).channels[c].values, (b.*part).channels[c].values);
    }
  }
  return count;
}

CertificateRow same(std::string_view name, const Result& a, const Result& b, std::string_view law) {
  return within(name, "values", static_cast<double>(differing(a, b)), 0.0, 0.0, law);
}

Rows byte_rows(const Bench& bench) {
  const base::Image chart = bench.chart(
      [&](double x, double y) { return x < 0.3 * bench.columns() ? 0.9 : y / bench.rows(); });
  const auto run = [&](int threads, const Names& off, const CctvCamera& camera) {
    const base::ThreadLimit limit(threads);
    return bench.run(chart, camera, bench.options(off));
  };
  const Result first = run(2, {}, bench.held());
  CctvCamera silent = bench.held();
  silent.noise = NoiseMode::None;
  return {same("differing values, same seed again", first, run(2, {}, bench.held()), "none"),
          same("differing values, one thread against two", first, run(1, {}, bench.held()), "none"),
          same("differing values, noise left out against a camera without", run(2, {}, silent),
               run(2, stage::noise, bench.held()), "none: the noise-free twin bit for bit")};
}

Picture other(const Bench& bench, const base::Image& chart, std::uint64_t seed, std::uint64_t frame,
              std::uint64_t view) {
  Options options = bench.options({}, frame);
  options.seed += seed;
  options.view += view;
  return bench.linear(chart, options);
}

Rows independence_rows(const Bench& bench, const base::Image& chart, const Picture& field) {
  const LineNoise& line = bench.noise();
  const double share = line.fixed(grey) / line.total(grey);
  const auto row = [&](std::string_view name, const Picture& with, double law,
                       std::string_view text) {
    return within_errors(name, "1", correlation(field, with, bench.blocks()), law, text, 1e-9);
  };
  Rows rows = {row("correlation with another frame", other(bench, chart, 0, 1, 0), share,
                   "share of the fixed pattern in the variance"),
               row("correlation with another seed", other(bench, chart, 1, 0, 0), 0.0, "none"),
               row("correlation with another view", other(bench, chart, 0, 0, 1), 0.0, "none")};
  if (field.planes.size() == 3) {
    const Picture next_colours{
        field.columns, field.rows, {field.planes[1], field.planes[2], field.planes[0]}};
    rows.push_back(row("correlation of two colours", next_colours, 0.0, "none"));
  }
  return rows;
}

Rows grain_rows(const Bench& bench, const Picture& field) {
  struct Shift {
    int dx, dy;
    std::string_view name;
  };
  constexpr Shift shifts[] = {{1, 0, "correlation with the next resel"},
                              {2, 0, "correlation with the next but one"},
                              {0, 1, "correlation with the next line"},
                              {0, 2, "correlation with the next line but one"},
                              {1, 1, "correlation with the diagonal neighbour"}};
  const LineNoise& line = bench.noise();
  Rows rows;
  for (const Shift& shift : shifts) {
    rows.push_back(within_errors(shift.name, "1",
                                 correlation(field, field, bench.blocks(), shift.dx, shift.dy),
                                 line.total(grey, shift.dx, shift.dy) / line.total(grey),
                                 "autocorrelation of the filters that the noise has passed", 1e-9));
  }
  return rows;
}

// Sixteen tiles. The sample variance of m normal values of correlation rho has the relative
// variance (2 / m) sum over shifts of rho^2 (1 - |dx| / width) (1 - |dy| / height), plus the excess
// kurtosis of counts over m. The sum of squared standardised deviations from the law is chi-squared
// with 16 degrees of freedom. Wilson and Hilferty's cube root converts it to a standard normal z.
CertificateRow stationarity(const Bench& bench, const Picture& field) {
  constexpr std::string_view name = "z of sixteen tiles' variances";
  const int width = (bench.columns() - 2 * bench.margin()) / 4;
  const int height = (bench.rows() - 2 * bench.margin()) / 4;
  const LineNoise& line = bench.noise();
  const double law = line.total(grey);
  const int reach = bench.margin();
  if (2 * reach > std::min(width, height)) {
    return absent(name, "1", "the grain is too large for sixteen tiles");
  }
  const double m = static_cast<double>(width) * height;
  double scatter = 0.0;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const double rho = line.total(grey, dx, dy) / law;
      scatter += 2.0 * rho * rho * (1.0 - std::abs(dx) / static_cast<double>(width)) *
                 (1.0 - std::abs(dy) / static_cast<double>(height));
    }
  }
  scatter = (scatter + line.light_cumulant(grey, 4) / (law * law)) / m;
  double chi2 = 0.0;
  const Plane& plane = field.planes[0];
  const double centre = plane_mean(plane, field.columns, bench.blocks());
  for (int tile = 0; tile < 16; ++tile) {
    const int x = bench.margin() + tile % 4 * width, y = bench.margin() + tile / 4 * height;
    const double variance =
        block_mean({x, y, x + width, y + height}, field.columns, [&](std::size_t i) {
          const double d = static_cast<double>(plane[i]) - centre;
          return d * d;
        });
    const double z = (variance / law - 1.0) / std::sqrt(scatter);
    chi2 += z * z;
  }
  const double k = 16.0, spread = 2.0 / (9.0 * k);
  CertificateRow row = within(name, "1", (std::cbrt(chi2 / k) - (1.0 - spread)) / std::sqrt(spread),
                              0.0, 4.0, "chi-squared of the law's variance, as a normal number");
  row.statistical = true;
  return row;
}

CertificateRow skewness(const Bench& bench, const Picture& field) {
  constexpr std::string_view name = "skewness of the noise";
  const LineNoise& line = bench.noise();
  const double variance = line.total(grey), third = line.light_cumulant(grey, 3);
  std::vector<double> blocks;
  for (const Plane& plane : field.planes) {
    const double centre = plane_mean(plane, field.columns, bench.blocks());
    for (const Block& block : bench.blocks()) {
      blocks.push_back(block_mean(block, field.columns, [&](std::size_t i) {
        const double d = (static_cast<double>(plane[i]) - centre) / std::sqrt(variance);
        // Third Hermite polynomial: insensitive to the error of the mean.
        return d * d * d - 3.0 * d;
      }));
    }
  }
  return within_errors(name, "1", mean_of(blocks), third / std::pow(variance, 1.5),
                       "that of the photons' counts through the filters; 0 for the rest", 1e-9);
}

}  // namespace

Rows repeatability_rows(const Bench& bench) {
  Rows rows = byte_rows(bench);
  const auto add = [&](Rows more) {
    for (CertificateRow& row : more) rows.push_back(std::move(row));
  };
  if (!bench.noise().shows(grey)) {
    rows.push_back(absent("all tests of the noise", "", "the camera has none that shows"));
    return rows;
  }
  const base::Image chart = bench.flat(grey);
  const Picture field = bench.linear(chart, 0);
  add(independence_rows(bench, chart, field));
  add(grain_rows(bench, field));
  add({stationarity(bench, field), skewness(bench, field)});
  return rows;
}

}  // namespace earthshine::degrade
