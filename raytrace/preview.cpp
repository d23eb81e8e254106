// SPDX-License-Identifier: Apache-2.0
#include "raytrace/preview.h"

#include "base/parallel.h"
#include "base/units.h"
#include "raytrace/incoming/incoming_light.h"
#include "scenes/surface_texture.h"

namespace earthshine::raytrace {

base::Image preview(const scenes::World& world, const radiosity::Solution& solution,
                    const CameraModel& camera) {
  const scenes::Scene& scene = world.scene;
  const LeakMask sight;
  const RadianceTable table(solution, solution.radiosity, false, sight);
  const BrightPatches bright;
  const IncomingLight incoming(world, table, bright, 1, 0,
                               world.effects.mirror || world.effects.refraction);
  base::Image image;
  image.width = camera.columns;
  image.height = camera.rows;
  for (const char* name : {"R", "G", "B"}) image.add(name);
  const auto columns = static_cast<std::size_t>(camera.columns);
  base::parallel_chunks(
      static_cast<std::size_t>(camera.rows), 4, [&](std::size_t begin, std::size_t end) {
        RayCounts rays;
        for (std::size_t y = begin; y < end; ++y) {
          for (std::size_t x = 0; x < columns; ++x) {
            const Ray ray =
                camera.ray(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5, 0.5, 0.5);
            const scenes::Hit hit = world.query.closest(ray.origin, ray.direction);
            Rgb radiance(0.0);
            incoming.add(hit, ray.direction, {}, Rgb(1.0), {&radiance, 1}, rays);
            if (!hit.missed()) {
              const scenes::Material& material =
                  scene.materials[scene.triangles[hit.triangle].material];
              if ((hit.front || material.two_sided) && material.emits()) {
                radiance += scenes::emit_at(scene, material, hit) / base::pi;
              }
            }
            for (int c = 0; c < 3; ++c) {
              image.channels[static_cast<std::size_t>(c)].values[y * columns + x] =
                  static_cast<float>(radiance[c]);
            }
          }
        }
      });
  return image;
}

}  // namespace earthshine::raytrace
