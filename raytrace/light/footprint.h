// SPDX-License-Identifier: Apache-2.0
// The footprint of a pixel on the plane of a surface. A lamp without size that is nearer than a few
// pixel widths lights less than a pixel, and camera samples seldom or never hit the lit spot.
// Therefore each of them samples the lamp's light at a second point, too.
#pragma once

#include <array>

#include "base/numbers/random.h"
#include "raytrace/camera/camera.h"
#include "raytrace/camera/pixel_filter.h"

namespace earthshine::raytrace {

struct PixelView {
  const CameraModel& camera;
  const PixelFilter& filter;
  int x, y;  // column and row of the pixel
};

class Footprint {
 public:
  // point, normal: the ray's hit, on the viewer's side; offset_m: of rays that leave it.
  Footprint(const PixelView& pixel, const Ray& ray, const Vec3& point, const Vec3& normal,
            double offset_m);

  // Whether the lamp is near in this sense and in front of the surface.
  [[nodiscard]] bool is_near(const Vec3& lamp) const;

  // The ray's hit and a second point in the lit spot, each with its weight (power heuristic; Veach
  // 1997). Over all samples of the pixel that hit the plane, the mean of both is the filtered light
  // of the visible part of the plane.
  struct Places {
    double own_weight = 1.0;
    Vec3 point{0.0};
    double weight = 0.0;
  };
  [[nodiscard]] Places toward(const Vec3& lamp, const scenes::RayQuery& query,
                              const std::array<float, 2>& u, base::Rng& rng) const;

 private:
  // Whether the camera sees the plane in that direction.
  [[nodiscard]] bool is_seen(const scenes::RayQuery& query, const Vec3& direction) const;

  PixelView pixel_;
  Vec3 lens_, point_, normal_;
  double offset_m_;
  Vec3 corner_{0.0}, along_{0.0}, across_{0.0};  // rectangle around the filter's support
  double longest_m_ = 0.0;                       // 0: the support exceeds the plane
};

}  // namespace earthshine::raytrace
