// SPDX-License-Identifier: Apache-2.0
#include "raytrace/light/footprint.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raytrace/tuning.h"
#include "scenes/light/solid_angle.h"

namespace earthshine::raytrace {
Footprint::Footprint(const PixelView& pixel, const Ray& ray, const Vec3& point, const Vec3& normal,
                     double offset_m)
    : pixel_(pixel), lens_(ray.origin), point_(point), normal_(normal), offset_m_(offset_m) {
  const double height = glm::dot(point - lens_, normal);
  const Vec3 flat = ray.direction - glm::dot(ray.direction, normal) * normal;
  const double slope = glm::length(flat);
  const Vec3 along = slope > 1e-6 ? flat / slope : base::frame_around(normal).tangent;
  const Vec3 across = glm::cross(normal, along);
  const double reach = 0.5 * pixel.filter.width_px();
  glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const double x : {-reach, reach}) {
    for (const double y : {-reach, reach}) {
      const Vec3 direction =
          pixel.camera.direction_from(lens_, pixel.x + 0.5 + x, pixel.y + 0.5 + y);
      const double fall = glm::dot(direction, normal);
      if (fall > -tuning::flattest) return;
      const Vec3 off = lens_ + height / fall * direction - point;
      const glm::dvec2 at(glm::dot(off, along), glm::dot(off, across));
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
  }
  corner_ = point + low.x * along + low.y * across;
  along_ = (high.x - low.x) * along;
  across_ = (high.y - low.y) * across;
  longest_m_ = std::max(high.x - low.x, high.y - low.y);
}

bool Footprint::is_near(const Vec3& lamp) const {
  const Vec3 offset = lamp - (corner_ + 0.5 * (along_ + across_));
  return glm::dot(offset, normal_) > 0.0 && glm::length(offset) < tuning::near_lengths * longest_m_;
}

bool Footprint::is_seen(const scenes::RayQuery& query, const Vec3& direction) const {
  const scenes::Hit hit = query.closest(lens_, direction);
  const double height = glm::dot(lens_ + hit.t * direction - point_, normal_);
  return !hit.missed() && std::abs(height) <= 4.0 * (offset_m_ + query.distance_error_m(hit.t));
}

Footprint::Places Footprint::toward(const Vec3& lamp, const scenes::RayQuery& query,
                                    const std::array<float, 2>& u, base::Rng& rng) const {
  const Vec3 to_lamp = lamp - point_;
  const double height = glm::dot(to_lamp, normal_), distance = glm::length(to_lamp);
  const scenes::SolidAngleSample seen =
      scenes::sample_rectangle(lamp, corner_, along_, across_, double(u[0]), double(u[1]));
  const double fall = -glm::dot(seen.direction, normal_);
  if (!(seen.solid_angle_sr > 0.0) || fall <= 0.0) return {};
  // Densities per area: of the camera's samples, and of points sampled toward the lamp.
  const CameraModel& camera = pixel_.camera;
  const glm::dvec2 middle(pixel_.x + 0.5, pixel_.y + 0.5);
  const auto by_camera = [&](const Vec3& at) {
    return pixel_.filter.density(camera.film_from(lens_, at) - middle) *
           camera.film_per_m2(lens_, at, normal_);
  };
  const auto by_lamp = [&](double away_m) {
    return height / (away_m * away_m * away_m * seen.solid_angle_sr);
  };
  const double reach = height / fall;
  Places places;
  places.point = lamp + reach * seen.direction;
  const double own = by_camera(point_), there = by_camera(places.point);
  const double own_by_lamp = by_lamp(distance), there_by_lamp = by_lamp(reach);
  places.own_weight = own * own / (own * own + own_by_lamp * own_by_lamp);
  if (there <= 0.0 || !is_seen(query, glm::normalize(places.point - lens_))) return places;
  // Only samples that hit the plane get here. The mean number of rays up to a hit is the reciprocal
  // of the probability of a hit.
  int rays = 1;
  for (; rays < tuning::most_footprint_rays; ++rays) {
    const double x = rng.next(), y = rng.next();
    const auto offset = pixel_.filter.offset(x, y);
    if (is_seen(query, camera.direction_from(lens_, middle.x + offset[0], middle.y + offset[1]))) {
      break;
    }
  }
  places.weight = rays * there * there_by_lamp / (there * there + there_by_lamp * there_by_lamp);
  return places;
}

}  // namespace earthshine::raytrace
