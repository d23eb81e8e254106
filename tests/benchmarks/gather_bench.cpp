// SPDX-License-Identifier: Apache-2.0
// Rays per second of the final gather on a solved payload bay.
#include <benchmark/benchmark.h>

#include "radiosity/solution.h"
#include "raytrace/render.h"
#include "tests/benchmarks/payload_bay.h"

namespace earthshine {
namespace {

const radiosity::Solution& solution() {
  static const radiosity::Solution solved = [] {
    const PayloadBay& bay = payload_bay();
    radiosity::SolveOptions options;
    options.patch_edge_m = 0.5;
    options.form_factor_rays = 256;
    return radiosity::solve(bay.scene, bay.groups, bay.effects, bay.query, options);
  }();
  return solved;
}

void gather(benchmark::State& state) {
  const PayloadBay& bay = payload_bay();
  raytrace::RenderOptions options;
  options.columns = options.rows = static_cast<int>(state.range(0));
  options.gather_rays = static_cast<int>(state.range(1));
  double rays = 0.0;
  static_cast<void>(solution());  // outside the clock
  for (auto round : state) {
    const raytrace::Frame frame = raytrace::render(bay.scene, bay.groups, bay.effects, bay.query,
                                                   solution(), bay.scene.cameras[1], options);
    rays = static_cast<double>(frame.report.rays.total());
    benchmark::DoNotOptimize(frame.image.channels.data());
  }
  state.counters["rays"] = benchmark::Counter(
      rays, benchmark::Counter::kIsRate | benchmark::Counter::kIsIterationInvariant);
}
BENCHMARK(gather)
    ->Name("gather/sts46/camera-b")
    ->ArgNames({"px", "gather_rays"})
    ->Args({128, 64})
    ->Args({128, 256})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace earthshine

BENCHMARK_MAIN();
