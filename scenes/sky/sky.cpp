// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/sky.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenes/sky/albedo_grid.h"

namespace earthshine::scenes {
namespace {

SunAndEarth sun_and_earth(const Scene& scene) {
  const Vec3 &sun = scene.sun->direction, &earth = scene.earth->direction;
  return {base::radians(scene.sun->angular_radius_deg), base::radians(scene.earth->half_angle_deg),
          2.0 * std::atan2(glm::length(sun - earth), glm::length(sun + earth))};
}

}  // namespace

double earth_half_angle_rad(double altitude_m) {
  return std::asin(base::earth_radius_m / (base::earth_radius_m + altitude_m));
}

double albedo_at(const LatitudeAlbedo& law, double sin_latitude) {
  const double p2 = 0.5 * (3.0 * sin_latitude * sin_latitude - 1.0);
  return std::clamp(law.a0 + law.a1 * sin_latitude + law.a2 * p2, 0.0, 1.0);
}

double largest_albedo(const LatitudeAlbedo& law) {
  // A parabola in sin(latitude): the maximum is at a pole or at the vertex.
  const double top = law.a2 < 0.0 ? std::clamp(-law.a1 / (3.0 * law.a2), -1.0, 1.0) : 1.0;
  return std::max({albedo_at(law, -1.0), albedo_at(law, 1.0), albedo_at(law, top)});
}

EarthRadiance::EarthRadiance(const Scene& scene)
    : scene_(scene),
      limb_cosine_(std::cos(base::radians(scene.earth->half_angle_deg))),
      distance_(1.0 / std::sin(base::radians(scene.earth->half_angle_deg))) {}

std::optional<Vec3> EarthRadiance::surface_zenith(const Vec3& direction) const {
  const double cos_off_centre = glm::dot(direction, scene_.earth->direction);
  const double discriminant = 1.0 - distance_ * distance_ * (1.0 - cos_off_centre * cos_off_centre);
  if (cos_off_centre <= 0.0 || discriminant < 0.0) return std::nullopt;
  const double t = distance_ * cos_off_centre - std::sqrt(discriminant);
  return direction * t - scene_.earth->direction * distance_;
}

Rgb EarthRadiance::operator()(const Vec3& direction) const {
  const Earth& earth = *scene_.earth;
  if (!covers(direction)) return Rgb(0.0);
  if (earth.model == EarthModel::Uniform) return earth.radiance;
  const auto surface = surface_zenith(direction);
  if (!surface) return Rgb(0.0);
  Rgb falling(0.0);  // lx on the ground
  const double cos_sun = glm::dot(*surface, scene_.sun->direction);
  if (cos_sun > 0.0) falling += cos_sun * scene_.sun->illuminance_lx;
  if (scene_.moon) {
    const double cos_moon = glm::dot(*surface, scene_.moon->direction);
    if (cos_moon > 0.0) falling += cos_moon * scene_.moon->illuminance_lx;
  }
  if (falling == Rgb(0.0)) return falling;
  const Rgb radiance = earth.albedo * falling / base::pi;
  if (earth.grid) return radiance * earth.grid->at(earth.to_ground * *surface);
  if (!earth.by_latitude) return radiance;
  return radiance * albedo_at(*earth.by_latitude, glm::dot(*surface, earth.by_latitude->north));
}

Rgb earth_radiance(const Scene& scene, const Vec3& direction) {
  return EarthRadiance(scene)(direction);
}

EarthLight::EarthLight(const Scene& scene)
    : disc_(scene.earth->direction, base::radians(scene.earth->half_angle_deg)),
      radiance_(scene),
      solid_angle_sr_(cone_solid_angle_sr(base::radians(scene.earth->half_angle_deg))) {}

LightSample EarthLight::sample(double u, double v) const {
  const Vec3 direction = disc_.sample(u, v);
  return {direction, std::numeric_limits<double>::infinity(),
          radiance_(direction) * solid_angle_sr_};
}

bool earth_is_lit(const Scene& scene) {
  if (!scene.earth) return false;
  const Earth& earth = *scene.earth;
  if (earth.model == EarthModel::Uniform) return base::max_component(earth.radiance) > 0.0;
  if (base::max_component(earth.albedo) <= 0.0) return false;
  if (earth.by_latitude && largest_albedo(*earth.by_latitude) <= 0.0) return false;
  if (earth.grid && earth.grid->largest() <= 0.0) return false;
  // The visible cap reaches acos(R / (R + h)) = 90 deg - half angle around the sub-spacecraft
  // point; some of it is lit if the light stands less than 90 deg further from that point.
  const auto lights_cap = [&](const auto& light) {
    if (!light || base::max_component(light->illuminance_lx * earth.albedo) <= 0.0) return false;
    const double from_zenith =
        std::acos(std::clamp(glm::dot(-earth.direction, light->direction), -1.0, 1.0));
    return from_zenith < base::pi - base::radians(earth.half_angle_deg);
  };
  return lights_cap(scene.sun) || lights_cap(scene.moon);
}

double visible_sun_share(const Scene& scene) {
  if (!scene.sun) return 0.0;
  if (!scene.earth) return 1.0;
  const SunAndEarth discs = sun_and_earth(scene);
  if (!discs.touch()) return discs.separation < discs.limb ? 0.0 : 1.0;
  return discs.sun_share();
}

SunDirections::SunDirections(const Scene& scene)
    : disc_(scene.sun->direction, base::radians(scene.sun->angular_radius_deg)),
      sun_(scene.sun->direction) {
  if (!scene.earth) return;
  const SunAndEarth discs = sun_and_earth(scene);
  if (!discs.touch()) return;
  partly_ = discs;
  const Vec3 across = scene.earth->direction - glm::dot(sun_, scene.earth->direction) * sun_;
  const double length = glm::length(across);
  toward_ = length > 0.0 ? across / length : base::frame_around(sun_).tangent;
}

Vec3 SunDirections::operator()(double u, double v) const {
  return partly_ ? beside_earth(u, v) : disc_.sample(u, v);
}

// Radius from the Sun's middle by bisection, since the visible area within it increases; then the
// angle along the visible part of that circle.
Vec3 SunDirections::beside_earth(double u, double v) const {
  const double wanted = u * partly_->left(partly_->radius);
  double low = 0.0, high = partly_->radius;
  for (int step = 0; step < 40; ++step) {
    const double middle = 0.5 * (low + high);
    (partly_->left(middle) > wanted ? high : low) = middle;
  }
  const double off = 0.5 * (low + high);
  const double covered = covered_half_arc(off, partly_->limb, partly_->separation);
  const double azimuth = covered + 2.0 * v * (base::pi - covered);
  return glm::normalize(std::cos(off) * sun_ +
                        std::sin(off) * (std::cos(azimuth) * toward_ +
                                         std::sin(azimuth) * glm::cross(sun_, toward_)));
}

Rgb sun_sample_illuminance(const Scene& scene) {
  const double mean_cosine = 0.5 * (1.0 + std::cos(base::radians(scene.sun->angular_radius_deg)));
  return scene.sun->illuminance_lx * (visible_sun_share(scene) / mean_cosine);
}

Rgb sun_sample_illuminance(const Sun& sun) {
  return sun.illuminance_lx / (0.5 * (1.0 + std::cos(base::radians(sun.angular_radius_deg))));
}

Rgb sun_radiance(const Sun& sun) {
  const double sine = std::sin(base::radians(sun.angular_radius_deg));
  if (sine <= 0.0) return Rgb(0.0);
  return sun.illuminance_lx / (base::pi * sine * sine);
}

Rgb sky_radiance(const Scene& scene, const Vec3& direction) {
  if (scene.earth && glm::dot(direction, scene.earth->direction) >=
                         std::cos(base::radians(scene.earth->half_angle_deg))) {
    return earth_radiance(scene, direction);
  }
  if (scene.sun && glm::dot(direction, scene.sun->direction) >=
                       std::cos(base::radians(scene.sun->angular_radius_deg))) {
    return sun_radiance(*scene.sun);
  }
  return Rgb(0.0);
}

}  // namespace earthshine::scenes
