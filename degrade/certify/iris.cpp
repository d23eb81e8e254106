// SPDX-License-Identifier: Apache-2.0
// The iris: its target, its range and its state beyond the range. Without noise, spread and limits.
#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "degrade/certify/test_bench.h"

namespace earthshine::degrade {
namespace {

constexpr double bright_share = 0.1, dim = 0.1;  // a tenth of the scene is ten times as bright as
                                                 // the rest

// The meters of docs/cctv.md, in double precision.
double meter(const CctvCamera& camera, IrisMode mode, const Picture& picture) {
  std::vector<double> values(picture.planes[0].begin(), picture.planes[0].end());
  if (mode == IrisMode::Peak) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(
        std::lround(0.995 * static_cast<double>(values.size() - 1)))];
  }
  const double power = mode == IrisMode::Normal ? 4.0 : 1.0;
  const double centre = mode == IrisMode::Normal ? camera.iris_centre : 0.0;
  double sum = 0.0, weights = 0.0;
  std::size_t i = 0;
  for (int y = 0; y < picture.rows; ++y) {
    const double v = (2.0 * y + 1.0) / picture.rows - 1.0;
    for (int x = 0; x < picture.columns; ++x) {
      const double u = (2.0 * x + 1.0) / picture.columns - 1.0;
      const double w = 1.0 - centre * (1.0 - (1.0 - u * u) * (1.0 - v * v));
      sum += w * std::pow(values[i++], power);
      weights += w;
    }
  }
  return std::pow(sum / weights, 1.0 / power);
}

// Luminances at which iris or gain reach a limit, from the settings.
struct Reach {
  double target = 1.0;
  double most_gain = 1.0;
  double dark = 0.0, open = 0.0, bright = 0.0;  // full gain; wide open; closed

  explicit Reach(const CctvCamera& camera) {
    constexpr double targets[] = {1.0, 1.0, 0.5, 0.25};  // fixed, peak, normal, average
    target = camera.iris_target > 0.0 ? camera.iris_target
                                      : targets[static_cast<std::size_t>(camera.iris)];
    most_gain = std::pow(10.0, camera.gain_max_db / 20.0);
    const double image = 1.0 + camera.magnification;
    const double per_n2 =
        4.0 * target * camera.white_lux * image * image / (base::pi * camera.transmittance);
    open = per_n2 * camera.f_number_min * camera.f_number_min;
    bright = per_n2 * camera.f_number_max * camera.f_number_max;
    dark = open / most_gain;
  }
};

class Scene {
 public:
  explicit Scene(const Bench& bench)
      : bench_(bench),
        options_(bench.options(stage::noise + stage::uneven + stage::spatial + stage::limits +
                               stage::coding + stage::screen)) {}

  // A narrow strip, for speed.
  [[nodiscard]] Result flat(double luminance) const {
    base::Image image{std::min(8, bench_.columns()), bench_.rows(), {}};
    image.add("Y").assign(image.pixel_count(), static_cast<float>(luminance));
    return bench_.run(image, bench_.camera(), options_);
  }
  [[nodiscard]] base::Image chart(double luminance) const {
    const double share = luminance / bench_.white_luminance();
    return bench_.chart([&](double x, double) {
      return x < bright_share * bench_.columns() ? share : dim * share;
    });
  }
  [[nodiscard]] Result of(const base::Image& image, const CctvCamera& camera) const {
    return bench_.run(image, camera, options_);
  }

 private:
  const Bench& bench_;
  Options options_;
};

double first_value(const Result& result) {
  return static_cast<double>(result.signal.channels[0].values[0]);
}

// Luminance at which a flag changes, by bisection in the logarithm.
template <class Flag>
double luminance_at(double from, double to, Flag flag) {
  double a = std::log(from), b = std::log(to);
  const bool at_start = flag(from);
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (a + b);
    (flag(std::exp(middle)) == at_start ? a : b) = middle;
  }
  return std::exp(0.5 * (a + b));
}

CertificateRow fixed_point(const Bench& bench, const Scene& scene, const Reach& reach) {
  constexpr std::string_view name = "metered signal over its target, less 1: worst of its range";
  if (reach.bright < 1.1 * reach.dark) return absent(name, "1", "neither iris nor gain can move");
  double worst = 0.0;
  const CctvCamera& camera = bench.camera();
  const double unit = meter(camera, camera.iris, to_picture(scene.chart(1.0)));
  for (int k = 0; k <= 4; ++k) {
    const double metered = reach.dark * 1.01 * std::pow(reach.bright / reach.dark * 0.98, k / 4.0);
    const Picture signal = to_picture(scene.of(scene.chart(metered / unit), camera).signal);
    const double miss = meter(camera, camera.iris, signal) / reach.target - 1.0;
    worst = farther(worst, miss);
  }
  return within(name, "1", worst, 0.0, chain_rounding,
                "M(E(N)) = t E_white wherever neither end is reached");
}

Rows range_rows(const Bench& bench, const Scene& scene, const Reach& reach) {
  const CctvCamera& camera = bench.camera();
  Rows rows;
  const Result darkest = scene.flat(0.5 * reach.dark), brightest = scene.flat(2.0 * reach.bright);
  rows.push_back(
      within("range of the iris", "stops",
             2.0 * std::log2(brightest.report.exposure.f_number / darkest.report.exposure.f_number),
             2.0 * std::log2(camera.f_number_max / camera.f_number_min), chain_rounding,
             "2 lb(N_max / N_min)"));
  const double least = luminance_at(0.01 * reach.dark, 1.001 * reach.dark, [&](double l) {
    return scene.flat(l).report.exposure.underexposed;
  });
  rows.push_back(within("darkest flat scene not underexposed", "cd/m2", least, reach.dark,
                        1e-4 * reach.dark, "4 t E_white N_min^2 (1 + m)^2 / (pi tau G_max)"));
  const double most = luminance_at(0.999 * reach.bright, 100.0 * reach.bright,
                                   [&](double l) { return scene.flat(l).report.exposure.blown; });
  rows.push_back(within("brightest flat scene not blown", "cd/m2", most, reach.bright,
                        1e-4 * reach.bright, "4 t E_white N_max^2 (1 + m)^2 / (pi tau)"));
  rows.push_back(within("signal at half the darkest", "1", first_value(darkest), 0.5 * reach.target,
                        chain_rounding, "falls in proportion: t / 2"));
  rows.push_back(within("signal at twice the brightest", "1", first_value(brightest),
                        2.0 * reach.target, 2.0 * chain_rounding, "rises in proportion: 2 t"));
  return rows;
}

CertificateRow square_root(const Bench& bench, const Scene& scene, const Reach& reach) {
  constexpr std::string_view name = "slope of ln N against ln L";
  if (bench.camera().f_number_max < 1.1 * bench.camera().f_number_min) {
    return absent(name, "1", "the iris hardly moves");
  }
  const double low = 1.01 * reach.open, high = 0.99 * reach.bright;
  const double n =
      scene.flat(high).report.exposure.f_number / scene.flat(low).report.exposure.f_number;
  return within(name, "1", std::log(n) / std::log(high / low), 0.5, chain_rounding,
                "N proportional to sqrt(L)");
}

CertificateRow gain(const Bench& bench, const Scene& scene, const Reach& reach) {
  constexpr std::string_view name = "signal where the gain has taken over";
  if (bench.camera().gain_max_db == 0.0) return absent(name, "1", "there is no automatic gain");
  const Result result = scene.flat(std::sqrt(reach.dark * reach.open));
  return within(name, "1", first_value(result), reach.target, chain_rounding,
                "wide open, half of the gain in dB: still t");
}

// Same target, no centre weight: a meter with more weight on bright points closes the iris further.
Rows mode_rows(const Bench& bench, const Scene& scene, const Reach& reach) {
  CctvCamera camera = bench.camera();
  camera.iris_target = reach.target;
  camera.iris_centre = 0.0;
  const base::Image unit = scene.chart(1.0);
  const double middle =
      std::sqrt(reach.open * reach.bright) / meter(camera, IrisMode::Normal, to_picture(unit));
  const base::Image chart = scene.chart(middle);
  const auto found = [&](IrisMode mode) {
    camera.iris = mode;
    return scene.of(chart, camera).report.exposure.f_number;
  };
  const auto due = [&](IrisMode mode) {
    const double n =
        camera.f_number_min * std::sqrt(meter(camera, mode, to_picture(chart)) / reach.open);
    return std::clamp(n, camera.f_number_min, camera.f_number_max);
  };
  const auto row = [&](std::string_view name, IrisMode more, IrisMode less) {
    const double law = due(more) / due(less);
    return within(name, "1", found(more) / found(less), law, chain_rounding * law,
                  "sqrt of the metered values' ratio, at least 1");
  };
  return {row("f-numbers, peak over normal", IrisMode::Peak, IrisMode::Normal),
          row("f-numbers, normal over average", IrisMode::Normal, IrisMode::Average)};
}

}  // namespace

Rows iris_rows(const Bench& bench) {
  if (bench.camera().iris == IrisMode::Fixed) {
    return {absent("all tests of the iris", "", "it is fixed")};
  }
  const Scene scene(bench);
  const Reach reach(bench.camera());
  Rows rows = {fixed_point(bench, scene, reach), square_root(bench, scene, reach)};
  for (CertificateRow& row : range_rows(bench, scene, reach)) rows.push_back(std::move(row));
  rows.push_back(gain(bench, scene, reach));
  for (CertificateRow& row : mode_rows(bench, scene, reach)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace earthshine::degrade
