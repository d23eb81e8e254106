// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/row_pilot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {
namespace {

constexpr std::size_t largest_pilot = std::size_t{1} << 17;
constexpr std::size_t rays_cast = std::size_t{1} << 18;
constexpr std::size_t fewest_rows = 32, most_rows = 256;

struct Pilot {
  double patches = 0.0;
  double entries = 0.0;  // per mean row
  bool meets_backs = false;
};

Pilot cast_pilot(const scenes::Scene& scene, const scenes::RayQuery& query, double edge_m,
                 int rays_per_patch) {
  const Patches patches = subdivide(scene, edge_m, edge_m);
  const std::size_t wanted = rays_cast / static_cast<std::size_t>(std::max(1, rays_per_patch));
  const std::size_t count = std::min(std::clamp(wanted, fewest_rows, most_rows), patches.count());
  std::vector<std::uint32_t> rows(count);
  for (std::size_t k = 0; k < count; ++k) {
    rows[k] = static_cast<std::uint32_t>((2 * k + 1) * patches.count() / (2 * count));
  }
  FormFactorOptions options;
  options.rays_per_patch = rays_per_patch;
  const FormFactors factors = cast_rows(scene, query, patches, rows, options);
  const std::size_t entries = factors.shares.sum(factors.hits.size());
  return {double(patches.count()), double(entries) / double(count),
          std::any_of(factors.black.begin(), factors.black.end(),
                      [](double share) { return share > 0.0; })};
}

// Includes both sides of sheets.
double surface_m2(const scenes::Scene& scene) {
  double area_m2 = 0.0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const bool sheet = scene.materials[scene.triangles[t].material].two_sided;
    area_m2 += (sheet ? 2.0 : 1.0) * scenes::triangle_area(scene, t);
  }
  return area_m2;
}

}  // namespace

ExpectedRows expected_rows(const scenes::Scene& scene, const scenes::RayQuery& query,
                           std::size_t patches, int rays_per_patch) {
  if (patches == 0 || scene.triangles.empty()) return {};
  const double area_m2 = surface_m2(scene);
  const auto edge_for = [&](double count) { return std::sqrt(area_m2 / count); };
  const auto wanted = static_cast<double>(std::min(patches, largest_pilot));
  const Pilot fine = cast_pilot(scene, query, edge_for(wanted), rays_per_patch);
  const Pilot coarse = cast_pilot(scene, query, edge_for(wanted / 8.0), rays_per_patch);
  double growth = 0.0;
  if (fine.patches > coarse.patches && fine.entries > coarse.entries && coarse.entries > 0.0) {
    growth = std::log(fine.entries / coarse.entries) / std::log(fine.patches / coarse.patches);
  }
  const double entries =
      fine.entries * std::pow(double(patches) / fine.patches, std::min(growth, 1.0));
  return {std::min({entries, double(patches), double(rays_per_patch)}), fine.meets_backs};
}

double expected_unreached(const scenes::Scene& scene, std::size_t patches, int rays_per_patch) {
  const double density = double(patches) / surface_m2(scene);
  // Facets and clusters, undivided.
  const Patches uncut =
      subdivide(scene, std::numeric_limits<double>::infinity(), std::sqrt(1.0 / density));
  double unreached = 0.0;
  for (const double facet_m2 : uncut.area_m2) {
    const double cells = std::max(1.0, facet_m2 * density);
    unreached += cells * std::exp(-rays_per_patch * facet_m2 * density / cells);
  }
  return unreached;
}

}  // namespace earthshine::radiosity
