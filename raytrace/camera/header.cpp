// SPDX-License-Identifier: Apache-2.0
#include "raytrace/camera/header.h"

namespace earthshine::raytrace {

CameraMatrices camera_matrices(const CameraModel& camera) {
  CameraMatrices m;
  const double columns = camera.columns, rows = camera.rows;
  m.k = {columns / (2.0 * camera.half_width),
         0.0,
         columns / 2.0,
         0.0,
         rows / (2.0 * camera.half_height),
         rows / 2.0,
         0.0,
         0.0,
         1.0};
  const Vec3 &x = camera.right, &z = camera.forward, &o = camera.position;
  const Vec3 down = -camera.up;
  m.to_world = {x.x, down.x, z.x, o.x, x.y, down.y, z.y, o.y,
                x.z, down.z, z.z, o.z, 0.0, 0.0,    0.0, 1.0};

  const Vec3& up = camera.up;
  const double ox = -glm::dot(o, x), oy = -glm::dot(o, up), oz = -glm::dot(o, z);
  m.world_to_camera = {x.x, up.x, z.x, 0.0, x.y, up.y, z.y, 0.0,
                       x.z, up.z, z.z, 0.0, ox,  oy,   oz,  1.0};
  // Each row times the projection: u = x / (2 w) + z / 2, v = z / 2 - y / (2 h), z - 1, over z.
  for (std::size_t row = 0; row < 4; ++row) {
    const double* const in = &m.world_to_camera[4 * row];
    double* const out = &m.world_to_ndc[4 * row];
    out[0] = in[0] / (2.0 * camera.half_width) + in[2] / 2.0;
    out[1] = in[2] / 2.0 - in[1] / (2.0 * camera.half_height);
    out[2] = in[2] - in[3];
    out[3] = in[2];
  }
  m.screen_window_width = 2.0 * camera.half_width;
  return m;
}

}  // namespace earthshine::raytrace
