// SPDX-License-Identifier: Apache-2.0
// Rays per second of the form-factor kernel, against the same rays made beforehand and only traced.
// The ratio of the two rates is the share of the kernel's time that tracing takes.
#include <benchmark/benchmark.h>

#include <vector>

#include "base/parallel.h"
#include "base/random.h"
#include "radiosity/form_factors.h"
#include "tests/benchmarks/payload_bay.h"

namespace earthshine {
namespace {

constexpr double patch_edge_m = 0.4;

const radiosity::Patches& patches() {
  static const radiosity::Patches cut = radiosity::subdivide(payload_bay().scene, patch_edge_m);
  return cut;
}

void count_rays(benchmark::State& state, double rays) {
  state.counters["rays"] = benchmark::Counter(
      rays, benchmark::Counter::kIsRate | benchmark::Counter::kIsIterationInvariant);
}

void form_factor_kernel(benchmark::State& state) {
  const PayloadBay& bay = payload_bay();
  const int rays_per_patch = static_cast<int>(state.range(0));
  double rays = 0.0;
  static_cast<void>(patches());  // outside the clock
  for (auto round : state) {
    const auto factors =
        radiosity::cast_form_factors(bay.scene, bay.query, patches(), {rays_per_patch, 1});
    rays = static_cast<double>(factors.ray_count);
    benchmark::DoNotOptimize(factors.hits.data());
  }
  count_rays(state, rays);
}
BENCHMARK(form_factor_kernel)
    ->Name("form_factors/sts46")
    ->ArgName("rays_per_patch")
    ->Arg(64)
    ->Arg(256)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

std::vector<scenes::RayPacket> cosine_rays(int rays_per_patch) {
  const scenes::RayQuery& query = payload_bay().query;
  const double offset_m = query.surface_offset_m();
  std::vector<scenes::RayPacket> packets;
  for (std::uint32_t p = 0; p < patches().count(); ++p) {
    base::Rng rng(base::Key(1, base::Stream::Test, p));
    const base::Frame3 frame = base::frame_around(patches().normal(p));
    for (int ray = 0; ray < rays_per_patch; ++ray) {
      const std::size_t lane = static_cast<std::size_t>(ray) % scenes::RayPacket::width;
      if (lane == 0) packets.emplace_back();
      const double x = rng.next(), y = rng.next(), share = rng.next();
      const double turn = 2.0 * base::pi * rng.next(), radius = std::sqrt(share);
      query.set(packets.back(), lane, patches().point(p, x, y) + frame.normal * offset_m,
                frame.to_world(
                    {radius * std::cos(turn), radius * std::sin(turn), std::sqrt(1.0 - share)}));
    }
  }
  return packets;
}

void bare_rays(benchmark::State& state) {
  const scenes::RayQuery& query = payload_bay().query;
  const auto packets = cosine_rays(static_cast<int>(state.range(0)));
  for (auto round : state) {
    base::parallel_chunks(packets.size(), 256, [&](std::size_t begin, std::size_t end) {
      scenes::HitPacket hits;
      for (std::size_t k = begin; k < end; ++k) {
        query.closest(packets[k], scenes::RayPacket::width, hits);
        benchmark::DoNotOptimize(hits);
      }
    });
  }
  count_rays(state, static_cast<double>(packets.size() * scenes::RayPacket::width));
}
BENCHMARK(bare_rays)
    ->Name("closest/sts46")
    ->ArgName("rays_per_patch")
    ->Arg(64)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace earthshine

BENCHMARK_MAIN();
