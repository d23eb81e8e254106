// SPDX-License-Identifier: Apache-2.0
// Direct light of many lamps at points of a floor, from all lamps or from those that a LightSampler
// chooses.
//   points   shading points per second, shadow rays included
//   rays     shadow rays per point
//   error    RMS over points of the error of one choice, over the mean illuminance
#include <benchmark/benchmark.h>

#include <cmath>

#include "raytrace/light/light_sampler.h"
#include "scenes/effects/world.h"
#include "tests/benchmarks/many_lamps.h"

namespace earthshine {
namespace {

constexpr std::size_t points = 256;

struct Hall {
  scenes::Scene scene;
  scenes::LightGroups groups;
  scenes::Effects effects;
  scenes::RayQuery query;
  raytrace::LightSampler lights;

  explicit Hall(std::size_t count)
      : scene(hall_of_lamps(count)),
        groups(scenes::find_light_groups(scene)),
        effects(scenes::find_effects(scene, groups)),
        query(scene),
        lights({scene, groups, effects, query}, raytrace::Indirect::None, 1) {}

  [[nodiscard]] static scenes::Receiver receiver(std::size_t k) {
    const double x = (static_cast<double>(k) + 0.5) / points;
    scenes::Receiver at;
    at.point = Vec3(60.0 * (x - 0.5), 5.0 * (std::fmod(x * 61.8, 1.0) - 0.5), 1e-4);
    return at;
  }

  // Illuminance from the lamps in the list; adds the number of shadow rays to `rays`.
  double shadowed(const scenes::Receiver& at, const std::vector<scenes::LightChoice>& list,
                  double& rays) const {
    scenes::RayPacket packet;
    double value[scenes::RayPacket::width];
    std::size_t lanes = 0;
    double sum = 0.0;
    const auto flush = [&] {
      const std::uint32_t hidden = query.occluded(packet, lanes);
      for (std::size_t k = 0; k < lanes; ++k) sum += ((hidden >> k) & 1U) == 0 ? value[k] : 0.0;
      rays += static_cast<double>(lanes);
      lanes = 0;
    };
    for (const auto& [light, weight] : list) {
      const scenes::LightSample sample = lights.sample(light, at.point, 0.5, 0.5);
      const double y =
          weight * sample.normal_illuminance_lx.g * glm::dot(sample.direction, at.normal);
      if (y <= 0.0) continue;
      query.set(packet, lanes, at.point, sample.direction, sample.distance_m * (1.0 - 1e-5));
      value[lanes++] = y;
      if (lanes == scenes::RayPacket::width) flush();
    }
    if (lanes > 0) flush();
    return sum;
  }
};

void lamps(benchmark::State& state) {
  const Hall hall(static_cast<std::size_t>(state.range(0)));
  const bool chooses = state.range(1) != 0;
  std::vector<scenes::LightChoice> all, chosen;
  for (std::size_t k = 0; k < hall.lights.count(); ++k) all.push_back({k, 1.0});
  double rays = 0.0, rounds = 0.0, u = 0.5;
  for (auto round : state) {
    for (std::size_t k = 0; k < points; ++k) {
      const scenes::Receiver at = Hall::receiver(k);
      if (chooses) {
        chosen.clear();
        u = std::fmod(u + 0.6180339887498949, 1.0);
        hall.lights.choose(at, u, chosen);
      }
      benchmark::DoNotOptimize(hall.shadowed(at, chooses ? chosen : all, rays));
    }
    rounds += 1.0;
  }
  double square = 0.0, mean = 0.0, ignored = 0.0;
  for (std::size_t k = 0; k < points; ++k) {
    const scenes::Receiver at = Hall::receiver(k);
    const double exact = hall.shadowed(at, all, ignored);
    mean += exact / points;
    for (int n = 0; n < 16; ++n) {
      chosen.clear();
      if (chooses) hall.lights.choose(at, (n + 0.5) / 16.0, chosen);
      const double error = hall.shadowed(at, chooses ? chosen : all, ignored) - exact;
      square += error * error / (16.0 * points);
    }
  }
  state.counters["points"] =
      benchmark::Counter(points, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["rays"] = rays / (rounds * points);
  state.counters["error"] = mean > 0.0 ? std::sqrt(square) / mean : 0.0;
}
BENCHMARK(lamps)
    ->Name("lamps/hall")
    ->ArgNames({"lamps", "choose"})
    ->ArgsProduct({{1, 16, 256, 4096}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace earthshine

BENCHMARK_MAIN();
