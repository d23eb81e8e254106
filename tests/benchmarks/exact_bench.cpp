// SPDX-License-Identifier: Apache-2.0
// Form factors without rays, on one thread: a cube seen from inside with boxes, the cases for which
// times of View3D are known (1.3, 50 and 47 s on one core of a 2.4 GHz Zen 3).
#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "radiosity/exact/form_factors.h"
#include "tests/support/boxes.h"

namespace earthshine {
namespace {

void exact(benchmark::State& state, const tests::CutScene& cut) {
  const base::ThreadLimit limit(1);
  const scenes::RayQuery query(cut.scene);
  radiosity::ExactReport report;
  for (auto round : state) {
    const auto result = radiosity::exact_form_factors(cut.scene, query, cut.patches, {});
    report = result.report;
    benchmark::DoNotOptimize(result.factors.hits.data());
  }
  state.counters["patches"] = static_cast<double>(cut.patches.count());
  state.counters["row_defect"] = report.max_closed_defect;
  state.counters["estimated_error"] = report.estimated_error;
  state.counters["pairs"] =
      benchmark::Counter(static_cast<double>(report.pairs),
                         benchmark::Counter::kIsRate | benchmark::Counter::kIsIterationInvariant);
}

BENCHMARK_CAPTURE(exact, cube_and_box_408, tests::cube_and_box(8))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(exact, cube_and_box_3672, tests::cube_and_box(24))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(exact, cube_and_64_boxes_768, tests::cube_and_boxes(8, 4))
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace earthshine

BENCHMARK_MAIN();
