// SPDX-License-Identifier: Apache-2.0
#include "degrade/certify/photon_transfer.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "degrade/certify/test_bench.h"

namespace earthshine::degrade {
namespace {

// Powers of the signal, each with a coefficient.
using Powers = std::vector<int>;

// Weighted least squares: coefficients (X' W X)^-1 X' W v for the variances v of each block.
std::vector<Estimate> fit(std::span<const FlatField> fields,
                          const std::vector<double> FlatField::*variances,
                          const std::vector<double>& weights, const Powers& powers) {
  const auto levels = static_cast<Eigen::Index>(fields.size());
  const auto unknowns = static_cast<Eigen::Index>(powers.size());
  const auto blocks = static_cast<Eigen::Index>((fields.front().*variances).size());
  Eigen::MatrixXd x(levels, unknowns), v(levels, blocks);
  for (Eigen::Index level = 0; level < levels; ++level) {
    const FlatField& field = fields[static_cast<std::size_t>(level)];
    for (Eigen::Index k = 0; k < unknowns; ++k) {
      x(level, k) = std::pow(field.signal, powers[static_cast<std::size_t>(k)]);
    }
    v.row(level) = Eigen::Map<const Eigen::RowVectorXd>((field.*variances).data(), blocks);
  }
  const auto w = Eigen::Map<const Eigen::VectorXd>(weights.data(), levels).asDiagonal();
  const Eigen::MatrixXd normal = x.transpose() * w * x;
  const Eigen::MatrixXd found = normal.ldlt().solve(x.transpose() * w * v);
  std::vector<Estimate> result;
  for (Eigen::Index k = 0; k < unknowns; ++k) {
    const Eigen::RowVectorXd row = found.row(k);
    result.push_back(mean_of({row.begin(), row.end()}));
  }
  return result;
}

// Photon transfer: flat fields from black to white at the linear signal, two frames of each.

constexpr double levels[] = {0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.85, 1.0};
// Rounding errors of single precision in a mean and in a variance, for signals near 1.
constexpr double mean_rounding = 1e-6, variance_rounding = 1e-13;

const FlatField& at(const std::vector<FlatField>& fields, double signal) {
  return *std::find_if(fields.begin(), fields.end(),
                       [&](const FlatField& field) { return field.signal == signal; });
}

Estimate scaled(Estimate e, double factor) {
  return {e.value * factor, e.error * factor, e.freedom};
}

Estimate total_variance(const FlatField& field) {
  std::vector<double> blocks = field.in_time;
  for (std::size_t k = 0; k < blocks.size(); ++k) blocks[k] += field.in_space[k];
  return mean_of(blocks);
}

// 20 lg(top / sigma) with the error of a sample variance.
Estimate decibel(double top, const Estimate& variance) {
  return {10.0 * std::log10(top * top / variance.value),
          10.0 / std::numbers::ln10 * variance.error / variance.value, variance.freedom};
}

CertificateRow coefficient(std::string_view name, const Estimate& on_line, double factor,
                           double law, std::string_view text) {
  return within_errors(name, "1", scaled(on_line, 1.0 / factor), law, text,
                       variance_rounding / factor);
}

// A standard deviation in percent, from a variance that may be negative when measured. The
// tolerance of the variance is propagated through the root.
CertificateRow percent(std::string_view name, const Estimate& on_line, double factor,
                       double expected, std::string_view law) {
  const Estimate variance = scaled(on_line, 1.0 / factor);
  const double slack = four_errors(variance) + variance_rounding / factor;
  const auto root = [](double v) { return 100.0 * std::sqrt(std::max(0.0, v)); };
  const double tolerance =
      std::max(root(expected + slack) - root(expected), root(expected) - root(expected - slack));
  CertificateRow row = within(name, "%", root(variance.value), root(expected), tolerance, law);
  row.statistical = true;
  return row;
}

// The reciprocal of b, with the propagated tolerance of b.
CertificateRow electrons(const Estimate& b, double law, double excess) {
  constexpr std::string_view name = "electrons at white";
  const double relative = four_errors(b) / law;
  if (relative >= 0.9) return absent(name, "1", "other noise hides that of the light");
  const double count = excess / law;
  CertificateRow row =
      within(name, "1", excess / b.value, count, count * relative / (1.0 - relative), "F^2 / b");
  row.statistical = true;
  return row;
}

Rows mean_rows(const std::vector<FlatField>& fields) {
  Rows rows;
  const Estimate white = mean_of(at(fields, 1.0).mean);
  rows.push_back(within_errors("mean signal of white", "1", white, 1.0,
                               "S = pi tau L / (4 N^2 (1 + m)^2 E_white); no noise shifts a mean",
                               mean_rounding));
  Estimate worst;
  double worst_z = -1.0;
  for (const FlatField& field : fields) {
    const Estimate mean = mean_of(field.mean);
    const double z = std::abs(mean.value - field.signal) / (mean.error + 0.25 * mean_rounding);
    if (z <= worst_z) continue;
    worst_z = z;
    worst = {mean.value - field.signal, mean.error, mean.freedom};
  }
  rows.push_back(within_errors("linearity: worst level's distance from the line", "1", worst, 0.0,
                               "mean signal proportional to light, 12 levels", mean_rounding));
  return rows;
}

Rows ratio_rows(const Bench& bench, const std::vector<FlatField>& fields, const LineNoise& line) {
  Rows rows;
  constexpr std::pair<double, std::string_view> at_levels[] = {{1.0, "SNR on the line, at white"},
                                                               {0.5, "SNR on the line, at 50 %"},
                                                               {0.05, "SNR on the line, at 5 %"}};
  for (const auto& [signal, name] : at_levels) {
    if (!line.shows(signal)) {
      rows.push_back(absent(name, "dB", "the camera has no noise there that shows"));
      continue;
    }
    const double variance = line.total(signal);
    rows.push_back(within_errors(
        name, "dB", decibel(signal, total_variance(at(fields, signal))),
        20.0 * std::log10(signal / std::sqrt(variance)),
        "20 lg(S / sigma) on the line before gamma: a + b S + c S^2 through the filters"));
  }
  if (!line.shows(0.0)) {
    rows.push_back(absent("dynamic range on the line", "dB", "black has no noise that shows"));
    return rows;
  }
  const double black = line.total(0.0);
  const CctvCamera& camera = bench.camera();
  double law_top = std::min(camera.white_clip > 0.0 ? camera.white_clip : 1e6,
                            camera.saturation > 0.0 ? camera.saturation : 1e6);
  if (law_top == 1e6) law_top = 1.0;
  const Result overload = bench.run(
      bench.flat(4.0 * law_top), bench.held(),
      bench.options(stage::noise + stage::uneven + Names{"bloom"} + stage::coding + stage::screen));
  const bool limited = camera.white_clip > 0.0 || camera.saturation > 0.0;
  const double top = limited ? static_cast<double>(overload.signal.channels[0].values[0]) : law_top;
  rows.push_back(within_errors("dynamic range on the line", "dB",
                               decibel(top, total_variance(at(fields, 0.0))),
                               20.0 * std::log10(law_top / std::sqrt(black)),
                               "20 lg(largest signal, or white / rms noise of black)"));
  return rows;
}

}  // namespace

FlatField measure_flat(double signal, std::span<const Picture> frames,
                       const std::vector<Block>& blocks) {
  FlatField field;
  field.signal = signal;
  const double count = static_cast<double>(frames.size());
  const int columns = frames.front().columns;
  for (std::size_t plane = 0; plane < frames.front().planes.size(); ++plane) {
    const auto mean_at = [&](std::size_t i) {
      double sum = 0.0;
      for (const Picture& frame : frames) sum += static_cast<double>(frame.planes[plane][i]);
      return sum / count;
    };
    double whole = 0.0;
    for (const Picture& frame : frames) {
      whole += plane_mean(frame.planes[plane], columns, blocks) / count;
    }
    for (const Block& block : blocks) {
      field.mean.push_back(block_mean(block, columns, mean_at));
      const double in_time = block_mean(block, columns, [&](std::size_t i) {
        const double mean = mean_at(i);
        double squares = 0.0;
        for (const Picture& frame : frames) {
          const double d = static_cast<double>(frame.planes[plane][i]) - mean;
          squares += d * d;
        }
        return squares / (count - 1.0);
      });
      field.in_time.push_back(in_time);
      field.in_space.push_back(block_mean(block, columns,
                                          [&](std::size_t i) {
                                            const double d = mean_at(i) - whole;
                                            return d * d;
                                          }) -
                               in_time / count);
    }
  }
  return field;
}

PhotonTransfer fit_photon_transfer(std::span<const FlatField> fields) {
  std::vector<double> variances;
  for (const FlatField& field : fields) {
    variances.push_back(mean_of(field.in_time).value + std::abs(mean_of(field.in_space).value));
  }
  // Otherwise a level without noise would get all the weight.
  const double least =
      std::max(1e-6 * *std::max_element(variances.begin(), variances.end()), 1e-20);
  std::vector<double> weights;
  weights.reserve(variances.size());
  for (const double variance : variances) {
    weights.push_back(1.0 / std::pow(std::max(variance, least), 2.0));
  }
  const double scale = *std::min_element(weights.begin(), weights.end());
  for (double& weight : weights) weight /= scale;
  const std::vector<Estimate> time = fit(fields, &FlatField::in_time, weights, {0, 1, 2});
  const std::vector<Estimate> space = fit(fields, &FlatField::in_space, weights, {0, 2});
  return {time[0], time[1], time[2], space[0], space[1]};
}

Rows photon_transfer_rows(const Bench& bench, std::vector<TransferPoint>& points) {
  const LineNoise& line = bench.noise();
  std::vector<FlatField> fields;
  std::uint64_t frame = 0;
  for (const double level : levels) {
    const base::Image chart = bench.flat(level);
    // New frames for each level; else the errors of all levels would be correlated.
    const Picture frames[] = {bench.linear(chart, frame), bench.linear(chart, frame + 1)};
    frame += 2;
    fields.push_back(measure_flat(level, frames, bench.blocks()));
    const FlatField& field = fields.back();
    points.push_back({level, mean_of(field.mean).value, mean_of(field.in_time).value,
                      mean_of(field.in_space).value, line.in_time(level), line.fixed(level)});
  }
  const PhotonTransfer fit = fit_photon_transfer(fields);
  Rows rows = mean_rows(fields);
  // The noise of black in time may have two sources with different filters.
  const double a = line.amplifier + line.dark;
  const double light = line.light_factor(), amplifier = line.amplifier_factor();
  rows.push_back(coefficient("a, noise of black", fit.a,
                             a > 0.0 ? line.in_time(0.0) / a : amplifier, a,
                             "variance in time of black, the filters' sum h^2 undone"));
  rows.push_back(coefficient("b, noise of the light", fit.b, light * line.lag, line.light,
                             "slope of the variance against S (EMVA 1288: gain K), sum h^2 and "
                             "lag undone"));
  rows.push_back(coefficient("c, noise per signal, new in each frame", fit.c, light * line.lag,
                             line.share, "curvature of the variance, the same undone"));
  if (line.light > 0.0) {
    const double excess =
        bench.camera().noise == NoiseMode::Photon ? bench.camera().excess_noise : 1.0;
    rows.push_back(electrons(scaled(fit.b, 1.0 / (light * line.lag)), line.light, excess));
  } else {
    rows.push_back(absent("electrons at white", "1", "the light brings no noise (b = 0)"));
  }
  rows.push_back(percent("DSNU, fixed pattern of black", fit.fixed_a, amplifier, line.fixed_black,
                         "variance in space of the mean of L frames, less 1/L of that in time"));
  rows.push_back(percent("PRNU, fixed pattern of white", fit.fixed_c, light, line.fixed_share,
                         "the same, share that grows with S^2"));
  for (CertificateRow& row : ratio_rows(bench, fields, line)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace earthshine::degrade
