// SPDX-License-Identifier: Apache-2.0
// Rays per second of the form-factor kernel (make, trace, count), and of the ray query alone on the
// same, prepared rays. The ratio of both for one scene is the share of tracing in the kernel's
// time; the ratio of threads:2 to threads:1 is the scaling of the kernel.
#include <benchmark/benchmark.h>

#include <limits>
#include <vector>

#include "base/numbers/random.h"
#include "base/parallel.h"
#include "radiosity/factors/form_factors.h"
#include "radiosity/factors/patch_rays.h"
#include "tests/benchmarks/payload_bay.h"
#include "tests/support/scene_builder.h"

namespace earthshine {
namespace {

constexpr std::uint32_t rays_per_patch = 1024;

struct Cut {
  scenes::Scene scene;
  scenes::RayQuery query;
  radiosity::Patches patches;

  Cut(scenes::Scene s, double edge_m)
      : scene(std::move(s)), query(scene), patches(radiosity::subdivide(scene, edge_m)) {}
};

// A room of 6 n^2 quads around a box of 6 (n/4)^2; every patch is one quad of the ray structure.
scenes::Scene quads(int n) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  const auto face = [&](Vec3 corner, Vec3 a, Vec3 b, int count) {
    a /= count;
    b /= count;
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        const Vec3 p = corner + double(i) * a + double(j) * b;
        builder.quad(m, p, p + a, p + a + b, p + b);
      }
    }
  };
  const auto cube = [&](const Vec3& low, double size, int count, bool inward) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 a(0.0), b(0.0), across(0.0);
      a[(axis + 1) % 3] = b[(axis + 2) % 3] = across[axis] = size;
      // a x b points along +axis, which is inward for the lower face.
      face(low, inward ? a : b, inward ? b : a, count);
      face(low + across, inward ? b : a, inward ? a : b, count);
    }
  };
  cube(Vec3(0.0), 1.0, n, true);
  cube(Vec3(0.35), 0.3, n / 4, false);
  return builder.scene;
}

const Cut& cut(int which) {
  static const Cut few(quads(16), 1.0), many(quads(56), 1.0), bay(payload_bay().scene, 0.45);
  return which == 0 ? few : which == 1 ? many : bay;
}

const char* name(int which) {
  return which == 0 ? "1632 quads" : which == 1 ? "19992 quads" : "sts46";
}

void count_rays(benchmark::State& state, double rays) {
  state.counters["rays"] = benchmark::Counter(
      rays, benchmark::Counter::kIsRate | benchmark::Counter::kIsIterationInvariant);
}

void kernel(benchmark::State& state) {
  const int which = static_cast<int>(state.range(0));
  const Cut& c = cut(which);
  const base::ThreadLimit limit(static_cast<int>(state.range(1)));
  double rays = 0.0;
  for (auto round : state) {
    const auto factors =
        radiosity::cast_form_factors(c.scene, c.query, c.patches, {rays_per_patch, 1});
    rays = static_cast<double>(factors.ray_count);
    benchmark::DoNotOptimize(factors.hits.data());
  }
  count_rays(state, rays);
  state.SetLabel(name(which));
}
BENCHMARK(kernel)
    ->ArgNames({"scene", "threads"})
    ->ArgsProduct({{0, 1, 2}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// The same rays, of at most 4096 patches from all over the scene.
void bare_query(benchmark::State& state) {
  const int which = static_cast<int>(state.range(0));
  const Cut& c = cut(which);
  const base::ThreadLimit limit(static_cast<int>(state.range(1)));
  const radiosity::PatchRays rays(c.patches, c.query, rays_per_patch);
  std::vector<scenes::RayPacket> packets;
  const std::size_t step = c.patches.count() / 4096 + 1;
  for (std::size_t i = 0; i < c.patches.count(); i += step) {
    const auto sender =
        rays.sender(static_cast<std::uint32_t>(i), base::Key(1, base::Stream::FormFactor, i));
    for (std::uint32_t first = 0; first < rays_per_patch; first += scenes::RayPacket::width) {
      rays.make(sender, first, packets.emplace_back());
    }
  }
  for (auto round : state) {
    base::parallel_chunks(packets.size(), 8192, [&](std::size_t begin, std::size_t end) {
      scenes::HitPacket hits;
      for (std::size_t k = begin; k < end; ++k) {
        c.query.closest(packets[k], scenes::RayPacket::width, hits);
        benchmark::DoNotOptimize(hits);
      }
    });
  }
  count_rays(state, static_cast<double>(packets.size() * scenes::RayPacket::width));
  state.SetLabel(name(which));
}
BENCHMARK(bare_query)
    ->ArgNames({"scene", "threads"})
    ->ArgsProduct({{0, 1, 2}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace earthshine

BENCHMARK_MAIN();
