// SPDX-License-Identifier: Apache-2.0
// The product y = F x of the solver, against the memory bandwidth of the machine. `matrix` is the
// bytes of F per second, which are read once per product for all right-hand sides.
#include <benchmark/benchmark.h>

#include <numeric>
#include <vector>

#include "base/parallel.h"
#include "radiosity/factors/form_factors.h"
#include "radiosity/linear_solve.h"
#include "tests/benchmarks/payload_bay.h"

namespace earthshine {
namespace {

struct Bay {
  radiosity::Patches patches;
  radiosity::FormFactors factors;
};

const Bay& bay() {
  static const Bay made = [] {
    const PayloadBay& b = payload_bay();
    radiosity::Patches patches = radiosity::subdivide(b.scene, 0.45);
    radiosity::FormFactors f = radiosity::cast_form_factors(b.scene, b.query, patches, {1024, 1});
    radiosity::balance(f, patches.area_m2);
    return Bay{std::move(patches), std::move(f)};
  }();
  return made;
}

void rate(benchmark::State& state, const char* name, double bytes) {
  state.counters[name] = benchmark::Counter(
      bytes, benchmark::Counter::kIsRate | benchmark::Counter::kIsIterationInvariant,
      benchmark::Counter::kIs1000);
}

void product(benchmark::State& state) {
  const radiosity::FormFactors& f = bay().factors;
  const base::ThreadLimit limit(static_cast<int>(state.range(1)));
  const auto columns = static_cast<std::size_t>(state.range(0));
  const std::vector<double> x(f.count() * columns, 1.0);
  std::vector<double> y(x.size());
  for (auto round : state) {
    radiosity::multiply(f, x, y, columns);
    benchmark::DoNotOptimize(y.data());
  }
  rate(state, "matrix", double(f.hits.size() * (sizeof(float) + sizeof(std::uint32_t))));
}
BENCHMARK(product)
    ->ArgNames({"columns", "threads"})
    ->ArgsProduct({{3, 6, 9, 24}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// Sums 1 GiB of memory at full speed.
void read_memory(benchmark::State& state) {
  const base::ThreadLimit limit(static_cast<int>(state.range(0)));
  const std::vector<std::uint64_t> data(std::size_t{1} << 27, 1);
  for (auto round : state) {
    const auto sum = base::ordered_sum<std::uint64_t>(
        data.size(), std::size_t{1} << 18, 0, [&](std::size_t begin, std::size_t end) {
          return std::accumulate(&data[begin], &data[begin] + (end - begin), std::uint64_t{0});
        });
    benchmark::DoNotOptimize(sum);
  }
  rate(state, "read", double(data.size() * sizeof(std::uint64_t)));
}
BENCHMARK(read_memory)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace earthshine

BENCHMARK_MAIN();
