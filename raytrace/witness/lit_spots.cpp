// SPDX-License-Identifier: Apache-2.0
#include "raytrace/witness/lit_spots.h"

#include <algorithm>
#include <cmath>

#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

// As many spots of equal intensity as wanted, at places of the given ones (systematic resampling).
std::vector<LitSpot> resampled(const std::vector<LitSpot>& spots, std::size_t count) {
  double all = 0.0;
  for (const LitSpot& spot : spots) all += spot.intensity_cd;
  std::vector<LitSpot> chosen;
  double before = 0.0;
  for (const LitSpot& spot : spots) {
    before += spot.intensity_cd;
    while (chosen.size() < count && (double(chosen.size()) + 0.5) * all < before * double(count)) {
      chosen.push_back({spot.position, spot.normal, all / double(count)});
    }
  }
  return chosen;
}

// Luminance of the surface at a film position; 0 unless it is diffuse and seen directly.
// Nearer spots count as at near_m, since each represents others around it.
double luminance_at(WitnessScene& scene, const glm::dvec2& film, const std::vector<LitSpot>& spots,
                    double near_m) {
  const scenes::Scene& world = scene.shared.scene;
  const Vec3 eye = scene.camera.position;
  const Vec3 direction = scene.camera.direction_from(eye, film.x, film.y);
  const scenes::Hit hit = scene.closest(eye, direction);
  if (hit.missed()) return 0.0;
  const scenes::Material& material = world.materials[world.triangles[hit.triangle].material];
  if (!(hit.front || material.two_sided)) return 0.0;
  const Vec3 normal = (hit.front ? 1.0 : -1.0) * scenes::triangle_normal(world, hit.triangle);
  const Vec3 start = scenes::hit_position(world, hit, eye, direction) +
                     scene.shared.query.offset_m(hit.triangle) * normal;
  double illuminance = 0.0;
  for (const LitSpot& spot : spots) {
    const Vec3 offset = spot.position - start;
    const double distance = glm::length(offset);
    const double cosines = glm::dot(offset, normal) * -glm::dot(offset, spot.normal);
    if (glm::dot(offset, normal) <= 0.0 || cosines <= 0.0) continue;
    illuminance += spot.intensity_cd * cosines / std::pow(std::max(distance, near_m), 4.0) *
                   scene.share(start, offset / distance, distance * (1.0 - 1e-6));
  }
  return base::luminance(material.diffuse) / base::pi * illuminance;
}

}  // namespace

LitSpots::LitSpots(WitnessScene& scene, const std::vector<LitSpot>& spots) {
  const std::vector<LitSpot> chosen = resampled(spots, tuning::most_lit_spots);
  if (chosen.empty()) return;
  const double near_m =
      tuning::near_spot * scenes::box_around(scene.shared.scene.vertices).diagonal();
  const int columns = scene.camera.columns, rows = scene.camera.rows;
  const double pixels = double(columns) * double(rows);
  block_px_ = static_cast<int>(std::ceil(std::sqrt(pixels / tuning::most_blocks)));
  for (int y = block_px_ / 2; y < rows; y += block_px_) {
    for (int x = block_px_ / 2; x < columns && !scene.stops(); x += block_px_) {
      const double luminance = luminance_at(scene, {x + 0.5, y + 0.5}, chosen, near_m);
      if (luminance > 0.0) blocks_.push_back({x, y, static_cast<float>(luminance)});
    }
  }
}

}  // namespace earthshine::raytrace
