// SPDX-License-Identifier: Apache-2.0
// From the sensor's signal to the line: limits, gain, black, gamma, quantisation.
#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "degrade/certify/test_bench.h"

namespace earthshine::degrade {
namespace {

// Largest signal of a flat field far above `limit`, with `kept` as the only active limit.
double overloaded(const Bench& bench, double limit, const std::string& kept) {
  Names off = stage::noise + stage::uneven + stage::limits + stage::coding + stage::screen;
  std::erase(off, kept);
  const Result result = bench.run(bench.flat(8.0 * limit), bench.held(), bench.options(off));
  const Plane& values = result.signal.channels[0].values;
  return static_cast<double>(*std::max_element(values.begin(), values.end()));
}

Rows limit_rows(const Bench& bench) {
  const CctvCamera& camera = bench.camera();
  const auto row = [&](std::string_view name, double limit, const char* stage, std::string_view law,
                       std::string_view without) {
    return limit > 0.0 ? within(name, "1", overloaded(bench, limit, stage), limit,
                                chain_rounding * limit, law)
                       : absent(name, "1", without);
  };
  return {row("saturation of the sensor", camera.saturation, "saturation", "S = min(S, S_most)",
              "it holds any signal"),
          row("white clip of the line", camera.white_clip, "white-clip", "S = min(S, S_clip)",
              "the line carries any signal")};
}

// Gain multiplies signal and noise, so that the noise of one seed must scale in every resel.
CertificateRow gain(const Bench& bench, const base::Image& ramp, const Plane& linear) {
  CctvCamera louder = bench.held();
  louder.gain_db = 20.0 * std::log10(2.0);
  const Options options =
      bench.options(stage::limits + stage::coding + stage::screen + stage::uneven);
  const Plane loud = bench.run(ramp, louder, options).signal.channels[0].values;
  Plane twice = linear;
  double most = 0.0;
  for (float& value : twice) {
    value *= 2.0F;
    most = std::max(most, std::abs(static_cast<double>(value)));
  }
  return within("gain of 6.02 dB: largest difference from twice the signal", "1",
                largest_difference(loud, twice), 0.0, 1e-6 * most, "S = G S, noise included");
}

CertificateRow line_signal(const Bench& bench, const base::Image& ramp, const Plane& linear) {
  const CctvCamera& camera = bench.camera();
  const Options options =
      bench.options(stage::uneven + stage::screen + Names{"saturation", "bloom", "quantisation"});
  const Plane line = bench.run(ramp, bench.held(), options).signal.channels[0].values;
  const bool below_black = !camera.black_clamp && camera.gamma == 1.0;
  Plane law = linear;
  for (float& value : law) {
    double s = static_cast<double>(value);
    if (camera.white_clip > 0.0) s = std::min(s, camera.white_clip);
    if (!below_black) s = std::pow(std::max(s, 0.0), 1.0 / camera.gamma);
    value = static_cast<float>(s);
  }
  return within("gamma: largest distance of the line signal from its law", "1",
                largest_difference(line, law), 0.0, chain_rounding,
                "v = min(max(S, 0), S_clip)^(1/gamma), on a ramp with noise");
}

CertificateRow black(const Bench& bench) {
  constexpr std::string_view name = "mean of black behind the clamp";
  if (!bench.camera().black_clamp) return absent(name, "1", "signals below black pass");
  if (bench.camera().noise == NoiseMode::Photon && bench.camera().dark_electrons > 0.0) {
    return absent(name, "1", "dark counts are not normal");
  }
  const Options options =
      bench.options(stage::uneven + stage::coding + stage::screen + Names{"saturation", "bloom"});
  const Picture signal = to_picture(bench.run(bench.flat(0.0), bench.held(), options).signal);
  std::vector<double> blocks;
  for (const Plane& plane : signal.planes) {
    for (const Block& block : bench.blocks()) {
      blocks.push_back(block_mean(block, signal.columns,
                                  [&](std::size_t i) { return static_cast<double>(plane[i]); }));
    }
  }
  const double sigma = std::sqrt(bench.noise().total(0.0));
  const double clip = bench.camera().white_clip;
  if (clip > 0.0 && clip < 5.0 * sigma) return absent(name, "1", "white clips the noise of black");
  return within_errors(name, "1", mean_of(blocks), sigma / std::sqrt(2.0 * base::pi),
                       "clipped normal: sigma / sqrt(2 pi)", 1e-9);
}

// Noise off, a ramp over all steps: the error x = quantised - analogue is uniform, with mean 0,
// variance q^2 / 12 (with dither it would be q^2 / 6) and |x| <= q / 2. The variance of x^2 is
// q^4 / 180.
Rows step_rows(const Bench& bench) {
  constexpr std::string_view step = "step: variance over q^2", bias = "step: mean over q";
  const CctvCamera& camera = bench.camera();
  if (camera.bits == 0) {
    return {absent(step, "1", "the line is analogue"), absent(bias, "1", "the line is analogue")};
  }
  const double across = static_cast<double>(bench.columns()) * bench.rows();
  const base::Image ramp = bench.chart([&](double x, double y) {
    const double v = (std::floor(y) * bench.columns() + x) / across;
    return std::pow(v, camera.gamma);
  });
  const Names off = stage::noise + stage::uneven + stage::spatial + stage::limits + stage::screen;
  const Plane analogue = bench.run(ramp, bench.held(), bench.options(off + Names{"quantisation"}))
                             .signal.channels[0]
                             .values;
  const Plane coded = bench.run(ramp, bench.held(), bench.options(off)).signal.channels[0].values;
  const double levels = std::ldexp(1.0, camera.bits) - 1.0, count = across;
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < coded.size(); ++i) {
    const double rest = levels * (static_cast<double>(coded[i]) - static_cast<double>(analogue[i]));
    sum += rest / count;
    squares += rest * rest / count;
  }
  // Rounding of v in single precision, in steps.
  const double grain = levels * 6e-8;
  return {within_errors(step, "1", {squares, 1.0 / std::sqrt(180.0 * count)}, 1.0 / 12.0,
                        "uniform rest: 1/12", grain),
          within_errors(bias, "1", {sum, 1.0 / std::sqrt(12.0 * count)}, 0.0,
                        "rounded to the nearest: no bias", grain)};
}

}  // namespace

Rows electronics_rows(const Bench& bench) {
  Rows rows = limit_rows(bench);
  const base::Image ramp =
      bench.chart([&](double x, double) { return 1.25 * (x - 0.5) / (bench.columns() - 1.0); });
  const Plane linear = bench.linear(ramp, 0).planes[0];
  rows.push_back(gain(bench, ramp, linear));
  rows.push_back(black(bench));
  rows.push_back(line_signal(bench, ramp, linear));
  for (CertificateRow& row : step_rows(bench)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace earthshine::degrade
