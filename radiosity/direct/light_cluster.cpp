// SPDX-License-Identifier: Apache-2.0
#include "radiosity/direct/light_cluster.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <memory>

#include "base/numbers/random.h"
#include "scenes/light/light_tree.h"

namespace earthshine::radiosity {
namespace {

using scenes::LightSample;

constexpr double smallest_share = 1.0 / 16.0;

struct Cluster {
  const scenes::Scene& scene;
  std::vector<std::size_t> lamps;
  scenes::LightTree tree;
  std::vector<double> flux_to;  // luminous, running sum

  [[nodiscard]] const scenes::Lamp& lamp(std::size_t k) const { return scene.lamps[lamps[k]]; }

  void sample(const Vec3& point, const Vec3& normal, double u, double v,
              std::vector<LightSample>& samples) const {
    std::vector<scenes::LightChoice> chosen;
    scenes::Receiver receiver;
    receiver.point = point;
    receiver.normal = normal;
    tree.choose(receiver, u, smallest_share, chosen);
    // u says already which lamps these are: where on them needs numbers that do not depend on it.
    const base::Key key(std::bit_cast<std::uint64_t>(u), base::Stream::DirectLight,
                        std::bit_cast<std::uint64_t>(v));
    for (const auto& [k, weight] : chosen) {
      const base::Key on_lamp = key.with(k);
      LightSample sample =
          scenes::sample_lamp(lamp(k), point, uniform(on_lamp, 0), uniform(on_lamp, 1));
      sample.normal_illuminance_lx *= weight;
      samples.push_back(sample);
    }
  }

  [[nodiscard]] scenes::EmittedRay emit(double u, double v, double x, double y) const {
    const double wanted = u * flux_to.back();
    const auto found = std::upper_bound(flux_to.begin(), flux_to.end() - 1, wanted);
    const auto k = static_cast<std::size_t>(found - flux_to.begin());
    const double below = k == 0 ? 0.0 : flux_to[k - 1];
    const double rest = std::clamp((wanted - below) / (flux_to[k] - below), 0.0, 1.0);
    return scenes::emit_from_lamp(lamp(k), rest, v, x, y);
  }

  [[nodiscard]] double distance_m(const Vec3& point) const {
    double nearest2 = std::numeric_limits<double>::infinity();
    for (const std::size_t k : lamps) {
      const Vec3 way = scene.lamps[k].position - point;
      nearest2 = std::min(nearest2, glm::dot(way, way));
    }
    return std::sqrt(nearest2);
  }
};

}  // namespace

LightSource cluster_source(const scenes::Scene& scene, const std::vector<std::size_t>& lamps,
                           std::uint64_t key, std::size_t group, int points) {
  std::vector<scenes::LightBounds> bounds;
  std::vector<double> flux_to;
  Rgb flux(0.0);
  for (const std::size_t k : lamps) {
    bounds.push_back(scenes::bounds_of(scene.lamps[k]));
    flux += scenes::lamp_flux_lm(scene.lamps[k]);
    flux_to.push_back(base::luminance(flux));
  }
  const auto cluster = std::make_shared<const Cluster>(
      Cluster{scene, lamps, scenes::LightTree(bounds), std::move(flux_to)});
  LightSource made;
  made.name = std::to_string(lamps.size()) + " lamps of group " + scene.lamps[lamps[0]].group;
  made.flux_lm = flux;
  made.emit = [cluster](double u, double v, double x, double y) {
    return cluster->emit(u, v, x, y);
  };
  made.source.key = key;
  made.source.group = group;
  made.source.points = 4 * points;
  made.source.near_factor = 4;
  made.source.distance_m = [cluster](const Vec3& point) { return cluster->distance_m(point); };
  made.source.cluster = [cluster](const Vec3& point, const Vec3& normal, double u, double v,
                                  std::vector<LightSample>& samples) {
    cluster->sample(point, normal, u, v, samples);
  };
  return made;
}

}  // namespace earthshine::radiosity
