// SPDX-License-Identifier: Apache-2.0
// Sensor pixels per second of each step of the analytic twin, and of all steps for one plane of a
// tube camera. The steps are grain of blur and bandwidth, clamp and gamma, screen, spread onto
// 3 x 3 pixels, and detection. The picture is 400 x 300 resels, half of it near black.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "degrade/moments/noise_moments.h"
#include "degrade/moments/point_moments.h"
#include "degrade/parts/monitor.h"
#include "degrade/twin.h"

namespace earthshine {
namespace {

using namespace degrade;

constexpr int columns = 400, rows = 300;

Plane signal() {
  Plane plane;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      plane.push_back(x < columns / 2 ? 0.0002F * static_cast<float>(x)
                                      : 0.5F + 0.6F * std::sin(0.05F * static_cast<float>(x + y)));
    }
  }
  return plane;
}

Plane signal_variance() {
  Plane variance = signal();
  for (float& value : variance) value = 1.6e-3F * std::max(value, 0.0F);
  return variance;
}

Covariance grain() {
  const AxisMap along = gaussian_blur(columns, 0.35), across = gaussian_blur(rows, 0.35);
  const Covariance light = filtered(white(columns, rows, signal_variance()), along, across);
  const Covariance all = plus(light, white(columns, rows, Plane(columns * rows, 1.3e-5F)));
  return filtered(all, gaussian_blur(columns, std::sqrt(0.3)), gaussian_blur(rows, 0.0));
}

// Camera and monitor in one map: luminance of the screen for a signal.
PointMap camera_and_screen(int bits) {
  PointMap map;
  map.limit_below(0.0).limit_above(1.1).power(1.0 / 2.2);
  if (bits > 0) map.quantise(bits);
  return map.screen(1.0, 100.0, 2.2);
}

AxisMap spread(int resels) { return spread_map(Spread::Gaussian, 1.0, resels, 3); }

template <class F>
void measure(benchmark::State& state, F step) {
  for (auto round : state) benchmark::DoNotOptimize(step());
  state.counters["px"] =
      benchmark::Counter(static_cast<double>(columns * rows),
                         benchmark::Counter::kIsRate | benchmark::Counter::kIsIterationInvariant);
}

void filters(benchmark::State& state) {
  measure(state, [] { return grain(); });
}
BENCHMARK(filters)->Name("twin/filtered")->Unit(benchmark::kMillisecond)->UseRealTime();

void map_points(benchmark::State& state) {
  const Plane mean = signal(), variance = grain().variance();
  const PointMap map = camera_and_screen(static_cast<int>(state.range(0)));
  measure(state, [&] { return through(map, mean, variance); });
}
BENCHMARK(map_points)
    ->Name("twin/through")
    ->ArgName("bits")
    ->Arg(0)
    ->Arg(8)
    ->Arg(12)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void on_screen(benchmark::State& state) {
  const Covariance noise = grain();
  const AxisMap along = spread(columns), across = spread(rows);
  measure(state, [&] { return variance_after(noise, along, across); });
}
BENCHMARK(on_screen)->Name("twin/variance_after")->Unit(benchmark::kMillisecond)->UseRealTime();

void targets(benchmark::State& state) {
  const Covariance noise = grain();
  const Plane mean = signal();
  measure(state, [&] { return detection(mean, noise); });
}
BENCHMARK(targets)->Name("twin/detection")->Unit(benchmark::kMillisecond)->UseRealTime();

void whole(benchmark::State& state) {
  const Plane mean = signal();
  measure(state, [&] {
    Covariance noise = grain();
    const MomentPlanes line = through(camera_and_screen(0), mean, noise.variance());
    noise = mapped(noise, line);
    const Plane seen = variance_after(noise, spread(columns), spread(rows));
    return detection(line.mean, noise).probability.front() + seen.front();
  });
}
BENCHMARK(whole)->Name("twin/one_plane")->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace earthshine

BENCHMARK_MAIN();
