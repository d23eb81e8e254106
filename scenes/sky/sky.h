// SPDX-License-Identifier: Apache-2.0
// Sun and Earth seen from the spacecraft: radiance by direction, and the Sun behind the limb.
#pragma once

#include <optional>

#include "scenes/light/lamp_light.h"
#include "scenes/scene.h"
#include "scenes/sky/two_discs.h"

namespace earthshine::scenes {

// Half angle of the Earth's disc from altitude h: asin(R / (R + h)).
[[nodiscard]] double earth_half_angle_rad(double altitude_m);

// Albedo by the law of Earth::by_latitude, and its maximum.
[[nodiscard]] double albedo_at(const LatitudeAlbedo& law, double sin_latitude);
[[nodiscard]] double largest_albedo(const LatitudeAlbedo& law);

// Radiance of the Earth in a unit direction, cd/m^2; 0 off its disc. Lambert: L = (a / pi) E_sun
// max(0, cos theta_s), theta_s the Sun's zenith angle where the direction meets the sphere; a is
// Earth::albedo, with a latitude law times albedo_at there. The scene must have an Earth and
// outlive this object; later changes of the scene have no effect.
class EarthRadiance {
 public:
  explicit EarthRadiance(const Scene& scene);
  [[nodiscard]] Rgb operator()(const Vec3& direction) const;
  [[nodiscard]] bool covers(const Vec3& direction) const {
    return glm::dot(direction, scene_.earth->direction) >= limb_cosine_;
  }

 private:
  // Unit zenith vector at the point of the sphere in `direction`; no value off the disc.
  [[nodiscard]] std::optional<Vec3> surface_zenith(const Vec3& direction) const;

  const Scene& scene_;
  double limb_cosine_, distance_;  // distance of the Earth's centre in Earth radii
};
// The Earth's radiance for a single direction.
[[nodiscard]] Rgb earth_radiance(const Scene& scene, const Vec3& direction);

// The Earth as a source for shadow rays: a direction uniform in the solid angle of its disc, and
// the light if the whole disc had the radiance of this direction. The scene as above.
class EarthLight {
 public:
  explicit EarthLight(const Scene& scene);
  [[nodiscard]] LightSample sample(double u, double v) const;

 private:
  Cone disc_;
  EarthRadiance radiance_;
  double solid_angle_sr_;
};

// Whether any part of the disc is lit.
[[nodiscard]] bool earth_is_lit(const Scene& scene);

// Share of the Sun's disc that the Earth does not hide, 0 to 1, by solid angle (two_discs.h).
[[nodiscard]] double visible_sun_share(const Scene& scene);

// Directions, uniform for u and v in [0, 1), on the part of the Sun's disc that the Earth does not
// hide, at the scene's present state.
class SunDirections {
 public:
  explicit SunDirections(const Scene& scene);
  [[nodiscard]] Vec3 operator()(double u, double v) const;

 private:
  [[nodiscard]] Vec3 beside_earth(double u, double v) const;

  Cone disc_;
  Vec3 sun_;
  // If the Earth hides part of it: both discs, and the direction from the Sun's middle to the
  // Earth's.
  std::optional<SunAndEarth> partly_;
  Vec3 toward_{0.0};
};

// Illuminance per sampled direction, so that a plate that faces the Sun receives illuminance_lx
// times the visible share: the mean cosine over the disc is (1 + cos r) / 2.
[[nodiscard]] Rgb sun_sample_illuminance(const Scene& scene);
// For the whole disc of an unobstructed Sun.
[[nodiscard]] Rgb sun_sample_illuminance(const Sun& sun);

// Radiance of the Sun's disc, cd/m^2: E / (pi sin^2 r); 0 for a point Sun.
[[nodiscard]] Rgb sun_radiance(const Sun& sun);

// Background radiance in a direction: the Sun's disc where the Earth does not hide it, and the
// Earth.
[[nodiscard]] Rgb sky_radiance(const Scene& scene, const Vec3& direction);

}  // namespace earthshine::scenes
