// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/sky.h"

#include <algorithm>
#include <cmath>

#include "scenes/light/lamp_light.h"

namespace earthshine::scenes {
namespace {

// Where the limb crosses the Sun's disc: its height over the limb in radii of the disc, from -1,
// hidden, to 1, free.
double sun_over_limb(const Scene& scene) {
  const double radius = base::radians(scene.sun->angular_radius_deg);
  const double separation =
      std::acos(std::clamp(glm::dot(scene.sun->direction, scene.earth->direction), -1.0, 1.0));
  const double over_limb = separation - base::radians(scene.earth->half_angle_deg);
  if (radius <= 0.0) return over_limb > 0.0 ? 1.0 : -1.0;
  return std::clamp(over_limb / radius, -1.0, 1.0);
}

// Share of a disc on one side of a chord at distance x radii from its centre.
double disc_share(double x) { return 0.5 + (x * std::sqrt(1.0 - x * x) + std::asin(x)) / base::pi; }

}  // namespace

double earth_half_angle_rad(double altitude_m) {
  return std::asin(base::earth_radius_m / (base::earth_radius_m + altitude_m));
}

double albedo_at(const LatitudeAlbedo& law, double sin_latitude) {
  const double p2 = 0.5 * (3.0 * sin_latitude * sin_latitude - 1.0);
  return std::clamp(law.a0 + law.a1 * sin_latitude + law.a2 * p2, 0.0, 1.0);
}

double largest_albedo(const LatitudeAlbedo& law) {
  // A parabola in sin(latitude): at a pole, or at its top.
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
  if (glm::dot(direction, earth.direction) < limb_cosine_) return Rgb(0.0);
  if (earth.model == EarthModel::Uniform) return earth.radiance;
  const auto surface = surface_zenith(direction);
  if (!surface) return Rgb(0.0);
  const double cos_sun = glm::dot(*surface, scene_.sun->direction);
  if (cos_sun <= 0.0) return Rgb(0.0);
  const Rgb radiance = earth.albedo * scene_.sun->illuminance_lx * (cos_sun / base::pi);
  if (!earth.by_latitude) return radiance;
  return radiance * albedo_at(*earth.by_latitude, glm::dot(*surface, earth.by_latitude->north));
}

Rgb earth_radiance(const Scene& scene, const Vec3& direction) {
  return EarthRadiance(scene)(direction);
}

bool earth_is_lit(const Scene& scene) {
  if (!scene.earth) return false;
  const Earth& earth = *scene.earth;
  if (earth.model == EarthModel::Uniform) return base::max_component(earth.radiance) > 0.0;
  if (!scene.sun || base::max_component(scene.sun->illuminance_lx * earth.albedo) <= 0.0) {
    return false;
  }
  if (earth.by_latitude && largest_albedo(*earth.by_latitude) <= 0.0) return false;
  // The visible cap reaches acos(R / (R + h)) = 90 deg - half angle around the sub-spacecraft
  // point; some of it is lit if the Sun stands less than 90 deg further from that point.
  const double sun_from_zenith =
      std::acos(std::clamp(glm::dot(-earth.direction, scene.sun->direction), -1.0, 1.0));
  const double cap = base::pi / 2 - base::radians(earth.half_angle_deg);
  return sun_from_zenith < base::pi / 2 + cap;
}

double visible_sun_share(const Scene& scene) {
  if (!scene.sun) return 0.0;
  return scene.earth ? disc_share(sun_over_limb(scene)) : 1.0;
}

Vec3 sample_sun(const Scene& scene, double u, double v) {
  const Vec3& sun = scene.sun->direction;
  const double radius = base::radians(scene.sun->angular_radius_deg);
  const double over = scene.earth ? sun_over_limb(scene) : 1.0;
  if (over >= 1.0 || over <= -1.0) return sample_cone(sun, radius, u, v);
  // Across the limb the place has the density of the chords' lengths, whose integral is inverted by
  // halving; along the chord it is uniform. In radii of the disc, x away from the Earth.
  const double wanted = u * disc_share(over);
  double low = -1.0, high = over;  // of -x
  for (int step = 0; step < 50; ++step) {
    const double middle = 0.5 * (low + high);
    (disc_share(middle) > wanted ? high : low) = middle;
  }
  const double x = -0.5 * (low + high);
  const double y = (2.0 * v - 1.0) * std::sqrt(std::max(0.0, 1.0 - x * x));
  const Vec3 away =
      glm::normalize(glm::dot(sun, scene.earth->direction) * sun - scene.earth->direction);
  // Equal areas of the disc are equal solid angles: 1 - cos = r^2 (1 - cos radius).
  const double half_sine = std::sin(radius / 2);
  const double r2 = x * x + y * y, one_minus_cos = r2 * 2.0 * half_sine * half_sine;
  const double per_radius = std::sqrt(one_minus_cos * (2.0 - one_minus_cos) / std::max(r2, 1e-300));
  return glm::normalize((1.0 - one_minus_cos) * sun +
                        per_radius * (x * away + y * glm::cross(sun, away)));
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
