// SPDX-License-Identifier: Apache-2.0
#include "raytrace/camera/camera.h"

#include <cmath>

namespace earthshine::raytrace {

CameraModel make_camera_model(const scenes::Camera& camera, int columns, int rows) {
  CameraModel model;
  model.position = camera.position;
  model.forward = glm::normalize(camera.look_at - camera.position);
  model.right = glm::normalize(glm::cross(model.forward, camera.up));
  model.up = glm::cross(model.right, model.forward);
  model.half_height = std::tan(base::radians(camera.fov_deg / 2));
  model.half_width = model.half_height * columns / rows;
  model.columns = columns;
  model.rows = rows;
  if (camera.aperture_m > 0.0 && camera.focus_m > 0.0) {
    model.focus_m = camera.focus_m;
    model.lens_radius_m = camera.aperture_m / 2;
  }
  return model;
}

Ray CameraModel::ray(double x, double y, double lens_u, double lens_v) const {
  const double sx = (2.0 * x / columns - 1.0) * half_width;
  const double sy = (1.0 - 2.0 * y / rows) * half_height;
  const Vec3 through = forward + sx * right + sy * up;
  if (lens_radius_m <= 0.0) return {position, glm::normalize(through)};
  const double r = lens_radius_m * std::sqrt(lens_u), phi = 2.0 * base::pi * lens_v;
  const Vec3 on_lens = position + r * (std::cos(phi) * right + std::sin(phi) * up);
  const Vec3 in_focus = position + focus_m * through;
  return {on_lens, glm::normalize(in_focus - on_lens)};
}

}  // namespace earthshine::raytrace
