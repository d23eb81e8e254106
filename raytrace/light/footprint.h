// SPDX-License-Identifier: Apache-2.0
// What a pixel covers of the plane of a surface. Light of a lamp without size that is nearer to it
// than a few pixels are wide falls on less than that: camera samples would find it by chance, or
// not at all. There each of them asks for the light at a second point too.
#pragma once

#include <array>

#include "base/numbers/random.h"
#include "raytrace/camera/camera.h"
#include "raytrace/camera/pixel_filter.h"

namespace earthshine::raytrace {

struct PixelView {
  const CameraModel& camera;
  const PixelFilter& filter;
  int x, y;  // of the pixel
};

class Footprint {
 public:
  // point, normal: what the ray met, on the viewer's side; offset_m: of rays that leave it.
  Footprint(const PixelView& pixel, const Ray& ray, const Vec3& point, const Vec3& normal,
            double offset_m);

  // Whether the lamp is that near, and not behind the surface.
  [[nodiscard]] bool is_near(const Vec3& lamp) const;

  // The place that the ray met and another, which is where light of the lamp falls, each with what
  // its light counts (the power heuristic, Veach 1997): over all samples of the pixel that meet
  // the plane the mean of both is what the filter makes of the light on what is seen of it.
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
  Vec3 corner_{0.0}, along_{0.0}, across_{0.0};  // of a rectangle about all that the filter reaches
  double longest_m_ = 0.0;                       // 0: the plane is not seen all over it
};

}  // namespace earthshine::raytrace
