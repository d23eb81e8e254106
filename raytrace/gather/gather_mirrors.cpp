// SPDX-License-Identifier: Apache-2.0
// GatherField's points on surfaces that the camera sees in a mirror: they lie at their virtual
// positions behind the mirror.
#include <algorithm>

#include "raytrace/gather/gather_field.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
bool GatherField::place_mirrored(const Ray& ray, const scenes::Hit& hit, GatherPoint& point,
                                 RayStart& start) const {
  if (hit.missed()) return false;
  const scenes::Scene& scene = world_.scene;
  const scenes::Material& material = scene.materials[scene.triangles[hit.triangle].material];
  const double reflectance = base::luminance(material.mirror);
  if (reflectance < tuning::least_mirror || base::is_lit(material.transmit) ||
      !(hit.front || material.two_sided)) {
    return false;
  }
  const Vec3 outward = scenes::triangle_normal(scene, hit.triangle);
  const MirrorPlane mirror{scenes::hit_position(scene, hit, ray.origin, ray.direction),
                           hit.front ? outward : -outward};
  const Ray thrown{mirror.place + mirror.normal * world_.query.offset_m(hit.triangle),
                   glm::reflect(ray.direction, mirror.normal)};
  const scenes::Hit shown = world_.query.closest(thrown.origin, thrown.direction);
  if (!place(thrown, shown, point, start)) return false;
  point.spacing_m *= static_cast<float>((hit.t + shown.t) / shown.t);
  const Vec3 met = scenes::hit_position(scene, shown, thrown.origin, thrown.direction);
  point.position = glm::vec3(mirror.image(met) - origin_);
  point.normal = glm::reflect(point.normal, glm::vec3(mirror.normal));
  point.reflectance *= static_cast<float>(reflectance);
  point.lobe *= static_cast<float>(reflectance);
  point.mirror = hit.triangle;
  return true;
}

void GatherField::find_mirror_neighbours() {
  mirror_neighbours_.assign(off_grid_points_.size(), 0U);
  for (std::size_t k = 0; k < off_grid_points_.size(); ++k) {
    const GatherPoint& point = points_[grid_ + k];
    if (point.mirror == seen_straight || !setting_.shares) continue;
    const auto [x, y] = place_of(off_grid_points_[k].pixel);
    std::uint64_t bit = 1U;
    for (int qy = y - tuning::mirror_reach_px; qy <= y + tuning::mirror_reach_px; ++qy) {
      for (int qx = x - tuning::mirror_reach_px; qx <= x + tuning::mirror_reach_px;
           ++qx, bit <<= 1U) {
        if (!window_.contains(qx, qy)) continue;
        const std::size_t end = first_off_grid_[window_.index(qx, qy) + 1];
        if (end == first_off_grid_[window_.index(qx, qy)]) continue;
        const GatherPoint& other = points_[grid_ + end - 1];
        if (other.material == point.material && stands_for(other, sighting_of(point))) {
          mirror_neighbours_[k] |= bit;
        }
      }
    }
  }
}

}  // namespace earthshine::raytrace
