// SPDX-License-Identifier: Apache-2.0
#include "tests/validation/surface_points.h"

#include <numeric>
#include <span>

#include "base/numbers/random.h"
#include "raytrace/incoming/radiance_table.h"

namespace earthshine::validation {
namespace {

// Systematic sampling of `count` indices 0 .. weights.size() - 1: each is chosen count * weight /
// sum times on average. Empty if all weights are 0.
std::vector<std::size_t> spread_by_weight(std::span<const double> weights, std::size_t count,
                                          std::uint64_t seed) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<std::size_t> chosen;
  if (sum <= 0.0) return chosen;
  const double step = sum / static_cast<double>(count);
  double next = step * base::Rng(base::Key(seed, base::Stream::ErrorBudget, 1)).next(),
         so_far = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    so_far += weights[k];
    for (; next < so_far && chosen.size() < count; next += step) chosen.push_back(k);
  }
  return chosen;
}

}  // namespace

std::vector<scenes::Hit> spread_over_surfaces(const scenes::Scene& scene, std::size_t count,
                                              std::uint64_t seed) {
  std::vector<double> area;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const bool sheet = scene.materials[scene.triangles[t].material].two_sided;
    area.push_back((sheet ? 2.0 : 1.0) * scenes::triangle_area(scene, t));
  }
  std::vector<scenes::Hit> spread;
  base::Rng rng(base::Key(seed, base::Stream::ErrorBudget, 2));
  for (const std::size_t t : spread_by_weight(area, count, seed)) {
    double u = rng.next(), v = rng.next();
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const bool sheet = scene.materials[scene.triangles[t].material].two_sided;
    const bool front = !sheet || rng.next() < 0.5;
    scenes::Hit hit;
    hit.triangle = static_cast<std::uint32_t>(t);
    hit.u = static_cast<decltype(hit.u)>(u);
    hit.v = static_cast<decltype(hit.v)>(v);
    hit.front = front;
    spread.push_back(hit);
  }
  return spread;
}

std::vector<double> radiosity_at(const scenes::RayQuery& query, const radiosity::Solution& solution,
                                 const std::vector<scenes::Hit>& where) {
  if (solution.columns == 0) return std::vector<double>(where.size(), 0.0);  // no light
  const raytrace::LeakMask sight(query, solution.patches);
  const raytrace::RadianceTable table(solution, solution.radiosity, false, sight);
  std::vector<double> values;
  values.reserve(where.size());
  for (const scenes::Hit& hit : where) {
    std::array<Rgb, 1> sum{Rgb(0.0)};
    table.add(hit, Rgb(base::pi), sum);
    values.push_back(base::luminance(sum[0]));
  }
  return values;
}

}  // namespace earthshine::validation
