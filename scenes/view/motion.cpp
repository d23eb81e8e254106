// SPDX-License-Identifier: Apache-2.0
#include "scenes/view/motion.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "scenes/triangle_point.h"

namespace earthshine::scenes {

MovedBy::MovedBy(const Motion& motion, const Vec3& about, double t_s)
    : rotation_(1.0), about_(about), to_(about + t_s * motion.velocity_m_s) {
  const double rate_deg = glm::length(motion.spin_deg_s);
  if (rate_deg > 0.0) {
    rotation_ =
        glm::mat3_cast(glm::angleAxis(base::radians(t_s * rate_deg), motion.spin_deg_s / rate_deg));
  }
}

Vec3 spin_centre(const Scene& scene, const Object& object) {
  if (object.spin_about) return *object.spin_about;
  return bounds_of(scene, object).middle();
}

bool surfaces_or_lamps_move(const Scene& scene) {
  const auto moves = [](const auto& one) { return one.motion.moves(); };
  return std::ranges::any_of(scene.objects, moves) || std::ranges::any_of(scene.lamps, moves);
}

void move_surfaces_and_lamps(Scene& scene, double t_s) {
  const std::vector<Object> before = scene.objects;
  std::vector<bool> is_moved(scene.vertices.size(), false);
  for (Object& object : scene.objects) {
    if (object.instance &&
        (object.motion.moves() || before[object.instance->object].motion.moves())) {
      object.instance.reset();
    }
    if (!object.motion.moves()) continue;
    const MovedBy moved(object.motion, spin_centre(scene, object), t_s);
    for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
      for (const std::uint32_t v : scene.triangles[object.first_triangle + k].vertex) {
        if (is_moved[v]) continue;
        is_moved[v] = true;
        scene.vertices[v] = moved.point(scene.vertices[v]);
      }
    }
  }
  for (Lamp& lamp : scene.lamps) {
    if (!lamp.motion.moves()) continue;
    const MovedBy moved(lamp.motion, lamp.position, t_s);
    lamp.position = moved.point(lamp.position);
    for (Vec3* direction : {&lamp.axis, &lamp.edge_u, &lamp.edge_v, &lamp.c0}) {
      *direction = moved.direction(*direction);
    }
  }
}

void hold_still(Scene& scene) {
  for (Camera& camera : scene.cameras) camera.exposure_s = camera.line_s = 0.0;
}

Shutter::Shutter(const Camera& camera)
    : exposure_s(camera.exposure_s),
      readout_s((camera.from_below ? -1.0 : 1.0) * camera.line_s * camera.rows) {}

double Shutter::all_s() const { return exposure_s + std::abs(readout_s); }

}  // namespace earthshine::scenes
