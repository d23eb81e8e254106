// SPDX-License-Identifier: Apache-2.0
// Rays per second of the final gather on a solved payload bay, and of the ray query alone for the
// same rays. Their ratio is the overhead of sampling and radiance look-up over Embree.
#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "radiosity/solution.h"
#include "raytrace/gather/gather_field.h"
#include "raytrace/gather/gather_rays.h"
#include "raytrace/shade/shading_setup.h"
#include "tests/benchmarks/payload_bay.h"

namespace earthshine {
namespace {

using raytrace::TilePoints;
using scenes::RayPacket;

constexpr int edge_px = 128;

const radiosity::Solution& solution() {
  static const radiosity::Solution solved = [] {
    const PayloadBay& bay = payload_bay();
    radiosity::SolveOptions options;
    options.patch_edge_m = 0.5;
    options.form_factor_rays = 256;
    return radiosity::solve(bay, options);
  }();
  return solved;
}

bool surface(const scenes::Hit& hit, raytrace::GatherRequest& request) {
  return raytrace::gathers_at(payload_bay().scene, hit, request);
}

raytrace::RenderOptions view() {
  raytrace::RenderOptions options;
  options.columns = options.rows = edge_px;
  return options;
}

struct Setup {
  const PayloadBay& bay = payload_bay();
  raytrace::ShadingSetup shading{bay, solution(), bay.scene.cameras[1], view()};
  const raytrace::CameraModel& camera = shading.camera();
  const raytrace::IncomingLight& incoming = shading.shared().incoming;
  const raytrace::PathWorld& world = shading.world();
};

const Setup& setup() {
  static const Setup made;
  return made;
}

// One point per pixel in tiles, as in gather_field.
std::vector<TilePoints> tiles() {
  const Setup& s = setup();
  std::vector<TilePoints> all;
  for (int y0 = 0; y0 < edge_px; y0 += raytrace::gather_tile_px) {
    for (int x0 = 0; x0 < edge_px; x0 += raytrace::gather_tile_px) {
      TilePoints& tile = all.emplace_back(1);
      for (int y = y0; y < y0 + raytrace::gather_tile_px; ++y) {
        for (int x = x0; x < x0 + raytrace::gather_tile_px; ++x) {
          const raytrace::Ray ray = s.camera.ray(x + 0.5, y + 0.5, 0.0, 0.0);
          const scenes::Hit hit = s.bay.query.closest(ray.origin, ray.direction);
          raytrace::GatherRequest at;
          if (hit.missed() || !surface(hit, at)) continue;
          raytrace::RayOrigins origins;
          origins.add({at.position + at.normal * s.bay.query.offset_m(hit.triangle),
                       glm::vec3(at.normal), glm::vec3(ray.direction)});
          tile.add(tile.count, static_cast<std::uint64_t>(y * edge_px + x), origins,
                   s.bay.query.centre());
        }
      }
    }
  }
  return all;
}

void gather(benchmark::State& state) {
  const Setup& s = setup();
  const std::size_t points = static_cast<std::size_t>(edge_px) * edge_px;
  const std::vector<std::uint32_t> each(points, static_cast<std::uint32_t>(state.range(0)));
  double rays = 0.0;
  for (auto round : state) {
    raytrace::GatherField field(s.world, s.incoming, surface, s.camera, {});
    field.cast(raytrace::Gathered::Solution, each, 0, {});
    rays = static_cast<double>(field.rays().gather);
    benchmark::DoNotOptimize(field.points().data());
  }
  state.counters["rays"] = benchmark::Counter(
      rays, benchmark::Counter::kIsRate | benchmark::Counter::kIsIterationInvariant);
}
BENCHMARK(gather)
    ->Name("gather/sts46/camera-b")
    ->ArgName("rays")
    ->Arg(32)
    ->Arg(256)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

// The packets are prepared outside the measurement.
void bare(benchmark::State& state) {
  const Setup& s = setup();
  const raytrace::GatherRays rays(static_cast<std::uint32_t>(state.range(0)));
  std::vector<RayPacket> packets;
  for (const TilePoints& tile : tiles()) {
    raytrace::GatherRays::Samples samples;
    for (std::size_t first = 0; first < tile.count; first += rays.batch()) {
      const std::size_t count = std::min(rays.batch(), tile.count - first);
      rays.draw(tile, first, count, 1, samples);
      for (std::size_t j = 0; j < rays.rays(); ++j) {
        for (std::size_t k = 0; k + RayPacket::width <= count; k += RayPacket::width) {
          std::array<float, RayPacket::width> cosine;
          raytrace::GatherRays::make(tile, first, k, j, samples, packets.emplace_back(), cosine);
        }
      }
    }
  }
  for (auto round : state) {
    base::parallel_chunks(packets.size(), 512, [&](std::size_t begin, std::size_t end) {
      scenes::HitPacket hits;
      for (std::size_t k = begin; k < end; ++k) {
        s.bay.query.closest(packets[k], RayPacket::width, hits);
        benchmark::DoNotOptimize(hits);
      }
    });
  }
  state.counters["rays"] =
      benchmark::Counter(static_cast<double>(packets.size() * RayPacket::width),
                         benchmark::Counter::kIsRate | benchmark::Counter::kIsIterationInvariant);
}
BENCHMARK(bare)
    ->Name("bare-query/sts46/camera-b")
    ->ArgName("rays")
    ->Arg(32)
    ->Arg(256)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace earthshine

BENCHMARK_MAIN();
